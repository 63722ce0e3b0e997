//! Motions as functions of time.

use crate::error::InputError;

/// A motion along one internal step, or part of one: a polynomial of degree q + 1 for a step of
/// order q.
///
/// With s = (t − centre)/(end − start), it is y = Σ_k c_k sᵏ with c_k = y⁽ᵏ⁾(centre)
/// (end − start)ᵏ/k! from the method's own polynomial for k ≤ q. The centre is the end of the step;
/// for a Taylor polynomial, which loses digits elsewhere, it is the start. Where states are
/// projected after a step, the method's polynomial misses the state at the end opposite the centre
/// by the error of a step; the term of degree q + 1 corrects this. So the segments of a motion
/// agree where they join, up to rounding error, and have the order of the method.
#[derive(Debug, Clone, PartialEq)]
pub struct Segment {
    start: f64,
    end: f64,
    centre: f64,
    dim: usize,
    /// c_0, then c_1, …
    coefficients: Vec<f64>,
}

/// The factor of a derivative below which a term is lost beside the state, whatever the derivative was before it overflowed.
const SHORTEST: f64 = 1e-150;

impl Segment {
    /// A constant segment, to which [`push`](Segment::push) adds the derivatives at the centre.
    pub(crate) fn new((start, end): (f64, f64), centre: f64, state: &[f64]) -> Segment {
        Segment { start, end, centre, dim: state.len(), coefficients: state.to_vec() }
    }

    /// Adds the term of degree k from the derivative of that order at the centre.
    pub(crate) fn push(&mut self, k: u32, derivative: &[f64]) {
        let factor = (1..=k).fold(1.0, |factor, j| factor * (self.end - self.start) / f64::from(j));
        // Over so short a piece that a derivative overflows, its term is below rounding; over any other it is not known.
        let is_lost = |derivative: &f64| !derivative.is_finite() && factor.abs() < SHORTEST;
        let term = |derivative: &f64| if is_lost(derivative) { 0.0 } else { derivative * factor };
        self.coefficients.extend(derivative.iter().map(term));
    }

    /// Adds the term that makes the polynomial pass through a state at `t`, the start or the end.
    pub(crate) fn close(&mut self, t: f64, state: &[f64]) {
        let mut reached = vec![0.0; self.dim];
        self.evaluate(t, &mut reached);
        let s = (t - self.centre) / (self.end - self.start);
        let power = s.powi((self.coefficients.len() / self.dim) as i32);
        let gap = state.iter().zip(&reached).map(|(state, reached)| state - reached);
        self.coefficients.extend(gap.map(|gap| gap / power));
    }

    /// The start and the end.
    pub fn span(&self) -> (f64, f64) {
        (self.start, self.end)
    }

    /// The number of components of a state.
    pub fn dim(&self) -> usize {
        self.dim
    }

    /// Writes y(t) to `state`, of length [`dim`](Segment::dim), not projected; outside the span,
    /// the polynomial is extrapolated.
    pub fn evaluate(&self, t: f64, state: &mut [f64]) {
        let s = (t - self.centre) / (self.end - self.start);
        state.fill(0.0);
        for terms in self.coefficients.chunks_exact(self.dim).rev() {
            for (state, term) in state.iter_mut().zip(terms) {
                *state = *state * s + term;
            }
        }
    }

    /// Writes ẏ(t) to `rate`, of length [`dim`](Segment::dim).
    pub fn derivative(&self, t: f64, rate: &mut [f64]) {
        let length = self.end - self.start;
        let s = (t - self.centre) / length;
        rate.fill(0.0);
        for (k, terms) in self.coefficients.chunks_exact(self.dim).enumerate().skip(1).rev() {
            for (rate, term) in rate.iter_mut().zip(terms) {
                *rate = *rate * s + k as f64 * term / length;
            }
        }
    }
}

/// A motion as a function of time: [`Segment`]s, each beginning where the one before ends.
///
/// It is continuous except at resets by events, where it is continuous from the right in the
/// direction of integration; at the end of the motion it is the limit from the left.
///
/// It consists of the polynomials alone, without the vector field: where the field
/// [projects](pc_expr::VectorField::project) its states, the states inside steps miss the
/// constraints and the conserved integrals by the error of a step. Outputs and
/// [`Integration::interpolate`](crate::Integration::interpolate) are projected; for projected
/// states, interpolate during the integration, or project the states evaluated here.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct DenseOutput {
    segments: Vec<Segment>,
}

impl DenseOutput {
    /// The segments in order.
    pub fn segments(&self) -> &[Segment] {
        &self.segments
    }

    /// The start and the end; none if there is no segment.
    pub fn span(&self) -> Option<(f64, f64)> {
        Some((self.segments.first()?.start, self.segments.last()?.end))
    }

    /// y(t), not projected.
    ///
    /// # Errors
    /// [`InputError::OutsideSpan`]
    pub fn evaluate(&self, t: f64) -> Result<Vec<f64>, InputError> {
        let segment = self.at(t)?;
        let mut state = vec![0.0; segment.dim];
        segment.evaluate(t, &mut state);
        Ok(state)
    }

    /// The derivative ẏ(t), which may jump between steps by the error of a step.
    ///
    /// # Errors
    /// [`InputError::OutsideSpan`]
    pub fn derivative(&self, t: f64) -> Result<Vec<f64>, InputError> {
        let segment = self.at(t)?;
        let mut rate = vec![0.0; segment.dim];
        segment.derivative(t, &mut rate);
        Ok(rate)
    }

    fn at(&self, t: f64) -> Result<&Segment, InputError> {
        let (start, end) = self.span().unwrap_or((f64::NAN, f64::NAN));
        let direction = 1.0_f64.copysign(end - start);
        let covered = (t - start) * direction >= 0.0 && (end - t) * direction >= 0.0;
        let after = self.segments.partition_point(|segment| (segment.end - t) * direction <= 0.0);
        match self.segments.get(after).or(self.segments.last()) {
            Some(segment) if covered => Ok(segment),
            _ => Err(InputError::OutsideSpan { requested: t, start, end }),
        }
    }
}

impl Extend<Segment> for DenseOutput {
    /// Appends segments; the first of them begins where the last segment so far ends.
    fn extend<I: IntoIterator<Item = Segment>>(&mut self, segments: I) {
        self.segments.extend(segments);
    }
}

impl FromIterator<Segment> for DenseOutput {
    fn from_iter<I: IntoIterator<Item = Segment>>(segments: I) -> Self {
        DenseOutput { segments: segments.into_iter().collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn second_coefficient(length: f64, derivative: f64) -> f64 {
        let mut segment = Segment::new((0.0, length), 0.0, &[1.0]);
        segment.push(1, &[0.5]);
        segment.push(2, &[derivative]);
        segment.coefficients[2]
    }

    #[test]
    fn a_term_whose_derivative_overflows_is_lost_over_the_shortest_pieces_only() {
        assert_eq!(second_coefficient(1e-80, f64::INFINITY), 0.0);
        assert_eq!(second_coefficient(1e-80, f64::NAN), 0.0);
        assert_eq!(second_coefficient(1e-3, f64::INFINITY), f64::INFINITY);
        assert!(second_coefficient(1e-3, f64::NAN).is_nan());
        assert_eq!(second_coefficient(1e-3, 4.0), 2e-6);
    }
}

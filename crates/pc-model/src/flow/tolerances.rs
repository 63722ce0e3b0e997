//! Absolute tolerances that depend on the scale of each component of the state.

use pc_mech::VectorField;

use crate::document::tolerance::AbsoluteTolerance;
use crate::flow::flow::Flow;

/// The absolute tolerance of components whose scale is ordinary.
pub const ORDINARY_TOLERANCE: f64 = 1e-12;

/// The smallest tolerance, relative to the largest component: terms of this component in the rates of the
/// others have a rounding error that shorter steps cannot reduce.
const LEAST: f64 = 1e-16;

/// A start value below this fraction of the largest may be nothing but rounding error, such as cos(π/2), and
/// counts as zero.
const ZERO: f64 = 1e-13;
/// A rate below this fraction of the largest also counts as zero.
const AT_REST: f64 = 1e-9;

impl Flow {
    /// The absolute tolerance of each component of the state: the given one, otherwise
    /// ```text
    /// atolᵢ = min(1e-12, max(rtol sᵢ, 1e-16 s)),      sᵢ = |yᵢ| or τ |ẏᵢ|,      s = max |yᵢ|,      τ = s / max |ẏᵢ|
    /// ```
    /// at the start. Here sᵢ is |yᵢ|, or τ |ẏᵢ| for a component that starts at zero, or s if its rate is zero too. So a component
    /// that begins at 1e-9 is computed to as many digits as one that begins at 1, whatever the units, as far as rounding errors of
    /// the larger components allow. If the whole state starts at zero, τ is the time span.
    pub fn absolute_tolerances(
        &mut self,
        given: &AbsoluteTolerance,
        (t_start, t_end): (f64, f64),
        rtol: f64,
    ) -> Vec<f64> {
        let usual = absolute_tolerances(&mut self.motion, &self.start, (t_start, t_end), rtol);
        given.over(self.motion.names(), &usual)
    }
}

/// The default absolute tolerance of each component of a motion, as in [`Flow::absolute_tolerances`].
pub fn absolute_tolerances(
    field: &mut impl VectorField,
    start: &[f64],
    (t_start, t_end): (f64, f64),
    rtol: f64,
) -> Vec<f64> {
    let mut rates = vec![0.0; start.len()];
    if field.rhs(t_start, start, &mut rates).is_err() || !rates.iter().all(|rate| rate.is_finite()) {
        rates.fill(0.0);
    }
    let scales = scales(start, &rates, (t_end - t_start).abs());
    // No tolerance is 0, however small the numbers are.
    let least = (LEAST * largest(&scales)).max(f64::MIN_POSITIVE);
    scales.iter().map(|scale| ORDINARY_TOLERANCE.min((rtol * scale).max(least))).collect()
}

/// sᵢ
fn scales(start: &[f64], rates: &[f64], span: f64) -> Vec<f64> {
    let (s, fastest) = (largest(start), largest(rates));
    let tau = if s > 0.0 { s / fastest } else { span };
    // What rests as a whole has the usual tolerances.
    let all = if s > 0.0 || fastest > 0.0 { s.max(tau * fastest) } else { f64::INFINITY };
    let of = |(y, rate): (&f64, &f64)| {
        if y.abs() > ZERO * s {
            y.abs()
        } else if rate.abs() > AT_REST * fastest {
            tau * rate.abs()
        } else {
            all
        }
    };
    start.iter().zip(rates).map(of).collect()
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |largest, value| value.abs().max(largest))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The tolerances for a start with these rates over a time of 10, at rtol 1e-9.
    fn tolerances<const N: usize>(start: [f64; N], rates: [f64; N]) -> Vec<f64> {
        let scales = scales(&start, &rates, 10.0);
        let least = LEAST * largest(&scales);
        scales.iter().map(|scale| ORDINARY_TOLERANCE.min((1e-9 * scale).max(least))).collect()
    }

    #[test]
    fn an_ordinary_component_has_the_usual_one() {
        assert_eq!(tolerances([1.0, 0.0], [0.0, -1.0]), [1e-12; 2]);
        assert_eq!(tolerances([3e9, 0.0], [0.0, -3e9]), [1e-12; 2]);
        assert_eq!(tolerances([0.3, 0.0, 0.0], [1.0, 0.0, 1e-10]), [1e-12; 3]);
    }

    /// x = a cos ωt, ẋ = 0, of any frequency.
    #[test]
    fn a_small_motion_has_small_ones_in_any_units_of_time() {
        for (frequency, speed) in [(1.0, 1.0), (1e6, 1e6), (1e-3, 1e-3)] {
            let small = tolerances([1e-9, 0.0], [0.0, -1e-9 * frequency * frequency]);
            assert!((small[0] / 1e-18 - 1.0).abs() < 1e-12, "{small:?} at {speed}");
            assert!(small[1] <= 1e-17, "{small:?} at {speed}");
        }
    }

    #[test]
    fn beside_larger_ones_rounding_is_the_least() {
        let beside = tolerances([1e-9, 0.0, 0.0, 1.0], [0.0, -4e-9, 1.0, 0.0]);
        assert_eq!(beside, [1e-16, 1e-16, 1e-12, 1e-12]);
        assert_eq!(tolerances([1.0, 6e-17, 0.125], [0.0, 0.0, 0.0]), [1e-12; 3]);
    }

    #[test]
    fn rest_at_the_origin_has_the_scale_of_its_force() {
        assert_eq!(tolerances([0.0, 0.0], [0.0, -1e-9]), [1e-17; 2]);
        assert_eq!(tolerances([0.0], [0.0]), [1e-12]);
    }
}

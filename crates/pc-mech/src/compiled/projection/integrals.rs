//! First integrals that a motion is brought back to.

use pc_expr::{Backend, Evaluator, Expr, Program};

use crate::compiled::failure::{EvaluationFailure, check_finite};
use crate::compiled::first_order::FirstOrder;
use crate::compiled::point::Point;
use crate::compiled::running_error::Measured;
use crate::error::{IntegralError, MechError};

/// Newton's method comes near by the square of the distance; from where it does not in so many steps, it does not.
const MOST_STEPS: usize = 50;

/// After a step so short against the state the next one would be rounding.
const SHORT: f64 = 1e-8;

/// Roundings in the value of an integral, in units of what its gradient and its value are.
const ROUNDINGS: f64 = 4.0;

/// A gradient of which less than this is left beside those before it adds nothing to them.
const DEPENDENT: f64 = 1e-10;

/// First integrals I_j(t, y) of a motion, compiled with their gradients, to keep it at their values: see
/// [`Motion::keep`](crate::Motion::keep).
#[derive(Clone, Debug)]
pub struct KeptIntegrals {
    /// Of the integrals.
    pub(super) names: Vec<String>,
    /// The constraints, if there are any, which are not to be left on the way, then the integrals.
    values: Measured,
    /// ∂I_j/∂t, then ∂I_j/∂y_i for each i, one after the other.
    gradients: Evaluator,
    /// Zeros of the constraints, then the values of the integrals at the start.
    levels: Vec<f64>,
    /// Number of first-order states, which a projection leaves alone.
    states: usize,
}

impl<'g> FirstOrder<'g> {
    /// The integrals of these names, kept where `held` vanish.
    pub(super) fn kept<S: AsRef<str>>(
        &self,
        names: &[S],
        held: &[Expr<'g>],
    ) -> Result<KeptIntegrals, MechError> {
        let known = &self.observables[..self.conserved];
        let mut functions = held.to_vec();
        for name in names.iter().map(AsRef::as_ref) {
            let Some((_, integral)) = known.iter().find(|(known, _)| known == name) else {
                let known = known.iter().map(|(name, _)| name.clone()).collect();
                return Err(IntegralError::Unknown { name: name.to_owned(), known }.into());
            };
            functions.push(*integral);
        }
        let variables: Vec<Expr<'g>> = [self.time].iter().chain(&self.state).copied().collect();
        let gradients: Vec<Expr<'g>> =
            functions.iter().flat_map(|&function| self.graph.gradient(function, &variables)).collect();
        let inputs = self.inputs(&[]);
        Ok(KeptIntegrals {
            names: names.iter().map(|name| name.as_ref().to_owned()).collect(),
            values: Measured::new(self.graph, &inputs, &functions, Backend::Fastest)?,
            gradients: Evaluator::new(Program::new(self.graph, &inputs, &gradients)?, Backend::Fastest),
            levels: vec![0.0; functions.len()],
            states: self.states,
        })
    }
}

impl KeptIntegrals {
    /// The rates of change of the integrals at (t, y), where ẏ = `rates`, each with the sum of the absolute values of its
    /// terms.
    pub(super) fn rates_of_change(&mut self, at: Point<'_>, rates: &[f64]) -> Vec<(f64, f64)> {
        let gradients = self.gradients_at(at);
        let along = |gradient: &Vec<f64>| {
            let terms = || gradient.iter().zip(std::iter::once(&1.0).chain(rates)).map(|(g, rate)| g * rate);
            (terms().sum(), terms().map(f64::abs).sum())
        };
        gradients[self.held()..].iter().map(along).collect()
    }

    /// Takes the values at (t, y) for those to be kept.
    pub(crate) fn set_levels(&mut self, at: Point<'_>) {
        let held = self.held();
        self.levels.copy_from_slice(self.values.eval(at));
        self.levels[..held].fill(0.0);
    }

    /// The number of constraints.
    fn held(&self) -> usize {
        self.levels.len() - self.names.len()
    }

    /// (∂I_j/∂t, ∂I_j/∂y), one row for each.
    fn gradients_at(&mut self, Point { t, y, p }: Point<'_>) -> Vec<Vec<f64>> {
        let mut entries = vec![0.0; self.levels.len() * (y.len() + 1)];
        self.gradients.eval(t, y, p, &mut entries);
        entries.chunks_exact(y.len() + 1).map(<[f64]>::to_vec).collect()
    }

    /// Newton's method for I(t, y) = I_0, each step the shortest.
    ///
    /// # Errors
    /// [`EvaluationFailure::NotKept`] if the steps do not become shorter, [`EvaluationFailure::Expr`] for values that are
    /// not finite.
    pub(crate) fn project(&mut self, t: f64, y: &mut [f64], p: &[f64]) -> Result<(), EvaluationFailure> {
        let (mut first, mut before) = (None, f64::INFINITY);
        for _ in 0..MOST_STEPS {
            self.values.try_eval(Point { t, y, p })?;
            let change = self.shortest(Point { t, y, p })?;
            let largest = |values: &[f64]| values.iter().fold(0.0f64, |size, x| size.max(x.abs()));
            let length = largest(&change);
            let first = *first.get_or_insert(length);
            let is_short = length <= SHORT * largest(y);
            if length >= before / 2.0 && (is_short || length <= SHORT * first) {
                return Ok(());
            }
            if length >= before {
                return Err(EvaluationFailure::NotKept);
            }
            y.iter_mut().zip(&change).for_each(|(y, change)| *y -= change);
            if is_short {
                return Ok(());
            }
            before = length;
        }
        Err(EvaluationFailure::NotKept)
    }

    /// The shortest δ with ∂I_j/∂y · δ = I_j − I_j0, by orthogonalising the gradients one after the other. A difference
    /// that is rounding of the terms of I_j moves nothing: near an equilibrium it would far.
    fn shortest(&mut self, at: Point<'_>) -> Result<Vec<f64>, EvaluationFailure> {
        let gradients = self.gradients_at(at);
        let mut change = vec![0.0; at.y.len()];
        let mut basis: Vec<Vec<f64>> = Vec::new();
        for (place, row) in gradients.iter().enumerate() {
            check_finite(row, &self.gradients, at)?;
            let mut gradient = row[1..].to_vec();
            let moving = gradient.len() - self.states;
            gradient[moving..].fill(0.0);
            let gradient = &gradient[..];
            let difference = self.values.values()[place] - self.levels[place];
            // At the edge of the domain of a function that is part of it an integral may have no bound.
            let error =
                Some(self.values.error(place)).filter(|error| error.is_finite()).unwrap_or_else(|| {
                    let terms: f64 = gradient.iter().zip(at.y).map(|(g, y)| (g * y).abs()).sum();
                    ROUNDINGS * f64::EPSILON * (terms + self.levels[place].abs())
                });
            let residual = if difference.abs() <= error { 0.0 } else { difference };
            let mut direction = gradient.to_vec();
            for known in &basis {
                let along = dot(known, &direction);
                direction.iter_mut().zip(known).for_each(|(d, known)| *d -= along * known);
            }
            let (left, size) = (dot(&direction, &direction).sqrt(), dot(gradient, gradient).sqrt());
            if left <= DEPENDENT * size {
                continue;
            }
            direction.iter_mut().for_each(|d| *d /= left);
            let missing = (residual - dot(gradient, &change)) / left;
            change.iter_mut().zip(&direction).for_each(|(change, d)| *change += missing * d);
            basis.push(direction);
        }
        Ok(change)
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

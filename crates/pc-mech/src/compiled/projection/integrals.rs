//! First integrals that a motion keeps constant.

use pc_algebra::{discontinuities, may_jump};
use pc_expr::{Backend, Evaluator, Expr, Program};
use serde::{Deserialize, Serialize};

use crate::compiled::failure::{EvaluationFailure, check_finite};
use crate::compiled::first_order::FirstOrder;
use crate::compiled::point::Point;
use crate::compiled::running_error::Measured;
use crate::error::{IntegralError, MechError};

/// The maximum number of steps; Newton's method converges quadratically, or fails.
const MOST_STEPS: usize = 50;

/// A step this short relative to the state is the last: the next would be rounding error.
const SHORT: f64 = 1e-8;

/// The rounding error of an integral without a bound, in units of the rounding of its terms and of its value.
const ROUNDINGS: f64 = 4.0;

/// A gradient is left out if less than this fraction of it is independent of the gradients before it.
const DEPENDENT: f64 = 1e-10;

/// First integrals I_j(t, y) of a motion, compiled with their gradients, to keep the motion at their values:
/// see [`Motion::keep`](crate::Motion::keep).
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct KeptIntegrals {
    /// The names of the integrals.
    pub(super) names: Vec<String>,
    /// The constraints that have to hold at the same time, if there are any, then the integrals.
    values: Measured,
    /// Computes ∂I_j/∂t, then ∂I_j/∂y_i for each i, one integral after the other.
    gradients: Evaluator,
    /// Zeros for the constraints, then the values of the integrals at the start.
    levels: Vec<f64>,
    /// The number of first-order states, which a projection leaves unchanged.
    states: usize,
    pub(crate) room: Room,
}

/// Storage for the gradients, for orthogonal directions, for the shortest change, and for a state.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(crate) struct Room {
    entries: Vec<f64>,
    basis: Vec<f64>,
    change: Vec<f64>,
    pub(crate) state: Vec<f64>,
}

impl<'g> FirstOrder<'g> {
    /// The integrals with these names, to be kept while the constraints `held` vanish.
    pub(super) fn kept<S: AsRef<str>>(
        &self,
        names: &[S],
        held: &[Expr<'g>],
    ) -> Result<KeptIntegrals, MechError> {
        let known = &self.observables[..self.conserved];
        let mut functions = [held, &self.norms()].concat();
        for name in names.iter().map(AsRef::as_ref) {
            let Some((_, integral)) = known.iter().find(|(known, _)| known == name) else {
                let known = known.iter().map(|(name, _)| name.clone()).collect();
                return Err(IntegralError::Unknown { name: name.to_owned(), known }.into());
            };
            self.check_without_jumps(name, *integral)?;
            functions.push(*integral);
        }
        let variables: Vec<Expr<'g>> = [self.time].iter().chain(&self.state).copied().collect();
        let gradients: Vec<Expr<'g>> =
            functions.iter().flat_map(|&function| self.graph.gradient(function, &variables)).collect();
        let inputs = self.inputs(&[]);
        let dim = self.state.len();
        let room = Room {
            entries: vec![0.0; gradients.len()],
            basis: vec![0.0; functions.len() * dim],
            change: vec![0.0; dim],
            state: vec![0.0; dim],
        };
        Ok(KeptIntegrals {
            names: names.iter().map(|name| name.as_ref().to_owned()).collect(),
            values: Measured::new(self.graph, &inputs, &functions, Backend::Fastest)?,
            gradients: Evaluator::new(Program::new(self.graph, &inputs, &gradients)?, Backend::Fastest),
            levels: vec![0.0; functions.len()],
            states: self.states,
            room,
        })
    }

    /// |q|² − 1 of each quaternion.
    fn norms(&self) -> Vec<Expr<'g>> {
        let norm = |places: &[usize; 4]| {
            self.graph.sum(places.iter().map(|&i| self.state[i].square()).chain([Expr::from(-1.0)]))
        };
        self.quaternions.places().iter().map(norm).collect()
    }

    /// Checks that an integral does not jump along the motion, since a value kept across a jump would belong to other
    /// states. The energy of a Lagrangian that does not jump is tested at the surfaces where the Lagrangian changes
    /// from one piece to another; other integrals must have no such surfaces.
    fn check_without_jumps(&self, name: &str, integral: Expr<'g>) -> Result<(), MechError> {
        // A state whose rate is zero changes only at events, which restart the motion with the values after them.
        let flowing = self.state.iter().zip(&self.rates).filter(|(_, rate)| !rate.is_zero());
        let flowing: Vec<Expr<'g>> = flowing.map(|(&symbol, _)| symbol).collect();
        let changing = [&[self.time], &self.varying[..], &self.unknowns[..], &flowing[..]].concat();
        let mut numbers = self.parameters.clone();
        numbers.retain(|(symbol, _)| !self.varying.contains(symbol));
        let jumps = match name {
            "energy" => !discontinuities(self.graph, &[integral], &changing, &numbers)?.is_empty(),
            _ => may_jump(self.graph, integral, &changing, &numbers)?,
        };
        if jumps { Err(IntegralError::Jumps { name: name.to_owned() }.into()) } else { Ok(()) }
    }
}

impl KeptIntegrals {
    /// The rates of change of the integrals at (t, y), where ẏ = `rates`, each with the sum of the absolute
    /// values of its terms.
    pub(super) fn rates_of_change(&mut self, at: Point<'_>, rates: &[f64]) -> Vec<(f64, f64)> {
        let held = self.held();
        self.find_gradients(at);
        let along = |gradient: &[f64]| {
            let terms = || gradient.iter().zip(std::iter::once(&1.0).chain(rates)).map(|(g, rate)| g * rate);
            (terms().sum(), terms().map(f64::abs).sum())
        };
        self.room.entries.chunks_exact(at.y.len() + 1).skip(held).map(along).collect()
    }

    /// Makes the values at (t, y) the values to be kept.
    pub(crate) fn set_levels(&mut self, at: Point<'_>) {
        let held = self.held();
        self.levels.copy_from_slice(self.values.eval(at));
        self.levels[..held].fill(0.0);
    }

    /// The number of constraints.
    fn held(&self) -> usize {
        self.levels.len() - self.names.len()
    }

    /// Computes (∂I_j/∂t, ∂I_j/∂y) into `entries`, one row for each integral.
    fn find_gradients(&mut self, Point { t, y, p }: Point<'_>) {
        self.gradients.eval(t, y, p, &mut self.room.entries);
    }

    /// Projects onto I(t, y) = I_0 by Newton's method, each step being the shortest possible.
    ///
    /// # Errors
    /// [`EvaluationFailure::NotKept`] if the steps do not become shorter, [`EvaluationFailure::Expr`] for
    /// values that are not finite.
    pub(crate) fn project(&mut self, t: f64, y: &mut [f64], p: &[f64]) -> Result<(), EvaluationFailure> {
        let (mut first, mut before) = (None, f64::INFINITY);
        for _ in 0..MOST_STEPS {
            self.values.try_eval(Point { t, y, p })?;
            self.find_shortest(Point { t, y, p })?;
            let change = &self.room.change;
            let largest = |values: &[f64]| values.iter().fold(0.0f64, |size, x| size.max(x.abs()));
            let length = largest(change);
            let first = *first.get_or_insert(length);
            let is_short = length <= SHORT * largest(y);
            if length >= before / 2.0 && (is_short || length <= SHORT * first) {
                return Ok(());
            }
            if length >= before {
                return Err(EvaluationFailure::NotKept);
            }
            y.iter_mut().zip(change).for_each(|(y, change)| *y -= change);
            if is_short {
                return Ok(());
            }
            before = length;
        }
        Err(EvaluationFailure::NotKept)
    }

    /// Computes into `change` the shortest δ with ∂I_j/∂y · δ = I_j − I_j0, by orthogonalising the gradients
    /// one after the other. A difference within the rounding errors of the terms of I_j is ignored: near an
    /// equilibrium it would cause a large step.
    fn find_shortest(&mut self, at: Point<'_>) -> Result<(), EvaluationFailure> {
        self.find_gradients(at);
        let Room { entries, basis, change, .. } = &mut self.room;
        let dim = at.y.len();
        let mut independent = 0;
        change.fill(0.0);
        for (place, row) in entries.chunks_exact_mut(dim + 1).enumerate() {
            check_finite(row, &self.gradients, at)?;
            row[1 + dim - self.states..].fill(0.0);
            let gradient = &row[1..];
            let difference = self.values.values()[place] - self.levels[place];
            // At the edge of the domain of a function the error of an integral may have no bound.
            let error =
                Some(self.values.error(place)).filter(|error| error.is_finite()).unwrap_or_else(|| {
                    let terms: f64 = gradient.iter().zip(at.y).map(|(g, y)| (g * y).abs()).sum();
                    ROUNDINGS * f64::EPSILON * (terms + self.levels[place].abs())
                });
            let residual = if difference.abs() <= error { 0.0 } else { difference };
            let (known, free) = basis.split_at_mut(independent * dim);
            let direction = &mut free[..dim];
            direction.copy_from_slice(gradient);
            for known in known.chunks_exact(dim.max(1)) {
                let along = dot(known, direction);
                direction.iter_mut().zip(known).for_each(|(d, known)| *d -= along * known);
            }
            let (left, size) = (dot(direction, direction).sqrt(), dot(gradient, gradient).sqrt());
            if left <= DEPENDENT * size {
                continue;
            }
            direction.iter_mut().for_each(|d| *d /= left);
            let missing = (residual - dot(gradient, change)) / left;
            change.iter_mut().zip(&*direction).for_each(|(change, d)| *change += missing * d);
            independent += 1;
        }
        Ok(())
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

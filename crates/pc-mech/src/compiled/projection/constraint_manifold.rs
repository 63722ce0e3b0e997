//! The surface of the states that satisfy constraints, evaluated numerically.

use pc_expr::{Backend, Evaluator, Expr, ExprError, Inputs, Pattern, Program};
use serde::{Deserialize, Serialize};

use crate::compiled::elimination::saddle_point::Independence;
use crate::compiled::elimination::solver::Solver;
use crate::compiled::failure::{EvaluationFailure, check_finite};
use crate::compiled::point::Point;
use crate::compiled::projection::followers::Followers;
use crate::compiled::running_error::Measured;

/// The maximum number of steps; steps from far away are damped. Near the surface convergence is quadratic and a
/// handful suffices.
pub(super) const MOST_STEPS: usize = 50;

/// The maximum number of halvings of a step before the projection fails.
const HALVINGS: i32 = 20;

/// The largest ratio of successive steps that counts as quadratic convergence; where the ratio is larger, the
/// step is damped, or is only rounding error.
const CONVERGING: f64 = 0.25;

/// The residual of f that a single rounding may cause, relative to the bound for all rounding errors together.
/// Moving a state to remove it would add noise to the differences from which an integrator predicts the motion.
const ONE_ROUNDING: f64 = 0.125;

/// A step that could be caused by errors of f this many times their bounds is treated as rounding error: f has
/// errors of its own, and so have the coefficients of the linear equations.
const ROUNDINGS: f64 = 4.0;

/// With spare constraints, a step this short relative to the state is treated as rounding error: the active
/// constraints may determine the state a hundred times less accurately than others would.
const ROUNDING: f64 = 1e-12;

/// A step this short relative to the state is treated as rounding error where the error of f has no bound, at
/// an edge of its domain.
const SHORT: f64 = 1e-8;

/// Storage up to this length is allocated in advance.
const SMALL: usize = 4096;

/// The conditions that define a surface, as expressions in t, x, η and parameters.
#[derive(Debug)]
pub(crate) struct Conditions<'a, 'g> {
    /// The functions f(t, x) for the constraints on positions.
    pub(crate) positions: &'a [Expr<'g>],
    /// The index of the constraint of each f.
    pub(crate) places: Vec<usize>,
    /// The functions g(t, x, η) for all constraints; for constraints on positions, g = ḟ.
    pub(crate) velocities: &'a [Expr<'g>],
    /// Whether every g is affine in η.
    pub(crate) affine: bool,
    /// Functions that vanish where the constraints hold, with the names of the constraints that they represent.
    pub(crate) followers: &'a [(String, Expr<'g>)],
    /// b η
    pub(crate) displacements: &'a [Expr<'g>],
    /// The lower triangle of the mass matrix bordered by −C = −∂g/∂η, and its pattern.
    pub(crate) lower: Pattern,
    pub(crate) bordered: &'a [Expr<'g>],
    /// Number of quasi-velocities.
    pub(crate) quasi_velocities: usize,
    /// The number of independent constraints.
    pub(crate) rank: usize,
}

/// The states (x, η) with f(t, x) = 0 and g(t, x, η) = 0.
///
/// A state is moved onto the surface by the shortest path in the kinetic metric: first x by δx = b δπ with δπ
/// in the span of M⁻¹ ∂f/∂π, then η to the nearest solution.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Surface {
    pub(super) coordinates: usize,
    pub(super) k: usize,
    /// The number of independent constraints.
    pub(super) rank: usize,
    pub(super) positions: Measured,
    pub(super) places: Vec<usize>,
    pub(super) velocities: Measured,
    followers: Followers,
    pub(super) displacements: Evaluator,
    pub(super) lower: Pattern,
    pub(super) bordered: Evaluator,
    pub(super) entries: Vec<f64>,
    /// The positions of the diagonal entries of the mass matrix among its nonzero entries.
    diagonal: Vec<Option<usize>>,
    /// Masses with which steps of the quasi-velocities are weighted, all positive.
    pub(super) weights: Vec<f64>,
    solver: Solver,
    /// The time for which the matrix is factorised.
    factorised: f64,
    /// A right-hand side, then a solution.
    pub(super) change: Vec<f64>,
    /// x, then δπ.
    pub(super) displaced: Vec<f64>,
    room: Room,
    pub(super) spans: Spans,
    /// The velocities nearest to which a solution is sought.
    pub(super) given: Vec<f64>,
    /// Whether g is affine in η, so that one step leads to the nearest solution.
    pub(crate) affine: bool,
}

/// Storage for a step of Newton's method: its start, its change, and the errors of f there.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
struct Room {
    start: Vec<f64>,
    change: Vec<f64>,
    errors: Vec<f64>,
}

/// Storage for the rows of the constraints at both ends of a step, and for the products of these rows.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(super) struct Spans {
    pub(super) before: Vec<f64>,
    pub(super) later: Vec<f64>,
    pub(super) products: Vec<f64>,
}

impl Spans {
    /// Storage for m constraints on k unknowns; if there are many, it grows on demand.
    fn of(m: usize, k: usize) -> Spans {
        let room = |len: usize| if len <= SMALL { vec![0.0; len] } else { Vec::new() };
        Spans { before: room(m * k), later: room(m * k), products: room(m * m) }
    }
}

/// The part of a state that is moved.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Part {
    /// x, to f = 0.
    Position,
    /// η, to g = 0.
    Velocity,
}

impl Surface {
    /// # Errors
    /// As for [`Program::new`].
    pub(crate) fn new<'g>(
        inputs: &Inputs<'g>,
        conditions: Conditions<'_, 'g>,
        graph: &'g pc_expr::Graph,
    ) -> Result<Surface, ExprError> {
        let compiled = |outputs: &[Expr<'g>]| -> Result<Evaluator, ExprError> {
            Ok(Evaluator::new(Program::new(graph, inputs, outputs)?, Backend::Interpreter))
        };
        let (k, m) = (conditions.quasi_velocities, conditions.velocities.len());
        let coordinates = conditions.displacements.len();
        let place = |s: usize| conditions.lower.entries().position(|entry| entry == (s, s));
        Ok(Surface {
            diagonal: (0..k).map(place).collect(),
            weights: vec![1.0; k],
            coordinates,
            k,
            positions: Measured::new(graph, inputs, conditions.positions, Backend::Interpreter)?,
            velocities: Measured::new(graph, inputs, conditions.velocities, Backend::Interpreter)?,
            followers: Followers::new(graph, inputs, conditions.followers)?,
            displacements: compiled(conditions.displacements)?,
            bordered: compiled(conditions.bordered)?,
            entries: vec![0.0; conditions.lower.len()],
            lower: conditions.lower,
            solver: Solver::of_rank(k + m, m, conditions.rank),
            factorised: f64::NAN,
            rank: conditions.rank,
            change: vec![0.0; k + m],
            displaced: vec![0.0; inputs.state.len()],
            places: conditions.places,
            room: Room::default(),
            spans: Spans::of(m, k),
            given: Vec::new(),
            affine: conditions.affine,
        })
    }

    /// Writes f for constraints on positions and g for the others.
    pub(crate) fn residuals(&mut self, at: Point<'_>, residuals: &mut [f64]) {
        residuals.copy_from_slice(self.velocities.eval(at));
        for (&place, &value) in self.places.iter().zip(self.positions.eval(at)) {
            residuals[place] = value;
        }
    }

    /// Moves `y` to the surface.
    ///
    /// # Errors
    /// [`EvaluationFailure::NoProjection`] if no step leads closer, [`EvaluationFailure::Constraint`] where
    /// the surface is singular, [`EvaluationFailure::Departed`] where a condition that should follow from the
    /// constraints does not hold.
    pub(crate) fn project(&mut self, t: f64, y: &mut [f64], p: &[f64]) -> Result<(), EvaluationFailure> {
        self.factorise(t, y, p)?;
        if !self.places.is_empty() {
            self.project_part(Part::Position, t, y, p)?;
        }
        self.project_to_nearest(t, y, p)?;
        self.followers.check(t, y, p)
    }

    /// Moves the η of `y` to g = 0; x is unchanged.
    ///
    /// # Errors
    /// As for [`project`](Surface::project).
    pub(crate) fn project_velocities(
        &mut self,
        t: f64,
        y: &mut [f64],
        p: &[f64],
    ) -> Result<(), EvaluationFailure> {
        self.factorise(t, y, p)?;
        self.project_to_nearest(t, y, p)
    }

    pub(super) fn factorise(&mut self, t: f64, y: &[f64], p: &[f64]) -> Result<(), EvaluationFailure> {
        self.bordered.eval(t, y, p, &mut self.entries);
        check_finite(&self.entries, &self.bordered, Point { t, y, p })?;
        self.weigh();
        self.factorised = f64::NAN;
        self.solver.factorise(&self.lower, &self.entries)?;
        self.factorised = t;
        Ok(())
    }

    /// Writes how far the constraints are from losing rank at the end (t, y) of a step: if this state was the last to be
    /// projected, that is already known. False if there are none.
    pub(crate) fn independence_to(
        &mut self,
        (t, y): (f64, &[f64]),
        p: &[f64],
        found: &mut Independence,
    ) -> Result<bool, EvaluationFailure> {
        if self.factorised != t {
            self.factorise(t, y, p)?;
        }
        Ok(self.solver.independence_to(found))
    }

    /// How far the constraints are from losing rank, at any state.
    pub(crate) fn independence_at(
        &mut self,
        t: f64,
        y: &[f64],
        p: &[f64],
    ) -> Result<Option<Independence>, EvaluationFailure> {
        self.factorise(t, y, p)?;
        let mut found = Independence::default();
        Ok(self.solver.independence_to(&mut found).then_some(found))
    }

    /// Takes the weights from the diagonal of the mass matrix; a component without mass gets the smallest of the
    /// other weights.
    pub(super) fn weigh(&mut self) {
        let masses =
            || self.diagonal.iter().map(|place| place.map_or(0.0, |place| self.entries[place].abs()));
        let lightest = masses().filter(|&mass| mass > 0.0).fold(f64::INFINITY, f64::min);
        let lightest = if lightest.is_finite() { lightest } else { 1.0 };
        let weights = masses().map(|mass| if mass > 0.0 { mass } else { lightest });
        self.weights.iter_mut().zip(weights).for_each(|(weight, mass)| *weight = mass);
    }

    /// Solves f(t, x) = 0 or g(t, x, η) = 0 by Newton's method, which ends after one step where g is affine in
    /// η; the matrix stays factorised at the end point.
    ///
    /// Steps are measured by δπ, in the metric given by the diagonal of M, and so independently of the units of
    /// f. A state is on the surface where f is within the bound of its rounding errors, where a step changes no
    /// digit, or where a step is no longer than such errors alone could make it: then one last full step is
    /// taken.
    pub(super) fn project_part(
        &mut self,
        part: Part,
        t: f64,
        y: &mut [f64],
        p: &[f64],
    ) -> Result<(), EvaluationFailure> {
        let mut room = std::mem::take(&mut self.room);
        let outcome = self.project_part_in(&mut room, part, (t, p), y);
        self.room = room;
        outcome
    }

    fn project_part_in(
        &mut self,
        Room { start, change, errors }: &mut Room,
        part: Part,
        (t, p): (f64, &[f64]),
        y: &mut [f64],
    ) -> Result<(), EvaluationFailure> {
        let n = self.coordinates;
        let range = if part == Part::Position { 0..n } else { n..n + self.k };
        self.measured(part).try_eval(Point { t, y, p })?;
        for _ in 0..MOST_STEPS {
            let rest = self.measured(part).in_errors();
            if rest <= ONE_ROUNDING {
                return Ok(());
            }
            errors.clear();
            errors.extend(self.measured(part).errors());
            let length = self.step(part);
            start.clear();
            start.extend_from_slice(&y[range.clone()]);
            self.move_by(part, Point { t, y, p }, change);
            // Constraints that depend on the active ones hold within the rounding errors of the latter, not
            // within their own.
            let largest = |values: &[f64]| values.iter().fold(0.0f64, |size, x| size.max(x.abs()));
            let has_spare = self.rank < self.velocities.values().len();
            if has_spare && largest(change) <= ROUNDING * largest(start) {
                y[range].iter_mut().zip(&*change).for_each(|(y, change)| *y += change);
                return Ok(());
            }
            if start.iter().zip(&*change).all(|(y, change)| y + change == *y) {
                return Ok(());
            }
            let mut go = |surface: &mut Surface, fraction: f64| {
                let moving = y[range.clone()].iter_mut().zip(&*start).zip(&*change);
                moving.for_each(|((y, start), change)| *y = start + fraction * change);
                let is_finite = surface.measured(part).try_eval(Point { t, y, p }).is_ok();
                is_finite.then(|| (surface.step(part), surface.measured(part).in_errors()))
            };
            let whole = go(self, 1.0);
            let converges = whole.is_some_and(|(next, _)| next <= CONVERGING * length);
            if !converges && (rest <= 1.0 || self.is_rounding(part, errors, length, change, start)) {
                if whole.is_none_or(|(_, left)| left >= rest) {
                    y[range].copy_from_slice(start);
                    self.measured(part).try_eval(Point { t, y, p })?;
                }
                return self.factorise(t, y, p);
            }
            if !converges && self.damped(length, |surface, fraction| Some(go(surface, fraction)?.0)).is_none()
            {
                y[range].copy_from_slice(start);
                return Err(EvaluationFailure::NoProjection { unknowns: self.k });
            }
            self.factorise(t, y, p)?;
        }
        Err(EvaluationFailure::NoProjection { unknowns: self.k })
    }

    /// Halves a step until the next one, with the same matrix, is shorter (the natural monotonicity test of
    /// P. Deuflhard, Numer. Math. 22, 1974, 289–315); `length` is that of the full step. `None` if no
    /// fraction is accepted.
    fn damped(&mut self, length: f64, mut go: impl FnMut(&mut Surface, f64) -> Option<f64>) -> Option<f64> {
        (0..=HALVINGS)
            .map(|halvings| 0.5f64.powi(halvings))
            .find(|&fraction| go(self, fraction).is_some_and(|next| next <= (1.0 - fraction / 4.0) * length))
    }

    /// Whether errors of f within these bounds can cause a step of this length, with the factorised matrix.
    fn is_rounding(
        &mut self,
        part: Part,
        errors: &[f64],
        length: f64,
        change: &[f64],
        state: &[f64],
    ) -> bool {
        let largest = |values: &[f64]| values.iter().fold(0.0f64, |size, x| size.max(x.abs()));
        if !errors.iter().all(|error| error.is_finite()) {
            return largest(change) <= SHORT * largest(state);
        }
        let mut noise = 0.0;
        for (place, &error) in errors.iter().enumerate() {
            self.change.fill(0.0);
            let row = if part == Part::Position { self.places[place] } else { place };
            self.change[self.k + row] = error;
            self.solver.solve(&mut self.change);
            noise += self.length();
        }
        length <= ROUNDINGS * noise
    }

    pub(super) fn measured(&mut self, part: Part) -> &mut Measured {
        match part {
            Part::Position => &mut self.positions,
            Part::Velocity => &mut self.velocities,
        }
    }

    /// Computes the step for the current values into `change`, with the factorised matrix. Returns its
    /// length.
    fn step(&mut self, part: Part) -> f64 {
        let multipliers = &mut self.change[self.k..];
        match part {
            Part::Position => {
                multipliers.fill(0.0);
                for (&place, &value) in self.places.iter().zip(self.positions.values()) {
                    multipliers[place] = value;
                }
            }
            Part::Velocity => multipliers.copy_from_slice(self.velocities.values()),
        }
        self.change[..self.k].fill(0.0);
        self.solver.solve(&mut self.change);
        self.length()
    }

    /// The length of the δπ in `change`, whose square may underflow or overflow.
    fn length(&self) -> f64 {
        let components = || self.change.iter().zip(&self.weights).map(|(change, mass)| change * mass.sqrt());
        components().fold(0.0, f64::hypot)
    }

    /// Writes the change in x or in η that the step causes to `moved`.
    pub(super) fn move_by(&mut self, part: Part, Point { t, y, p }: Point<'_>, moved: &mut Vec<f64>) {
        let (n, k) = (self.coordinates, self.k);
        moved.clear();
        match part {
            Part::Velocity => moved.extend_from_slice(&self.change[..k]),
            Part::Position => {
                moved.resize(n, 0.0);
                self.displaced[..n].copy_from_slice(&y[..n]);
                self.displaced[n..n + k].copy_from_slice(&self.change[..k]);
                self.displaced[n + k..].copy_from_slice(&y[n + k..]);
                self.displacements.eval(t, &self.displaced, p, moved);
            }
        }
    }
}

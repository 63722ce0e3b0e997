//! Why rates could not be computed.

use pc_expr::{Evaluator, ExprError};

use crate::compiled::point::Point;
use crate::error::{ConstraintError, EvaluationError, IntegralError, MechError};

/// A failure without its time and state.
#[derive(Debug)]
pub(crate) enum EvaluationFailure {
    /// The pivot of the unknown with this index vanished.
    Pivot { index: usize, pivot: f64 },
    /// The constraint with this index among unknowns and constraints is degenerate at this state.
    Constraint { index: usize },
    /// The state is too far from satisfying the constraints, whose indices start after this number of
    /// unknowns.
    NoProjection { unknowns: usize },
    /// A condition that should follow from the other constraints does not hold at a state that satisfies
    /// them.
    Departed { constraint: String },
    /// Newton's method ended with |F| = `residual`.
    NotSolved { residual: f64, iterations: usize },
    /// The state is too far from the states at which the integrals have the values to be kept.
    NotKept,
    /// The motion was compiled without this part.
    NotCompiled { what: &'static str },
    /// A value is not finite.
    Expr(ExprError),
}

impl EvaluationFailure {
    /// The same failure, with `place` applied to the index of its pivot.
    pub(crate) fn at_place(self, place: impl Fn(usize) -> usize) -> EvaluationFailure {
        match self {
            EvaluationFailure::Pivot { index, pivot } => {
                EvaluationFailure::Pivot { index: place(index), pivot }
            }
            other => other,
        }
    }

    /// The error for this failure at a state whose components have these `names`; `unknowns` are the
    /// names of unknowns and constraints.
    pub(crate) fn at(self, unknowns: &[String], t: f64, names: &[String], state: &[f64]) -> MechError {
        let state = || names.iter().cloned().zip(state.iter().copied()).collect();
        // A combination of unknowns, whose pivot may be the one that vanishes, has no name.
        let name =
            |index: usize| unknowns.get(index).cloned().unwrap_or_else(|| format!("unknown {}", index + 1));
        match self {
            EvaluationFailure::Pivot { index, pivot } => {
                let quasi_velocity = name(index);
                EvaluationError::SingularMassMatrix { quasi_velocity, pivot, t, state: state() }.into()
            }
            EvaluationFailure::Constraint { index } => {
                ConstraintError::Singular { constraint: name(index), t, state: state() }.into()
            }
            EvaluationFailure::NoProjection { unknowns: k } => ConstraintError::NoProjection {
                constraints: unknowns.iter().skip(k).cloned().collect(),
                t,
                state: state(),
            }
            .into(),
            EvaluationFailure::Departed { constraint } => {
                ConstraintError::Departed { constraint, t, state: state() }.into()
            }
            EvaluationFailure::NotSolved { residual, iterations } => {
                EvaluationError::LegendreNotSolved { residual, iterations, t, state: state() }.into()
            }
            EvaluationFailure::NotKept => IntegralError::NotKept { t, state: state() }.into(),
            EvaluationFailure::NotCompiled { what } => EvaluationError::NotCompiled { what }.into(),
            EvaluationFailure::Expr(error) => error.into(),
        }
    }
}

/// Checks that all values are finite.
///
/// # Errors
/// [`EvaluationFailure::Expr`] for the first intermediate value that is not finite.
pub(crate) fn check_finite(
    values: &[f64],
    evaluator: &Evaluator,
    at: Point<'_>,
) -> Result<(), EvaluationFailure> {
    // One number at a time, with an early exit: wider reads would wait for the numbers just written.
    if values.iter().all(|value| value.is_finite()) { Ok(()) } else { Err(blame(evaluator, at)) }
}

/// The failure that names the first intermediate value that is not finite.
#[cold]
pub(crate) fn blame(evaluator: &Evaluator, Point { t, y, p }: Point<'_>) -> EvaluationFailure {
    EvaluationFailure::Expr(evaluator.blame(t, y, p))
}

//! Why rates could not be computed.

use pc_expr::{Evaluator, ExprError};

use crate::compiled::point::Point;
use crate::error::{ConstraintError, EvaluationError, IntegralError, MechError};

/// What is wrong, before it is known where.
#[derive(Debug)]
pub(crate) enum EvaluationFailure {
    /// The pivot of the unknown of that index vanished.
    Pivot { index: usize, pivot: f64 },
    /// The constraint of that index among unknowns and constraints is none at this state.
    Constraint { index: usize },
    /// The state is not near those that satisfy the constraints, which follow so many unknowns.
    NoProjection { unknowns: usize },
    /// A constraint that followed from the others does not vanish where they do.
    Departed { constraint: String },
    /// Newton's method ended with |F| = `residual`.
    NotSolved { residual: f64, iterations: usize },
    /// The state is not near those with the values of the integrals.
    NotKept,
    /// A part that the motion was compiled without.
    NotCompiled { what: &'static str },
    /// A value is not finite.
    Expr(ExprError),
}

impl EvaluationFailure {
    /// The same of a pivot whose unknown has another index.
    pub(crate) fn at_place(self, place: impl Fn(usize) -> usize) -> EvaluationFailure {
        match self {
            EvaluationFailure::Pivot { index, pivot } => {
                EvaluationFailure::Pivot { index: place(index), pivot }
            }
            other => other,
        }
    }

    /// The error, of the unknowns and constraints called `unknowns`, at the state with these `names`.
    pub(crate) fn at(self, unknowns: &[String], t: f64, names: &[String], state: &[f64]) -> MechError {
        let state = || names.iter().cloned().zip(state.iter().copied()).collect();
        match self {
            EvaluationFailure::Pivot { index, pivot } => {
                let quasi_velocity = unknowns[index].clone();
                EvaluationError::SingularMassMatrix { quasi_velocity, pivot, t, state: state() }.into()
            }
            EvaluationFailure::Constraint { index } => {
                ConstraintError::Singular { constraint: unknowns[index].clone(), t, state: state() }.into()
            }
            EvaluationFailure::NoProjection { unknowns: k } => {
                ConstraintError::NoProjection { constraints: unknowns[k..].to_vec(), t, state: state() }
                    .into()
            }
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

/// That all values are finite.
///
/// # Errors
/// [`EvaluationFailure::Expr`] for the first that is not on the way to them.
pub(crate) fn check_finite(
    values: &[f64],
    evaluator: &Evaluator,
    at: Point<'_>,
) -> Result<(), EvaluationFailure> {
    // Number by number, with an early end: to look at several at a time would wait for those just written.
    if values.iter().all(|value| value.is_finite()) { Ok(()) } else { Err(blame(evaluator, at)) }
}

/// What is to blame for values that are not finite.
#[cold]
pub(crate) fn blame(evaluator: &Evaluator, Point { t, y, p }: Point<'_>) -> EvaluationFailure {
    EvaluationFailure::Expr(evaluator.blame(t, y, p))
}

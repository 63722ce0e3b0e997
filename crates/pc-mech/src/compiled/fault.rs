//! Why rates could not be computed.

use pc_expr::{Evaluator, ExprError};

/// What is wrong, before it is known where.
#[derive(Debug)]
pub(crate) enum Fault {
    /// The pivot of the unknown of that index vanished.
    Pivot { index: usize, pivot: f64 },
    /// The state is not near those that satisfy the constraints.
    NoProjection,
    /// A part that the motion was compiled without.
    NotCompiled { what: &'static str },
    /// A value is not finite.
    Expr(ExprError),
}

/// Finds what is to blame for values that are not finite.
///
/// # Errors
/// [`Fault::Expr`] for the first such value on the way to them, if there is one.
pub(crate) fn check_finite(
    values: &[f64],
    evaluator: &Evaluator,
    (t, state, parameters): (f64, &[f64], &[f64]),
) -> Result<(), Fault> {
    if values.iter().all(|value| value.is_finite()) {
        Ok(())
    } else {
        blame(evaluator, (t, state, parameters))
    }
}

/// As [`check_finite`] for values that are known not to be.
#[cold]
pub(crate) fn blame(
    evaluator: &Evaluator,
    (t, state, parameters): (f64, &[f64], &[f64]),
) -> Result<(), Fault> {
    evaluator.diagnose(t, state, parameters).map_or(Ok(()), |error| Err(Fault::Expr(error)))
}

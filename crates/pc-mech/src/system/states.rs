//! First-order states, which are not part of a frame.

use pc_expr::Expr;

use crate::error::{FrameError, MechError};

/// Checks that `parts`, called `what`, contain none of the first-order `states`.
///
/// # Errors
/// [`FrameError::OfState`]
pub(crate) fn check_no_state<'g>(
    states: &[(Expr<'g>, Expr<'g>)],
    what: &'static str,
    parts: &[Expr<'g>],
) -> Result<(), MechError> {
    match states.iter().find(|(z, _)| parts.iter().any(|part| part.depends_on(*z))) {
        Some((z, _)) => Err(FrameError::OfState { what, state: z.to_string() }.into()),
        None => Ok(()),
    }
}

//! The memory of the rows of a motion, known before it is integrated.

use pc_expr::Limits;
use pc_mech::VectorField;
use pc_model::Flow;

use crate::error::CliError;
use crate::motion::plan::Plan;

/// Copies of the states while a checkpoint is written: what was reached before, what it is now, and its bytes.
const CHECKPOINTED: u64 = 3;

/// Numbers that are held for each row until the table is written.
pub(crate) fn numbers(flow: &Flow, plan: &Plan, checkpointed: bool) -> u64 {
    let dim = flow.motion.dim() as u64;
    let columns = 1 + flow.names.len() as u64 + flow.motion.observable_names().len() as u64;
    let copies = if checkpointed { CHECKPOINTED } else { 1 };
    // The derivatives of each state are held by the trajectory and apart from it, each time with where they are.
    let derivatives = match plan.sensitivities.len() as u64 {
        0 => 0,
        parameters => parameters * (2 * dim + flow.names.len() as u64) + dim + 4,
    };
    // The time when it is asked for, the time and state when it is reached, the row of the table.
    1 + copies * (1 + dim) + columns + derivatives
}

/// That so many rows of so many numbers are within the memory of the limits.
///
/// # Errors
/// [`CliError::Rows`]
pub(crate) fn allow(rows: u64, numbers: u64, limits: &Limits) -> Result<(), CliError> {
    let bytes = rows.saturating_mul(numbers).saturating_mul(size_of::<f64>() as u64);
    if bytes > limits.memory {
        return Err(CliError::Rows { rows, numbers, bytes, limit: limits.memory });
    }
    Ok(())
}

/// Rows that take more than so many bytes are written while the motion is integrated, if they can.
const MUCH: u64 = 64 << 20;

/// Whether rows had better be given away, or have to.
pub(crate) fn is_much(rows: u64, numbers: u64, limits: &Limits) -> bool {
    rows.saturating_mul(numbers).saturating_mul(size_of::<f64>() as u64) > MUCH.min(limits.memory)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_within_the_limit_or_refused() {
        let limits = Limits { memory: 8000, ..Limits::default() };
        assert!(allow(100, 10, &limits).is_ok());
        let refused = allow(101, 10, &limits).expect_err("too many");
        assert!(matches!(refused, CliError::Rows { bytes: 8080, limit: 8000, .. }), "{refused}");
        let refused = allow(u64::MAX, 10, &limits).expect_err("far too many");
        assert!(matches!(refused, CliError::Rows { bytes: u64::MAX, .. }));
    }
}

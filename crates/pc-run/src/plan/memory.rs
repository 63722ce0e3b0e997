//! The memory needed for the rows of a motion, which is known before the motion is integrated.

use pc_expr::Limits;
use pc_mech::VectorField;
use pc_model::Flow;

use crate::error::RunError;
use crate::plan::Plan;

/// The number of copies of the states in memory while a checkpoint is written: those of the last checkpoint,
/// the current ones, and the bytes to be written.
const CHECKPOINTED: u64 = 3;

/// How many numbers are held in memory for each row until the table is written; `again` is the number of further rows that are
/// held for each row of a motion with a companion, and zero without.
pub(crate) fn numbers(flow: &Flow, plan: &Plan, checkpointed: bool, again: u64) -> u64 {
    let dim = flow.motion.dim() as u64;
    let columns = 1 + flow.columns().len() as u64;
    let copies = if checkpointed { CHECKPOINTED } else { 1 };
    // Derivatives are held by the trajectory and separately, with their times and states, and in
    // the row of the table.
    let derivatives = match plan.sensitivities.len() as u64 {
        0 => 0,
        parameters => parameters * (2 * dim + flow.names.len() as u64) + dim + 4,
    };
    // The state of the companion, and the rows.
    let errors = if again > 0 { 2 + dim + again * columns } else { 0 };
    // The requested time; the time and state of the trajectory; the row of the table.
    1 + copies * (1 + dim) + columns + derivatives + errors
}

/// An error unless `rows` rows of `numbers` numbers each fit within the memory limit.
///
/// # Errors
/// [`RunError::Rows`]
pub(crate) fn allow(rows: u64, numbers: u64, limits: &Limits) -> Result<(), RunError> {
    let bytes = rows.saturating_mul(numbers).saturating_mul(size_of::<f64>() as u64);
    if bytes > limits.memory {
        return Err(RunError::Rows { rows, numbers, bytes, limit: limits.memory });
    }
    Ok(())
}

/// Rows that take more bytes than this are written as they are computed, if possible.
const MUCH: u64 = 64 << 20;

/// Whether rows take so much memory that they should be written as they are computed.
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
        assert!(matches!(refused, RunError::Rows { bytes: 8080, limit: 8000, .. }), "{refused}");
        let refused = allow(u64::MAX, 10, &limits).expect_err("far too many");
        assert!(matches!(refused, RunError::Rows { bytes: u64::MAX, .. }));
    }
}

//! What a sweep does for each of its members: from a model to a record.

use std::ops::{ControlFlow, Range};

use pc_solve::{Ending, Ensemble, EnsembleError, Panicked};

use super::members::Members;
use super::record::Record;
use super::shard::Shard;
use crate::error::RunError;

/// Receives the record of a member, given by its place in the shard; none if it was interrupted on its way or ended by a time
/// limit.
pub(crate) type Consume<'c> = &'c mut dyn FnMut(u64, Result<Option<Record>, Panicked>) -> ControlFlow<()>;

/// The work of a sweep: one record per member, whose rows all have the same columns.
pub(crate) trait Work {
    /// The models, and the contents of their rows.
    fn members(&self) -> &Members;

    /// Compares some members with a second derivation of each, before any begins.
    ///
    /// # Errors
    /// [`RunError::Verify`] if that disagrees.
    fn vouched(&self) -> Result<(), RunError>;

    /// Rows of a member.
    fn rows(&self) -> usize {
        1
    }

    /// The records of the members of a shard at these places, in their order.
    ///
    /// # Errors
    /// [`EnsembleError`] if threads cannot be started.
    fn records(
        &self,
        ensemble: &Ensemble<'_>,
        shard: Shard,
        places: Range<u64>,
        consume: Consume<'_>,
    ) -> Result<Ending, EnsembleError>;

    /// Lines of the summary before the number of members.
    fn said(&self) -> Vec<(&'static str, String)> {
        Vec::new()
    }

    /// Remarks of the summary on the work that was done, after the time it took.
    fn done(&self) -> String {
        String::new()
    }
}

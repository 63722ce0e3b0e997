//! What a sweep does for each of its members: from a model to a record.

use std::ops::{ControlFlow, Range};

use pc_solve::{Ending, Ensemble, EnsembleError, Panicked};

use super::members::Members;
use super::record::Record;
use super::shard::Shard;
use crate::error::RunError;

/// What takes the record of a member, given by its place in the shard; none of one that was interrupted on its way or ended by a
/// limit of time.
pub(crate) type Consume<'c> = &'c mut dyn FnMut(u64, Result<Option<Record>, Panicked>) -> ControlFlow<()>;

/// The work of a sweep: one member, one record, of which each row has the same columns.
pub(crate) trait Work {
    /// The models, and what stands in their rows.
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

    /// What the summary says of the work that was done, behind the time it took.
    fn done(&self) -> String {
        String::new()
    }
}

//! The work that a sweep does for each of its members, from a model to a record.

use std::ops::{ControlFlow, Range};

use pc_solve::{Ending, Ensemble, EnsembleError, Panicked};

use super::members::Members;
use super::record::Record;
use super::shard::Shard;
use crate::error::RunError;

/// Receives the place of a member in the shard and its record, which is none if the member was interrupted or ended by a time
/// limit.
pub(crate) type Consume<'c> = &'c mut dyn FnMut(u64, Result<Option<Record>, Panicked>) -> ControlFlow<()>;

/// The work of a sweep: it makes one record for each member, and all rows have the same columns.
pub(crate) trait Work {
    /// The models, and the contents of their rows.
    fn members(&self) -> &Members;

    /// Compares some members with a second derivation of each, before any member begins.
    ///
    /// # Errors
    /// [`RunError::Verify`] if a second derivation disagrees.
    fn vouched(&self) -> Result<(), RunError>;

    /// The number of rows of a member.
    fn rows(&self) -> usize {
        1
    }

    /// Passes the records of the members of a shard at these places to `consume`, in order.
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

    /// The lines of the summary that precede the number of members.
    fn said(&self) -> Vec<(&'static str, String)> {
        Vec::new()
    }

    /// The remarks in the summary on the work that was done, which follow the time it took.
    fn done(&self) -> String {
        String::new()
    }
}

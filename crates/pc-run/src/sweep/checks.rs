//! Finds the properties of each member, as `pc check` does.

use std::ops::Range;

use pc_model::Model;
use pc_report::{Check, Finding};
use pc_solve::{Ending, Ensemble, EnsembleError};

use super::design::Design;
use super::members::{Members, message};
use super::record::{Record, Status};
use super::shard::Shard;
use super::work::{Consume, Work};
use crate::error::RunError;
use crate::motion::verification::checked;
use crate::table::rows::{CellKind, Column};

/// Checks each member.
pub(crate) struct Checks {
    members: Members,
}

impl Checks {
    pub(crate) fn new(model: Model, design: Design) -> Checks {
        let kind = |is_number| if is_number { CellKind::Number } else { CellKind::Text };
        let columns = Check::FINDINGS.iter().map(|&(name, is_number)| Column::new(name, kind(is_number)));
        Checks { members: Members::new(model, design, columns.collect()) }
    }

    fn record(&self, member: u64) -> Option<Record> {
        if self.members.is_over() {
            return None;
        }
        let blank = self.members.blank(member);
        match findings(&self.members.model(&blank)) {
            Ok(findings) => {
                let (mut rows, mut words) = (Vec::new(), Vec::new());
                for finding in findings {
                    match finding {
                        Finding::Number(number) => rows.push(number),
                        Finding::Words(text) => words.push(text),
                    }
                }
                Some(Record { status: Status::Completed, rows, words, ..blank })
            }
            Err(error @ RunError::Verify(_)) => self.members.ended(Status::Failed, &message(&error), blank),
            Err(error) => self.members.ended(Status::Refused, &message(&error), blank),
        }
    }
}

fn findings(model: &Model) -> Result<[Finding; Check::FINDINGS.len()], RunError> {
    model.derived(|assembly| Ok(checked(model, assembly, &assembly.equations()?)?.findings()))
}

impl Work for Checks {
    fn members(&self) -> &Members {
        &self.members
    }

    /// Does nothing here: each member is compared when it is checked.
    fn vouched(&self) -> Result<(), RunError> {
        Ok(())
    }

    fn records(
        &self,
        ensemble: &Ensemble<'_>,
        shard: Shard,
        places: Range<u64>,
        consume: Consume<'_>,
    ) -> Result<Ending, EnsembleError> {
        ensemble.map(places, |place, _| self.record(shard.member(place)), consume)
    }
}

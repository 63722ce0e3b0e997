//! What a sweep does for each of its members: from a model to a record.

use std::error::Error;
use std::ops::{ControlFlow, Range};

use pc_model::Model;
use pc_solve::{Ending, Ensemble, EnsembleError, Panicked};

use super::design::Design;
use super::record::{Record, Status};
use super::shard::Shard;
use super::sheet::{Column, Kind};
use crate::error::CliError;

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
    /// [`CliError::Verify`] if that disagrees.
    fn vouched(&self) -> Result<(), CliError>;

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

/// The models of a sweep.
pub(crate) struct Members {
    model: Model,
    design: Design,
    columns: Vec<Column>,
}

impl Members {
    /// Those whose rows have these columns.
    pub(crate) fn new(model: Model, design: Design, columns: Vec<Column>) -> Members {
        Members { model, design, columns }
    }

    /// What stands in a row, beside number, values and status of the member.
    pub(crate) fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// The record of a member that could not start, before anything is known of it but its values: one row of nothing.
    pub(crate) fn blank(&self, member: u64) -> Record {
        let words = self.columns.iter().filter(|column| column.kind == Kind::Text).count();
        Record {
            member,
            status: Status::Refused,
            steps: 0,
            message: String::new(),
            values: self.design.values(member),
            rows: vec![f64::NAN; self.columns.len() - words],
            words: vec![String::new(); words],
        }
    }

    /// The model of a member.
    pub(crate) fn model(&self, blank: &Record) -> Model {
        let mut model = self.design.model(&self.model, &blank.values);
        // Memory is each member's own, time that of all.
        model.within(self.model.budget().beside());
        model
    }

    /// The models of the first member, of one in the middle and of the last.
    pub(crate) fn samples(&self) -> Vec<Model> {
        let last = self.design.members().saturating_sub(1);
        let mut members = vec![0, last / 2, last];
        members.dedup();
        members.into_iter().map(|member| self.model(&self.blank(member))).collect()
    }

    /// Whether the limit of time has passed.
    pub(crate) fn is_over(&self) -> bool {
        self.model.budget().deadline().passed().is_some()
    }

    /// The record of a member that ended with an error; none if time was over.
    pub(crate) fn ended(&self, status: Status, message: &str, blank: Record) -> Option<Record> {
        (!self.is_over()).then(|| Record { status, message: line(message), ..blank })
    }

    /// That of a member whose computation panicked.
    pub(crate) fn panicked(&self, member: u64, message: &str) -> Record {
        Record { status: Status::Panicked, message: line(message), ..self.blank(member) }
    }
}

/// What is wrong, without its place in the file.
pub(crate) fn message(error: &CliError) -> String {
    match error {
        CliError::Model(error) => error.diagnostic().message.clone(),
        other => chain(other).lines().next().unwrap_or_default().to_owned(),
    }
}

/// An error with its causes.
pub(crate) fn chain(error: &dyn Error) -> String {
    let mut text = error.to_string();
    let mut source = error.source();
    while let Some(error) = source {
        let cause = error.to_string();
        if !text.ends_with(&cause) {
            text += &format!("; because: {cause}");
        }
        source = error.source();
    }
    text
}

/// The text on one line.
pub(crate) fn line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

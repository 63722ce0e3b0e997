//! The models of a sweep, with what is known about each member before it begins.

use pc_model::Model;

use super::design::Design;
use super::record::{Record, Status};
use crate::chain::{chain, line};
use crate::error::RunError;
use crate::table::rows::{CellKind, Column};

/// The models of a sweep.
pub(crate) struct Members {
    model: Model,
    design: Design,
    columns: Vec<Column>,
}

impl Members {
    /// The members of a design; their rows have these columns.
    pub(crate) fn new(model: Model, design: Design, columns: Vec<Column>) -> Members {
        Members { model, design, columns }
    }

    /// The contents of a row, apart from the number, values and status of the member.
    pub(crate) fn columns(&self) -> &[Column] {
        &self.columns
    }

    /// The record of a member that could not start and about which only the values are known: one empty row.
    pub(crate) fn blank(&self, member: u64) -> Record {
        let words = self.columns.iter().filter(|column| column.kind == CellKind::Text).count();
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

    /// The models of the first member, a member in the middle and the last member.
    pub(crate) fn samples(&self) -> Vec<Model> {
        let Some(last) = self.design.members().checked_sub(1) else { return Vec::new() };
        let mut members = vec![0, last / 2, last];
        members.dedup();
        members.into_iter().map(|member| self.model(&self.blank(member))).collect()
    }

    /// Whether the time limit has passed.
    pub(crate) fn is_over(&self) -> bool {
        self.model.budget().deadline().passed().is_some()
    }

    /// The record of a member that ended with an error; none if the time limit had passed.
    pub(crate) fn ended(&self, status: Status, message: &str, blank: Record) -> Option<Record> {
        (!self.is_over()).then(|| Record { status, message: line(message), ..blank })
    }

    /// The record of a member whose computation panicked.
    pub(crate) fn panicked(&self, member: u64, message: &str) -> Record {
        Record { status: Status::Panicked, message: line(message), ..self.blank(member) }
    }
}

/// The message of an error, without its place in the file.
pub(crate) fn message(error: &RunError) -> String {
    match error {
        RunError::Model(error) => error.diagnostic().message.clone(),
        other => chain(other).lines().next().unwrap_or_default().to_owned(),
    }
}

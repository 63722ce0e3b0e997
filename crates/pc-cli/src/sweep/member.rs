//! The motion of one member.

use std::error::Error;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicU64, Ordering};

use pc_expr::{LaneField, VectorField};
use pc_model::{Flow, Model, ModelError, Prototype};
use pc_solve::{Ending, Events, Options, Solution, Solve, Stop, Trajectory};

use super::design::Design;
use super::record::{Record, Status};
use crate::args::forms::RunForm;
use crate::motion::interrupt;
use crate::motion::plan::Plan;
use crate::motion::table::Table;

/// What all members share.
pub(crate) struct Members {
    model: Model,
    design: Design,
    form: RunForm,
    t_start: f64,
    times: Vec<f64>,
    options: Options,
    /// Whether all rows are wanted instead of the last.
    all_rows: bool,
    /// Number of columns of a motion, `t` first.
    columns: usize,
    prototype: Option<Prototype>,
    /// How many were completed beside others, in vectors.
    beside: AtomicU64,
}

/// A member before its motion: its equations and the beginning of its record, or the record of an
/// error; none if the time limit was reached.
type Begun = Result<Box<(Flow, Record)>, Option<Record>>;

impl Members {
    /// `rows` says whether all rows of the plan are wanted instead of the last.
    pub(crate) fn new(
        model: Model,
        design: Design,
        form: RunForm,
        plan: &Plan,
        rows: bool,
        columns: usize,
    ) -> Self {
        let (t_start, times, options) = (plan.t_start, plan.times(), plan.options());
        let prototype = Prototype::new(&model, form.into());
        let beside = AtomicU64::new(0);
        Members { model, design, form, t_start, times, options, all_rows: rows, columns, prototype, beside }
    }

    /// A member before its motion and, if it can be integrated beside others, its field and start.
    pub(crate) fn begin(&self, member: u64) -> (Begun, Option<(LaneField, Vec<f64>)>) {
        let values = self.design.values(member);
        let blank = Record {
            member,
            status: Status::Refused,
            steps: 0,
            message: String::new(),
            values,
            rows: vec![f64::NAN; self.width()],
        };
        let mut model = self.design.model(&self.model, &blank.values);
        // The memory limit holds for each member, the time limit for all together.
        model.within(self.model.budget().beside());
        match self.flow(&model) {
            Ok(mut flow) => {
                let free = flow.events.events().is_empty() && flow.motion.breaks().is_empty();
                let lane = if free { flow.motion.lanes() } else { None };
                let lane = lane.map(|field| (field, flow.start.clone()));
                (Ok(Box::new((flow, blank))), lane)
            }
            Err(_) if model.budget().deadline().passed().is_some() => (Err(None), None),
            Err(error) => (Err(Some(Record { message: line(&error.diagnostic().message), ..blank })), None),
        }
    }

    /// The record of a member that was completed beside others.
    pub(crate) fn completed(&self, begun: Begun, trajectory: &Trajectory) -> Option<Record> {
        let (mut flow, blank) = *begun.ok()?;
        self.beside.fetch_add(1, Ordering::Relaxed);
        Some(Record {
            status: Status::Completed,
            steps: trajectory.statistics().steps,
            rows: self.rows(&mut flow, trajectory, None),
            ..blank
        })
    }

    /// Integrates a member; none if it was stopped, or the time limit was reached.
    pub(crate) fn integrate(&self, begun: Begun, stop: &Stop<'_>) -> Option<Record> {
        let (mut flow, blank) = match begun {
            Ok(begun) => *begun,
            Err(record) => return record,
        };
        let observer = |_, _: &[f64]| {
            if stop.requested() || interrupt::requested() {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        let solve = Solve::new(&mut flow.motion, self.t_start, &flow.start).method(&self.options);
        let (motion, error) = solve.events(&mut flow.events).follow(&self.times, observer);
        let Solution { trajectory, ending, .. } = motion;
        if ending == Some(Ending::Stopped) || error.as_ref().is_some_and(|error| error.ended().is_some()) {
            return None;
        }
        let reached = error.as_ref().and_then(|error| error.reached());
        let (status, message) = match (&error, ending) {
            (Some(error), _) => (Status::Failed, line(&chain(error))),
            (None, Some(Ending::Event { event })) => {
                (Status::Event, format!("ended by the event {}", flow.events.events()[event].name()))
            }
            (None, _) => (Status::Completed, String::new()),
        };
        Some(Record {
            status,
            steps: trajectory.statistics().steps,
            message,
            rows: self.rows(&mut flow, &trajectory, reached),
            ..blank
        })
    }

    /// How many members were completed beside others.
    pub(crate) fn beside(&self) -> u64 {
        self.beside.load(Ordering::Relaxed)
    }

    /// Start, output times and options of all members.
    pub(crate) fn span(&self) -> (f64, &[f64], &Options) {
        (self.t_start, &self.times, &self.options)
    }

    /// The record of a member whose computation panicked.
    pub(crate) fn panicked(&self, member: u64, message: &str) -> Record {
        let (values, rows) = (self.design.values(member), vec![f64::NAN; self.width()]);
        Record { member, status: Status::Panicked, steps: 0, message: line(message), values, rows }
    }

    /// Numbers in a row: the columns of a motion, and the drifts if only the last row is wanted.
    fn width(&self) -> usize {
        self.columns + if self.all_rows { 0 } else { self.model.document().integrals.len() + 1 }
    }

    fn flow(&self, model: &Model) -> Result<Flow, ModelError> {
        if let Some(flow) = self.prototype.as_ref().and_then(|known| known.flow(model, self.t_start)) {
            return Ok(flow);
        }
        let graph = model.graph();
        Flow::new(model, &model.assemble(&graph)?, self.form.into())
    }

    /// All rows, or the last one with the drifts; the state `reached` by a failed motion is one
    /// more row.
    fn rows(&self, flow: &mut Flow, trajectory: &Trajectory, reached: Option<(f64, &[f64])>) -> Vec<f64> {
        let table = Table::new(flow, trajectory);
        let last = reached.map(|(t, y)| std::iter::once(t).chain(flow.row(t, y)).collect::<Vec<f64>>());
        if self.all_rows {
            return table.rows().flatten().copied().chain(last.into_iter().flatten()).collect();
        }
        let drifts: Vec<f64> = table.conserved().map(|j| drift(&table, last.as_deref(), j)).collect();
        let row = last.or_else(|| table.rows().next_back().map(<[f64]>::to_vec));
        row.unwrap_or_else(|| vec![f64::NAN; self.columns]).into_iter().chain(drifts).collect()
    }
}

/// max |I(t) − I(t_start)| of column `j`, including one more row.
fn drift(table: &Table, more: Option<&[f64]>, j: usize) -> f64 {
    let drift = table.drift(j).absolute;
    match (table.rows().next(), more) {
        (Some(first), Some(more)) => {
            let change = (more[j] - first[j]).abs();
            if change > drift || change.is_nan() { change } else { drift } // f64::max would lose a NaN
        }
        _ => drift,
    }
}

/// An error with its causes.
fn chain(error: &dyn Error) -> String {
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
fn line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

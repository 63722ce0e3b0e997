//! The motion of each member.

use std::ops::{ControlFlow, Range};
use std::sync::atomic::{AtomicU64, Ordering};

use pc_expr::{LaneField, VectorField};
use pc_model::document::NamedExpression;
use pc_model::{Flow, Model, ModelError, Prototype};
use pc_solve::{Ending, Ensemble, EnsembleError, Events, Options, Solution, Solve, Stop, Trajectory};

use super::design::Design;
use super::record::{Record, Status};
use super::shard::Shard;
use super::sheet::{Column, Kind};
use super::work::{Consume, Members, Work, chain, line};
use crate::args::forms::RunForm;
use crate::error::CliError;
use crate::motion::interrupt;
use crate::motion::memory;
use crate::motion::plan::Plan;
use crate::motion::table::Table;
use crate::report::text::short;

/// Integrates each member.
pub(crate) struct Motions {
    members: Members,
    form: RunForm,
    plan: Plan,
    times: Vec<f64>,
    options: Options,
    /// Whether all rows are wanted instead of the last, with the drifts.
    all_rows: bool,
    /// How many these are.
    rows: usize,
    prototype: Option<Prototype>,
    /// How many came to their end beside others.
    beside: AtomicU64,
}

/// A member before its motion: its equations with what is known of it, or its record; none if time was over.
type Begun = Result<Box<(Flow, Record)>, Option<Record>>;

impl Motions {
    /// `all_rows`: whether all rows of the plan are wanted instead of the last; so many members are at work at a time.
    ///
    /// # Errors
    /// [`CliError::Rows`] if the rows of these take more memory than they may.
    pub(crate) fn new(
        model: Model,
        design: Design,
        (plan, form): (Plan, RunForm),
        all_rows: bool,
        threads: usize,
    ) -> Result<Motions, CliError> {
        let columns = columns(&model, !all_rows);
        // Of each member at work its trajectory, its table, its record and the bytes of that.
        let numbers = (4 * self::columns(&model, false).len() * threads) as u64;
        memory::allow(plan.samples as u64, numbers, model.budget().limits())?;
        let prototype = Prototype::new(&model, form.into());
        Ok(Motions {
            members: Members::new(model, design, columns),
            form,
            times: plan.times(),
            options: plan.options(),
            all_rows,
            rows: if all_rows { plan.samples } else { 1 },
            plan,
            prototype,
            beside: AtomicU64::new(0),
        })
    }

    /// What is known of a member before its motion and, if it can be integrated beside others, its field and its start.
    fn begin(&self, member: u64) -> (Begun, Option<(LaneField, Vec<f64>)>) {
        let blank = self.members.blank(member);
        match self.flow(&self.members.model(&blank)) {
            Ok(mut flow) => {
                let free = flow.events.events().is_empty() && flow.motion.breaks().is_empty();
                let lane = if free { flow.motion.lanes() } else { None };
                let lane = lane.map(|field| (field, flow.start.clone()));
                (Ok(Box::new((flow, blank))), lane)
            }
            Err(error) => {
                (Err(self.members.ended(Status::Refused, &error.diagnostic().message, blank)), None)
            }
        }
    }

    /// The record of a member that came to its end beside others.
    fn completed(&self, begun: Begun, trajectory: &Trajectory) -> Option<Record> {
        let (mut flow, blank) = *begun.ok()?;
        self.beside.fetch_add(1, Ordering::Relaxed);
        Some(Record {
            status: Status::Completed,
            steps: trajectory.statistics().steps,
            rows: self.rows_of(&mut flow, trajectory, None),
            ..blank
        })
    }

    /// Integrates a member; none if it was stopped on its way, or time was over.
    fn integrate(&self, begun: Begun, stop: &Stop<'_>) -> Option<Record> {
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
        let solve = Solve::new(&mut flow.motion, self.plan.t_start, &flow.start).method(&self.options);
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
            rows: self.rows_of(&mut flow, &trajectory, reached),
            ..blank
        })
    }

    fn flow(&self, model: &Model) -> Result<Flow, ModelError> {
        if let Some(flow) = self.prototype.as_ref().and_then(|known| known.flow(model, self.plan.t_start)) {
            return Ok(flow);
        }
        let graph = model.graph();
        Flow::new(model, &model.assemble(&graph)?, self.form.into())
    }

    /// All rows, or the last one with the drifts; what was `reached` is one more.
    fn rows_of(&self, flow: &mut Flow, trajectory: &Trajectory, reached: Option<(f64, &[f64])>) -> Vec<f64> {
        let table = Table::new(flow, trajectory);
        let last = reached.map(|(t, y)| std::iter::once(t).chain(flow.row(t, y)).collect::<Vec<f64>>());
        if self.all_rows {
            return table.rows().flatten().copied().chain(last.into_iter().flatten()).collect();
        }
        let drifts: Vec<f64> = table.conserved().map(|j| drift(&table, last.as_deref(), j)).collect();
        let row = last.or_else(|| table.rows().next_back().map(<[f64]>::to_vec));
        let width = self.members.columns().len() - drifts.len();
        row.unwrap_or_else(|| vec![f64::NAN; width]).into_iter().chain(drifts).collect()
    }
}

impl Work for Motions {
    fn members(&self) -> &Members {
        &self.members
    }

    fn rows(&self) -> usize {
        self.rows
    }

    /// As far as that can be, side by side in vectors.
    fn records(
        &self,
        ensemble: &Ensemble<'_>,
        shard: Shard,
        places: Range<u64>,
        consume: Consume<'_>,
    ) -> Result<Ending, EnsembleError> {
        ensemble.map_in_lanes(
            places,
            (self.plan.t_start, &self.times, &self.options),
            |place| self.begin(shard.member(place)),
            |_, begun, trajectory| self.completed(begun, &trajectory),
            |_, begun, stop| self.integrate(begun, stop),
            consume,
        )
    }

    fn said(&self) -> Vec<(&'static str, String)> {
        let span = format!("{} to {}", short(self.plan.t_start, 10), short(self.plan.t_end, 10));
        vec![("method", self.plan.in_words()), ("time", span)]
    }

    fn done(&self) -> String {
        match self.beside.load(Ordering::Relaxed) {
            0 => String::new(),
            beside => format!(", {beside} side by side in vectors"),
        }
    }
}

/// The columns of a motion of a model: those of `pc run`, with the drifts of what should be constant if these are
/// wanted.
fn columns(model: &Model, drifts: bool) -> Vec<Column> {
    let document = model.document();
    let named = |list: &[NamedExpression]| list.iter().map(|item| item.name.text.clone()).collect::<Vec<_>>();
    let energy = || vec!["energy".to_owned()];
    let mut names = vec!["t".to_owned()];
    names.extend(model.start_names());
    names.extend([named(&document.integrals), energy(), named(&document.outputs)].concat());
    if drifts {
        let kept = [named(&document.integrals), energy()].concat();
        names.extend(kept.iter().map(|name| format!("drift({name})")));
    }
    names.into_iter().map(|name| Column::new(name, Kind::Number)).collect()
}

/// max |I(t) − I(t_start)| of column `j`, with one row more.
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

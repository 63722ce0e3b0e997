//! The motion of one member.

use std::error::Error;
use std::ops::ControlFlow;
use std::sync::{Mutex, PoisonError};

use pc_mech::VectorField;
use pc_model::{Flow, Model, ModelError};
use pc_solve::{Ending, Events, Options, Solution, Stop, Trajectory};

use super::design::Design;
use super::record::{Record, Status};
use crate::args::forms::RunForm;
use crate::motion::follow::follow;
use crate::motion::interrupt;
use crate::motion::plan::Plan;
use crate::motion::table::Table;

/// A start that a projection moves by no more than this, relative to the larger of 1 and its size, satisfies the
/// constraints up to the rounding of the numbers it is written with; a tenth of what a model is refused for.
const ON_CONSTRAINTS: f64 = 1e-9;

/// What all members have in common.
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
}

/// The equations compiled once, for members of which only numbers are different.
struct Prototype {
    flow: Mutex<Flow>,
    /// For each component of the state its place among the start values; none where it starts at 0.
    places: Vec<Option<usize>>,
    /// Start values that are no components of the state, because constraints say that they vanish.
    vanishing: Vec<usize>,
}

impl Prototype {
    /// None where the equations may depend on the start or on the values of the parameters: momenta solved for
    /// velocities near the start, constraints left out because they follow from others; or where the start has to be solved for.
    fn new(model: &Model, form: RunForm) -> Option<Prototype> {
        if form != RunForm::Poincare || model.derives_start() {
            return None;
        }
        let graph = model.graph();
        let assembly = model.assemble(&graph).ok()?;
        if !assembly.constraints.redundant().is_empty() {
            return None;
        }
        let flow = Flow::new(model, &assembly, form.into()).ok()?;
        let names = model.start_names();
        let state = flow.motion.names();
        let places = state.iter().map(|x| names.iter().position(|name| name == x)).collect();
        let vanishing = (0..names.len()).filter(|&i| !state.contains(&names[i])).collect();
        Some(Prototype { flow: Mutex::new(flow), places, vanishing })
    }

    /// The equations with the values of a model, at its start; none if something about it has to be looked at closer.
    fn flow(&self, model: &Model, t: f64) -> Option<Flow> {
        let values = model.start().ok()?;
        let start: Vec<f64> =
            self.places.iter().map(|place| place.map_or(0.0, |place| values[place])).collect();
        let parameters: Vec<f64> = model.parameters().map(|(_, value)| value).collect();
        let prototype = self.flow.lock().unwrap_or_else(PoisonError::into_inner);
        let mut flow = prototype.with_values(&parameters, start);
        drop(prototype);
        let start = flow.start.clone();
        flow.motion.keep_from(t, &start).ok()?;
        let mut nearest = flow.start.clone();
        flow.motion.project(t, &mut nearest).ok()?;
        let near = |(a, b): (&f64, &f64)| (a - b).abs() <= ON_CONSTRAINTS * a.abs().max(1.0);
        let on = self.vanishing.iter().all(|&place| values[place] == 0.0)
            && flow.start.iter().zip(&nearest).all(near);
        let mut rate = vec![0.0; nearest.len()];
        flow.motion.rhs(t, &start, &mut rate).ok()?;
        let finite = flow.row(t, &start).iter().chain(&rate).all(|value| value.is_finite());
        (on && finite).then_some(flow)
    }
}

impl Members {
    /// `rows`: whether all rows of the plan are wanted instead of the last.
    pub(crate) fn new(
        model: Model,
        design: Design,
        form: RunForm,
        plan: &Plan,
        rows: bool,
        columns: usize,
    ) -> Self {
        let (t_start, times, options) = (plan.t_start, plan.times(), plan.options());
        let projected = model.projects_start();
        let prototype = if projected { None } else { Prototype::new(&model, form) };
        Members { model, design, form, t_start, times, options, all_rows: rows, columns, prototype }
    }

    /// Integrates a member; none if it was stopped on its way, or time was over.
    pub(crate) fn integrate(&self, member: u64, stop: &Stop<'_>) -> Option<Record> {
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
        // Memory is each member's own, time that of all.
        model.within(self.model.budget().beside());
        let mut flow = match self.flow(&model) {
            Ok(flow) => flow,
            Err(_) if model.budget().deadline().passed().is_some() => return None,
            Err(error) => return Some(Record { message: line(&error.diagnostic().message), ..blank }),
        };
        let observer = |_, _: &[f64]| {
            if stop.requested() || interrupt::requested() {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        let (motion, error) = follow(&mut flow, self.t_start, &self.times, &self.options, observer);
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

    /// What is kept of a member whose computation panicked.
    pub(crate) fn panicked(&self, member: u64, message: &str) -> Record {
        let (values, rows) = (self.design.values(member), vec![f64::NAN; self.width()]);
        Record { member, status: Status::Panicked, steps: 0, message: line(message), values, rows }
    }

    /// Numbers in a row: the columns of a motion, and the drifts beside the last one.
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

    /// All rows, or the last one with the drifts; what was `reached` is one more.
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

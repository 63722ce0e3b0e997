//! Integrates the motion of each member.

use std::ops::{ControlFlow, Range};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

use pc_expr::{LaneField, VectorField};
use pc_model::document::NamedExpression;
use pc_model::{Flow, MemberValues, Model, ModelError, Prototype, Variables};
use pc_solve::{Ending, Ensemble, EnsembleError, Events, Options, Solution, Solve, Stop, Trajectory};

use super::design::Design;
use super::members::Members;
use super::record::{Record, Status};
use super::shard::Shard;
use super::work::{Consume, Work};
use crate::chain::{chain, line};
use crate::error::RunError;
use crate::motion::derived::Derived;
use crate::motion::table::{Table, raised};
use crate::motion::verification::Verification;
use crate::plan::Plan;
use crate::plan::memory;
use crate::plan::tolerances::Tolerances;
use crate::table::rows::{CellKind, Column};
use pc_print::short;

/// Integrates each member.
pub(crate) struct Motions {
    members: Members,
    plan: Plan,
    times: Vec<f64>,
    /// The tolerances, which depend on the scale of the model itself, so that all members in one vector share
    /// them.
    tolerances: Tolerances,
    options: Options,
    /// Whether all rows are recorded, instead of only the last one with the drifts.
    all_rows: bool,
    /// The number of rows that are recorded.
    rows: usize,
    prototype: Option<Arc<Prototype>>,
    /// Which numbers of a row should stay constant.
    conserved: Range<usize>,
    /// How many members were completed side by side with others.
    beside: AtomicU64,
}

/// A member before its motion, with what is known about it.
enum Begun {
    /// Its values alone, while it is integrated side by side with others.
    Beside(Box<(MemberValues, Record)>),
    /// Its equations.
    Alone(Box<(Flow, Record)>),
    /// Its record, which is none if the time limit had passed.
    Ended(Option<Record>),
}

impl Motions {
    /// The work of integrating the members. `all_rows` says whether all rows of the plan are recorded instead
    /// of the last one; `threads` is the number of members in progress at a time. The equations of the model
    /// are derived unless they are given as `derived`.
    ///
    /// # Errors
    /// [`RunError::Rows`] if the rows of the members in progress take more memory than they may.
    pub(crate) fn new(
        model: Model,
        design: Design,
        plan: Plan,
        all_rows: bool,
        threads: usize,
        derived: Option<&Derived>,
    ) -> Result<Motions, RunError> {
        let Begin { table, tolerances, prototype } = match derived {
            Some(derived) => Begin::of(derived, &plan),
            None => begun(&model, &design, &plan),
        };
        let shown = table.as_ref().map_or_else(|| written(&model), Columns::of);
        // Of each member at work its trajectory, its table, its record and the bytes of that.
        let numbers = (4 * shown.names.len() * threads) as u64;
        memory::allow(plan.samples as u64, numbers, model.budget().limits())?;
        let columns = shown.in_rows(!all_rows);
        Ok(Motions {
            members: Members::new(model, design, columns),
            times: if all_rows { plan.times() } else { sparse(&plan) },
            options: plan.options(&tolerances),
            tolerances,
            all_rows,
            conserved: shown.conserved,
            rows: if all_rows { plan.samples } else { 1 },
            plan,
            prototype,
            beside: AtomicU64::new(0),
        })
    }

    /// What is known about a member before its motion and, if it can be integrated side by side with others, its field
    /// and its start.
    fn begin(&self, member: u64) -> (Begun, Option<(LaneField, Vec<f64>)>) {
        let blank = self.members.blank(member);
        let model = self.members.model(&blank);
        if let Some((field, values)) =
            self.prototype.as_ref().and_then(|known| known.lane(&model, self.plan.t_start))
        {
            let start = values.start.clone();
            return (Begun::Beside(Box::new((values, blank))), Some((field, start)));
        }
        match self.alone(&model, blank) {
            Begun::Alone(mut begun) => {
                let flow = &mut begun.0;
                let free = flow.events.events().is_empty() && flow.motion.breaks().is_empty();
                let lane = if free { flow.motion.lanes() } else { None };
                let lane = lane.map(|field| (field, flow.start.clone()));
                (Begun::Alone(begun), lane)
            }
            ended => (ended, None),
        }
    }

    /// A member with its own equations.
    fn alone(&self, model: &Model, blank: Record) -> Begun {
        match self.flow(model) {
            Ok(flow) => Begun::Alone(Box::new((flow, blank))),
            Err(error) => Begun::Ended(self.members.ended(Status::Refused, &error, blank)),
        }
    }

    /// The record of a member that was completed side by side with others.
    fn completed(&self, begun: Begun, trajectory: &Trajectory) -> Option<Record> {
        let rows_of = |flow: &mut Flow| self.rows_of(flow, trajectory, None);
        let (rows, blank) = match begun {
            Begun::Beside(begun) => (self.prototype.as_ref()?.with(&begun.0, rows_of), begun.1),
            Begun::Alone(mut begun) => (rows_of(&mut begun.0), begun.1),
            Begun::Ended(record) => return record,
        };
        self.beside.fetch_add(1, Ordering::Relaxed);
        Some(Record { status: Status::Completed, steps: trajectory.statistics().steps, rows, ..blank })
    }

    /// Integrates a member and returns its record; none if it was stopped before the end, or the time limit
    /// had passed.
    fn integrate(&self, begun: Begun, stop: &Stop<'_>) -> Option<Record> {
        let begun = match begun {
            Begun::Beside(begun) => self.alone(&self.members.model(&begun.1), begun.1),
            other => other,
        };
        let (mut flow, blank) = match begun {
            Begun::Alone(begun) => *begun,
            Begun::Ended(record) => return record,
            Begun::Beside(_) => unreachable!("has its own equations now"),
        };
        let observer = |_, _: &[f64]| {
            if stop.requested() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
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

    /// The equations of motion of a member, or its error.
    fn flow(&self, model: &Model) -> Result<Flow, String> {
        if let Some(flow) = self.prototype.as_ref().and_then(|known| known.flow(model, self.plan.t_start)) {
            return Ok(flow);
        }
        let flow = derived(model, self.plan.form).map_err(|error| error.diagnostic().message.clone())?;
        let own = Columns::of(&Table::of(&flow));
        let is_alike = own.in_rows(!self.all_rows) == self.members.columns();
        let other = || format!("its table has other columns than the sweep: {}", own.names.join(", "));
        is_alike.then_some(flow).ok_or_else(other)
    }

    /// All rows, or only the last one with the drifts; the end that was `reached`, if given, is a further
    /// row. There is always at least one row.
    fn rows_of(&self, flow: &mut Flow, trajectory: &Trajectory, reached: Option<(f64, &[f64])>) -> Vec<f64> {
        let mut rows =
            trajectory.iter().chain(reached).map(|(t, y)| (t, flow.row(t, y))).map(|(t, mut row)| {
                row.insert(0, t);
                row
            });
        let Some(first) = rows.next() else { return vec![f64::NAN; self.members.columns().len()] };
        if self.all_rows {
            return rows.fold(first, |mut all, row| {
                all.extend(row);
                all
            });
        }
        let mut drifts = vec![0.0; self.conserved.len()];
        let mut last = first.clone();
        for row in rows {
            for (drift, j) in drifts.iter_mut().zip(self.conserved.clone()) {
                *drift = raised(*drift, row[j] - first[j]);
            }
            last = row;
        }
        [last, drifts].concat()
    }
}

impl Work for Motions {
    fn members(&self) -> &Members {
        &self.members
    }

    fn rows(&self) -> usize {
        self.rows
    }

    /// The equations compared are those with which the members are integrated: their own, or those shared by
    /// all.
    fn vouched(&self) -> Result<(), RunError> {
        for model in self.members.samples() {
            let graph = model.graph();
            // A member that is refused says so in its record.
            let (Ok(assembly), Ok(flow)) = (model.assemble(&graph), self.flow(&model)) else { continue };
            let mut verification = Verification::new(&model, &assembly, self.plan.form);
            verification.compare(&flow, &assembly, "the start", self.plan.t_start, &flow.start)?;
        }
        Ok(())
    }

    /// The members are integrated side by side in vectors, as far as possible.
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
        vec![("method", self.plan.in_words(&self.tolerances)), ("time", span)]
    }

    fn done(&self) -> String {
        match self.beside.load(Ordering::Relaxed) {
            0 => String::new(),
            beside => format!(", {beside} side by side in vectors"),
        }
    }
}

/// The times at which a member is looked at of which only the last row is kept, for the drifts.
fn sparse(plan: &Plan) -> Vec<f64> {
    match plan.at {
        Some(_) => plan.times(),
        None => Plan { samples: plan.samples.min(LOOKS), ..plan.clone() }.times(),
    }
}

/// How often, start and end included: a row costs as much as some steps of a small system.
const LOOKS: usize = 5;

/// The columns of a motion, and which of them should stay constant.
struct Columns {
    names: Vec<String>,
    conserved: Range<usize>,
}

impl Columns {
    /// The columns of the table from which the rows come.
    fn of(table: &Table) -> Columns {
        Columns { names: table.columns().to_vec(), conserved: table.conserved() }
    }

    /// The columns of a member, followed by the drifts of those that should stay constant, if requested.
    fn in_rows(&self, drifts: bool) -> Vec<Column> {
        let kept = if drifts { &self.names[self.conserved.clone()] } else { &[] };
        let drifts = kept.iter().map(|name| format!("drift({name})"));
        self.names.iter().cloned().chain(drifts).map(|name| Column::new(name, CellKind::Number)).collect()
    }
}

/// The columns of `pc run`, as far as they are known from the text, for a sweep none of whose members can
/// begin.
fn written(model: &Model) -> Columns {
    let document = model.document();
    let named = |list: &[NamedExpression]| list.iter().map(|item| item.name.text.clone()).collect::<Vec<_>>();
    let state = [vec!["t".to_owned()], model.start_names()].concat();
    let kept = [named(&document.integrals), vec!["energy".to_owned()]].concat();
    let conserved = state.len()..state.len() + kept.len();
    Columns { names: [state, kept, named(&document.outputs)].concat(), conserved }
}

/// What is known before the first member begins.
#[derive(Default)]
struct Begin {
    /// The table without its rows; none if no member has a motion.
    table: Option<Table>,
    tolerances: Tolerances,
    /// The equations, if the members differ from the model only in numbers.
    prototype: Option<Arc<Prototype>>,
}

impl Begin {
    fn of(derived: &Derived, plan: &Plan) -> Begin {
        let mut flow = derived.flow.clone();
        let (table, tolerances) = (Some(Table::of(&flow)), plan.tolerances(&mut flow));
        Begin { table, tolerances, prototype: derived.prototype.clone() }
    }
}

/// What is known from the model itself or, if it has no motion, from the first member that has one. The
/// result is the same for each shard.
fn begun(model: &Model, design: &Design, plan: &Plan) -> Begin {
    if let Ok(derived) = model.derived(|assembly| Derived::of(model, assembly, plan.form)) {
        return Begin::of(&derived, plan);
    }
    let in_time = |_: &u64| model.budget().deadline().passed().is_none();
    let first = (0..design.members()).take_while(in_time).find_map(|member| {
        let mut model = design.model(model, &design.values(member));
        model.within(model.budget().beside());
        let mut flow = derived(&model, plan.form).ok()?;
        Some(Begin { table: Some(Table::of(&flow)), tolerances: plan.tolerances(&mut flow), prototype: None })
    });
    first.unwrap_or_default()
}

/// The flow of a model, derived anew.
fn derived(model: &Model, variables: Variables) -> Result<Flow, ModelError> {
    let graph = model.graph();
    Flow::new(model, &model.assemble(&graph)?, variables)
}

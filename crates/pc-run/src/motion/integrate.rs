//! Integrates the motion of a model according to a plan.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use pc_model::{Assembly, Flow, Model, Variables};
use pc_solve::{self as solver, Events, Options, Solution, Solve, SolveError, Trajectory};

use crate::error::RunError;
use crate::files::stream::Stream;
use crate::motion::accuracy::Accuracy;
use crate::motion::cache::{Cache, Kept};
use crate::motion::checkpoints::{CheckpointFiles, Checkpoints};
use crate::motion::derived::{Derived, Facts};
use crate::motion::estimate::{self, Estimate, column_of_errors};
use crate::motion::fine;
use crate::motion::lost::LostIntegral;
use crate::motion::lost_inertia::lost_inertia;
use crate::motion::lost_integral;
use crate::motion::remarks;
use crate::motion::run::{Ending, Run};
use crate::motion::sensitivities::Derivatives;
use crate::motion::step_states::StepStates;
use crate::motion::streamed::{Streamed, note_residuals};
use crate::motion::table::Table;
use crate::motion::verification::Verification;
use crate::observer::Observer;
use crate::plan::Plan;
use crate::plan::Wishes;
use crate::plan::memory;
use crate::plan::tolerances::{Tolerances, note_largest};
use crate::table::chosen::chosen;

/// What a run contains in addition to its rows; nothing by default.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Besides {
    /// Whether the equations are compared with a second derivation, at the start and, where this is
    /// fast, at the end.
    pub verify: bool,
    /// Whether the run contains the motion between its rows too, with as many points as smooth curves need.
    pub fine: bool,
    /// Whether the observer is given remarks on the equations.
    pub remarks: bool,
    /// The columns that are written besides t, in this order; all if there are none.
    pub columns: Vec<String>,
    /// Whether the table contains the errors of its columns.
    pub estimate: bool,
    /// Whether the run contains what is known of the accuracy of its rows.
    pub accuracy: bool,
    /// Checkpoints.
    pub checkpoints: CheckpointFiles,
    /// Where equations are kept for the next run, if anywhere. What is found there was compared with a second
    /// derivation before it was kept, and is not compared again.
    pub cache: Option<Cache>,
}

impl Besides {
    /// The parts needed for a motion that is to be shown: it is verified, and has enough points for smooth
    /// curves.
    pub fn shown() -> Besides {
        Besides { verify: true, fine: true, remarks: true, ..Besides::default() }
    }

    /// Whether the motion has a companion.
    fn has_companion(&self) -> bool {
        self.estimate || self.accuracy
    }

    /// How many more rows are held for each row of a motion with a companion: a longer row beside the one before; those of
    /// the companion and of rounded states.
    fn rows_again(&self) -> u64 {
        2 * u64::from(self.estimate) + 3 * u64::from(self.accuracy)
    }
}

impl Run {
    /// Derives, compiles and integrates the motion of a model. The table shows quasi-velocities, whatever the
    /// form of the equations. If there are too many rows for memory, they go to the `stream` as they are
    /// computed.
    ///
    /// # Errors
    /// [`RunError`] if there is no motion at all, or the second derivation disagrees; an incomplete motion is
    /// not an error.
    pub fn of(
        model: &Model,
        wishes: &Wishes,
        besides: &Besides,
        stream: Option<&mut Stream<'_>>,
        observer: &dyn Observer,
    ) -> Result<Run, RunError> {
        let form = Plan::form(model, wishes);
        // Derivatives with respect to parameters need more than the equations of motion.
        let cache = besides.cache.as_ref().filter(|_| wishes.sensitivities.is_empty());
        if let Some(Kept { derived: Derived { flow, facts, .. }, remarks, verified }) =
            cache.and_then(|cache| cache.find(model, form, observer))
        {
            if besides.remarks {
                remarks.iter().for_each(|remark| observer.remark(remark));
            }
            let plan = Plan::of(model, wishes)?;
            let run =
                Integration { model, assembly: None, facts, flow, plan, besides, observer }.run(stream)?;
            return Ok(Run { verified_before: verified, ..run });
        }
        let graph = model.graph();
        Run::of_assembly(model, &model.assemble(&graph)?, wishes, besides, stream, observer)
    }

    /// As [`of`](Run::of), for a model that has been assembled.
    ///
    /// # Errors
    /// As for [`of`](Run::of).
    pub fn of_assembly(
        model: &Model,
        assembly: &Assembly<'_>,
        wishes: &Wishes,
        besides: &Besides,
        stream: Option<&mut Stream<'_>>,
        observer: &dyn Observer,
    ) -> Result<Run, RunError> {
        let plan = || Plan::of(model, wishes);
        integrated((model, assembly), Plan::form(model, wishes), plan, besides, stream, observer)
    }

    /// As [`of`](Run::of), following a plan.
    ///
    /// # Errors
    /// As for [`of`](Run::of).
    pub fn planned(
        model: &Model,
        plan: Plan,
        besides: &Besides,
        observer: &dyn Observer,
    ) -> Result<Run, RunError> {
        let graph = model.graph();
        integrated((model, &model.assemble(&graph)?), plan.form, || Ok(plan), besides, None, observer)
    }

    /// As [`of`](Run::of), but for equations that have been derived before, with the values of the model. The equations
    /// are derived again only if they are to be verified, or if a lost integral or lost inertia has to be explained.
    ///
    /// # Errors
    /// As for [`of`](Run::of).
    pub fn of_derived(
        model: &Model,
        derived: &Derived,
        plan: Plan,
        besides: &Besides,
        observer: &dyn Observer,
    ) -> Result<Run, RunError> {
        let (flow, facts) = (derived.flow.clone(), derived.facts.clone());
        let graph = besides.verify.then(|| model.graph());
        let assembly = graph.as_ref().map(|graph| model.assemble(graph)).transpose()?;
        Integration { model, assembly: assembly.as_ref(), facts, flow, plan, besides, observer }.run(None)
    }
}

/// The plan is made only once the model is known to be valid.
fn integrated(
    (model, assembly): (&Model, &Assembly<'_>),
    form: Variables,
    plan: impl FnOnce() -> Result<Plan, RunError>,
    besides: &Besides,
    stream: Option<&mut Stream<'_>>,
    observer: &dyn Observer,
) -> Result<Run, RunError> {
    let cache = besides.cache.as_ref().filter(|_| besides.verify);
    let is_told = besides.remarks || cache.is_some();
    let remarks = if is_told { remarks::of(assembly)? } else { Vec::new() };
    if besides.remarks {
        remarks.iter().for_each(|remark| observer.remark(remark));
    }
    let flow = Flow::new(model, assembly, form)?;
    let plan = plan()?;
    let facts = Facts::of(assembly);
    let kept = cache
        .filter(|_| plan.sensitivities.is_empty())
        .map(|cache| (cache, Derived { flow: flow.clone(), prototype: None, facts: facts.clone() }));
    let run =
        Integration { model, assembly: Some(assembly), facts, flow, plan, besides, observer }.run(stream)?;
    if let (Some((cache, derived)), Some(verification)) = (kept, &run.verification)
        && verification.agrees()
    {
        let verified = verification.lines();
        cache.keep(model, form, &Kept { derived, remarks, verified }, observer);
    }
    Ok(run)
}

/// A motion to be integrated.
struct Integration<'r, 'g> {
    model: &'r Model,
    /// None if the model has not been assembled for this run.
    assembly: Option<&'r Assembly<'g>>,
    facts: Facts,
    flow: Flow,
    plan: Plan,
    besides: &'r Besides,
    observer: &'r dyn Observer,
}

/// A motion, as far as it was integrated.
struct Solved {
    solution: Solution,
    error: Option<SolveError>,
    steps: StepStates,
    wall: Duration,
}

impl Integration<'_, '_> {
    fn run(mut self, stream: Option<&mut Stream<'_>>) -> Result<Run, RunError> {
        let tolerances = self.plan.tolerances(&mut self.flow);
        let options = self.plan.options(&tolerances);
        let stream = self.within_memory(stream)?;
        let mut checkpoints = Checkpoints::new(&self.besides.checkpoints, self.model, &self.plan)?;
        let mut derivatives = match self.plan.sensitivities.as_slice() {
            [] => None,
            by => {
                let derivatives =
                    |assembly: &Assembly<'_>| Derivatives::new(self.model, assembly, &self.flow, by);
                Some(self.assembled(derivatives)??)
            }
        };
        let written = self.written(derivatives.as_ref())?;
        let verified = self.assembly.filter(|_| self.besides.verify);
        let mut verification = match verified {
            Some(assembly) => {
                let Integration { model, flow, plan, .. } = &self;
                let mut verification = Verification::new(model, assembly, plan.form);
                verification.compare(flow, assembly, "the start", plan.t_start, &flow.start)?;
                Some((verification, assembly))
            }
            None => None,
        };
        // Derivatives are known at the rows alone, and a resumed motion is not integrated from its
        // start again.
        let mut again = (self.besides.fine && self.is_plain()).then(|| self.flow.clone());
        let mut beside = self.besides.has_companion().then(|| self.flow.clone());
        let observer = self.observer;
        let mut streamed =
            stream.map(|stream| Streamed::new(&self.flow, (stream, &written), observer)).transpose()?;

        let solved = self.solve(&options, (&mut checkpoints, &mut derivatives, &mut streamed))?;

        let Integration { flow, plan, besides, .. } = &mut self;
        let companion = beside
            .as_mut()
            .map(|flow| estimate::companion(flow, (plan, &options), &solved.solution, observer));
        let trajectory = &solved.solution.trajectory;
        let statistics = *trajectory.statistics();
        let last = match &streamed {
            Some(streamed) => streamed.last.clone(),
            None => trajectory.last().map(|(t, y)| (t, y.to_vec())),
        };
        let is_full = streamed.as_ref().is_some_and(Streamed::has_failed);
        let (mut table, constraints, mut largest) = match streamed {
            Some(streamed) => (streamed.table, streamed.constraints, streamed.largest),
            None => {
                let table = Table::with_derivatives(flow, trajectory, derivatives.as_ref());
                (table, residuals(flow, trajectory), Vec::new())
            }
        };
        trajectory.iter().for_each(|(_, y)| note_largest(&mut largest, y));
        let of = (&solved.solution, &tolerances);
        let accuracy = companion
            .as_ref()
            .filter(|_| besides.accuracy)
            .map(|companion| Accuracy::of(companion, flow, of));
        let estimate = companion
            .filter(|_| besides.estimate)
            .map(|companion| Estimate::of(&companion, flow, of, &mut table));
        let fine = again.as_mut().and_then(|flow| {
            fine::table(flow, (plan, &options), statistics.steps, statistics.current_time, observer)
        });
        let is_cut = again.is_some() && observer.is_stopped();
        if let Some((verification, assembly)) = &mut verification {
            self.verify(verification, assembly, &solved.solution, last.as_ref(), derivatives.as_ref())?;
        }
        let passed_at_start = self.passed_at_start(&solved.steps);
        let ending = match self.ending(solved.solution.ending, solved.error, is_full) {
            // The curves between the rows of a whole motion were cut.
            Ending::Completed | Ending::Event { .. } if is_cut => Ending::Interrupted,
            ending => ending,
        };
        let lost = self.lost(&ending, &table, &tolerances, &solved.steps, last.as_ref())?;
        let lost_inertia = self.lost_inertia(&ending)?;
        let Integration { model, facts, flow, plan, .. } = self;
        let Solution { trajectory, occurrences, slides, .. } = solved.solution;
        Ok(Run {
            title: model.title().to_owned(),
            units: units(model),
            parameters: model.parameters().map(|(name, value)| (name.to_owned(), value)).collect(),
            state: flow.motion.names().to_vec(),
            never_exceeded: tolerances.never_exceeded(&written_start(model), &largest),
            tolerances,
            table,
            written,
            trajectory,
            estimate,
            accuracy,
            constraints,
            dropped: facts.dropped,
            jumps: facts.jumps,
            keeps_energy: facts.keeps_energy,
            lost,
            lost_inertia,
            fine,
            statistics,
            plan,
            events: names_of_events(&flow),
            passed_at_start,
            occurrences,
            slides,
            ending,
            verification: verification.map(|(verification, _)| verification),
            verified_before: Vec::new(),
            wall: solved.wall,
        })
    }

    /// Runs `work` on the assembled model, which is assembled first if necessary.
    fn assembled<T>(&self, work: impl FnOnce(&Assembly<'_>) -> T) -> Result<T, RunError> {
        match self.assembly {
            Some(assembly) => Ok(work(assembly)),
            None => {
                let graph = self.model.graph();
                Ok(work(&self.model.assemble(&graph)?))
            }
        }
    }

    /// The numbers of the columns that are written, as they will be; a drift is drawn alone.
    fn written(&self, derivatives: Option<&Derivatives>) -> Result<Vec<usize>, RunError> {
        let Integration { flow, besides, .. } = self;
        let mut names = Table::of(flow).columns().to_vec();
        let errors: Vec<String> = if besides.estimate {
            names[1..].iter().map(|name| column_of_errors(name)).collect()
        } else {
            Vec::new()
        };
        names.extend(derivatives.map_or_else(Vec::new, |derivatives| derivatives.columns(flow)));
        names.extend(errors);
        let is_drawn =
            |name: &str| besides.fine && name.starts_with("drift(") && !names.iter().any(|n| n == name);
        let wanted = besides.columns.iter().filter(|name| !is_drawn(name.trim())).cloned();
        Ok(chosen(&names, |j| j == 0, &wanted.collect::<Vec<_>>())?)
    }

    /// Whether the motion is integrated without derivatives and checkpoints.
    fn is_plain(&self) -> bool {
        self.besides.checkpoints.path().is_none() && self.plan.sensitivities.is_empty()
    }

    /// The stream, if the rows are to go to it; an error if they would take too much memory.
    fn within_memory<'s, 'p>(
        &self,
        stream: Option<&'s mut Stream<'p>>,
    ) -> Result<Option<&'s mut Stream<'p>>, RunError> {
        let Integration { model, flow, plan, besides, .. } = self;
        let numbers = memory::numbers(flow, plan, besides.checkpoints.path().is_some(), besides.rows_again());
        let (rows, limits) = (plan.samples as u64, model.budget().limits());
        let is_streamed =
            self.is_plain() && !besides.has_companion() && memory::is_much(rows, numbers, limits);
        let stream = stream.filter(|_| is_streamed);
        // Of rows that are written at once, only the times are held.
        memory::allow(rows, if stream.is_some() { 1 } else { numbers }, limits)?;
        Ok(stream)
    }

    fn solve(
        &mut self,
        options: &Options,
        (checkpoints, derivatives, streamed): (
            &mut Option<Checkpoints>,
            &mut Option<Derivatives>,
            &mut Option<Streamed<'_, '_>>,
        ),
    ) -> Result<Solved, RunError> {
        let Integration { flow, plan, observer, .. } = self;
        let mut progress = observer.motion((plan.t_start, plan.t_end));
        let mut steps = StepStates::new();
        let step = |t: f64, y: &[f64]| {
            progress(t);
            steps.note(t, y);
            if observer.is_stopped() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        };
        let start = Instant::now();
        let (solution, error) = match (checkpoints, derivatives, streamed) {
            (Some(checkpoints), derivatives, _) => {
                checkpoints.solve(flow, (plan, options), derivatives.as_mut(), step, *observer)?
            }
            (None, None, Some(streamed)) => streamed.follow(flow, (plan, options), step),
            (None, Some(derivatives), _) => {
                derivatives.follow(flow, plan.t_start, &plan.times(), options, step)
            }
            (None, None, None) => Solve::new(&mut flow.motion, plan.t_start, &flow.start)
                .method(options)
                .events(&mut flow.events)
                .follow(&plan.times(), step),
        };
        Ok(Solved { solution, error, wall: start.elapsed(), steps })
    }

    /// Compares the end of the motion, the derivatives there, and the states after resets with the second
    /// derivation.
    fn verify(
        &self,
        verification: &mut Verification,
        assembly: &Assembly<'_>,
        solution: &Solution,
        last: Option<&(f64, Vec<f64>)>,
        derivatives: Option<&Derivatives>,
    ) -> Result<(), RunError> {
        let Integration { model, flow, plan, .. } = self;
        if let Some((t, y)) = last
            && *t != plan.t_start
            && !verification.is_long(flow)
        {
            verification.compare(flow, assembly, "the end", *t, y)?;
            if let Some(derivatives) = derivatives {
                let slopes = derivatives.slopes(&mut flow.clone(), *t, y);
                verification.compare_derivatives(model, assembly, flow, (*t, y), &slopes)?;
            }
        }
        verification.compare_resets(model, assembly, flow, &solution.occurrences)
    }

    /// The events whose functions are zero at the start and then move in the direction of the event, which
    /// does not count as an occurrence. The direction is judged at the end of the first step, or of the part
    /// of it before an event. The list is empty for a motion that was resumed.
    fn passed_at_start(&mut self, steps: &StepStates) -> Vec<usize> {
        let Integration { flow, plan, besides, .. } = self;
        let Some((t, y)) = steps.iter().next().filter(|_| besides.checkpoints.resume.is_none()) else {
            return Vec::new();
        };
        let count = flow.events.events().len();
        let (mut before, mut after) = (vec![f64::NAN; count], vec![f64::NAN; count]);
        let start = flow.start.clone();
        let evaluated = flow.events.evaluate(plan.t_start, &start, &mut before).is_ok()
            && flow.events.evaluate(t, y, &mut after).is_ok();
        let goes = |&i: &usize| before[i] == 0.0 && flow.events.events()[i].crosses().leaves(-after[i]);
        if evaluated { (0..count).filter(goes).collect() } else { Vec::new() }
    }

    fn ending(&self, ending: Option<solver::Ending>, error: Option<SolveError>, is_full: bool) -> Ending {
        match (ending, error) {
            (_, Some(error)) => error.ended().map_or_else(|| Ending::Failed(Box::new(error)), Ending::Ended),
            (Some(solver::Ending::Completed), None) => Ending::Completed,
            (Some(solver::Ending::Event { event }), None) => {
                Ending::Event { name: self.flow.events.events()[event].name().to_owned() }
            }
            (Some(solver::Ending::Stopped) | None, None) if is_full => Ending::Unwritten,
            (Some(solver::Ending::Stopped) | None, None) => Ending::Interrupted,
        }
    }

    /// An integral that a completed motion has lost, if any; a reset may change integrals.
    fn lost(
        &mut self,
        ending: &Ending,
        table: &Table,
        tolerances: &Tolerances,
        steps: &StepStates,
        last: Option<&(f64, Vec<f64>)>,
    ) -> Result<Option<LostIntegral>, RunError> {
        let is_whole = matches!(ending, Ending::Completed | Ending::Event { .. });
        if !is_whole || self.facts.has_resets {
            return Ok(None);
        }
        let states: Vec<(f64, &[f64])> = steps.iter().chain(last.map(|(t, y)| (*t, y.as_slice()))).collect();
        let accuracy = (tolerances, self.plan.rtol);
        let keeps_energy = self.facts.keeps_energy;
        let suspects = lost_integral::suspects(table, keeps_energy, &mut self.flow, accuracy, &states);
        if suspects.is_empty() {
            return Ok(None);
        }
        let energy = &table.columns()[table.conserved().end - 1];
        let mut flow = self.flow.clone();
        self.assembled(|assembly| lost_integral::lost(suspects, energy, assembly, &mut flow, &states))
    }

    fn lost_inertia(&self, ending: &Ending) -> Result<Option<(String, f64)>, RunError> {
        let Ending::Failed(error) = ending else { return Ok(None) };
        let Some(reached) = error.reached() else { return Ok(None) };
        let (mut flow, t_start) = (self.flow.clone(), self.plan.t_start);
        self.assembled(|assembly| lost_inertia(assembly, &mut flow, t_start, reached))
    }
}

/// The units that the text of a model names, each after its quantity.
pub(crate) fn units(model: &Model) -> Vec<(String, String)> {
    let given = model.document().units.iter();
    given.map(|given| (given.quantity.text.clone(), given.unit.value.clone())).collect()
}

fn names_of_events(flow: &Flow) -> Vec<String> {
    flow.events.events().iter().map(|event| event.name().to_owned()).collect()
}

/// The start values given by the text or the options.
fn written_start(model: &Model) -> Vec<(String, f64)> {
    model.start().map(|values| model.start_names().into_iter().zip(values).collect()).unwrap_or_default()
}

fn residuals(flow: &mut Flow, trajectory: &Trajectory) -> Vec<(String, f64)> {
    let mut worst: Vec<(String, f64)> = flow.constraint_names().into_iter().map(|name| (name, 0.0)).collect();
    for (t, y) in trajectory.iter() {
        note_residuals(&mut worst, flow, t, y);
    }
    worst
}

//! `pc run`: integrate, write, sum up.

use std::ops::ControlFlow;
use std::time::Instant;

use pc_mech::Expr;
use pc_model::{Assembly, Flow, Model, Variables};
use pc_print::energy_remark;
use pc_report::dropped;
use pc_report::picture::{Drawing, Picture, Wanted};
use pc_solve::{self as solver, Events, Occurrence, Solution, Solve, Trajectory};
use pc_verify::Jump;

use crate::args::checkpoint::CheckpointArguments;
use crate::args::input;
use crate::args::options::{Outputs, RunArguments};
use crate::error::CliError;
use crate::motion::checkpoint::Checkpoints;
use crate::motion::estimate::{self, Estimate};
use crate::motion::fine;
use crate::motion::given::{Given, note_residuals};
use crate::motion::interrupt;
use crate::motion::lost_inertia::lost_inertia;
use crate::motion::lost_integral::lost_integral;
use crate::motion::memory;
use crate::motion::plan::Plan;
use crate::motion::progress::Progress;
use crate::motion::run::{Ending, Run};
use crate::motion::sensitivities::Derivatives;
use crate::motion::step_states::StepStates;
use crate::motion::table::Table;
use crate::motion::tolerances::note_largest;
use crate::output::destination::Destination;
use crate::output::stream::Stream;
use crate::plot::error::PlotError;
use crate::report::notes::{
    choice, say_changing_masses, say_choice, say_moved, say_negative_energy, say_undetermined,
};
use crate::report::verification::Verification;
use crate::report::{summary, text};

/// Runs `pc run`.
///
/// # Errors
/// [`CliError`]; the motion has been written as far as it was reached.
pub fn command(arguments: &RunArguments) -> Result<(), CliError> {
    let destination = Destination::table(arguments.output.as_deref())?;
    let picture =
        Destination::plot(arguments.plot.as_deref())?.map(|place| (place, arguments.drawn.wanted()));
    let is_hamel = arguments.form == Some(Variables::Given);
    let mut model = input::open_in(&arguments.model, &arguments.velocities, is_hamel)?;
    model.observe_reactions(arguments.outputs == Some(Outputs::Reactions));
    if arguments.outputs.is_some() && model.document().constraints.is_empty() {
        text::say(format_args!("note: there are no constraints, and so no reactions\n"));
    }
    model.differentiate_by_parameters(!arguments.sensitivities.is_empty());
    for name in &arguments.project {
        model.keep(name).map_err(CliError::UnknownIntegral)?;
    }
    let form = Plan::form(&model, arguments);
    let asked = Asked {
        verify: !arguments.no_verify,
        fine: picture.is_some(),
        notes: true,
        estimate: arguments.estimate,
    };
    // A picture needs all rows.
    let mut stream = destination.stream().filter(|_| picture.is_none());
    let run = integrate_into(stream.as_mut(), &model, form, asked, &arguments.checkpoints, || {
        Plan::new(&model, arguments)
    });
    let run = run?;
    let written = match stream.filter(Stream::is_begun) {
        Some(stream) => stream.end(),
        None => write(&run, &destination, picture.as_ref()),
    };
    text::say(format_args!("{}", summary::text(&run)));
    match (run.outcome(), written) {
        (Err(ending), Err(error)) => {
            text::say(format_args!("{}\n", error.report()));
            Err(ending)
        }
        (outcome, written) => outcome.and(written),
    }
}

/// Derives, compiles and integrates the motion of a model; `plan` is called once the model is known
/// to be sound. Whatever the form, the table shows quasi-velocities. At the start and, if this is
/// fast, at the end the equations are compared with a second derivation. The run has the points
/// that smooth curves need.
///
/// # Errors
/// [`CliError`] if there is no motion at all, or the second derivation disagrees; an incomplete
/// motion is a [`Run`].
pub fn integrate(
    model: &Model,
    form: Variables,
    plan: impl FnOnce() -> Result<Plan, CliError>,
) -> Result<Run, CliError> {
    let asked = Asked { verify: true, fine: true, notes: true, estimate: false };
    integrate_into(None, model, form, asked, &CheckpointArguments::default(), plan)
}

/// As [`integrate`], of a model that was compared with its second derivation before.
///
/// # Errors
/// [`CliError`] if there is no motion at all.
pub(crate) fn integrate_again(
    model: &Model,
    form: Variables,
    plan: impl FnOnce() -> Result<Plan, CliError>,
) -> Result<Run, CliError> {
    let asked = Asked { verify: false, fine: false, notes: false, estimate: false };
    integrate_into(None, model, form, asked, &CheckpointArguments::default(), plan)
}

/// What a run includes besides the integration.
#[derive(Clone, Copy, Debug)]
struct Asked {
    /// Whether the equations are compared with a second derivation.
    verify: bool,
    /// Whether the run has the motion between its rows.
    fine: bool,
    /// Whether what there is to know of the equations is said.
    notes: bool,
    /// Whether the table has the errors of its columns.
    estimate: bool,
}

/// As [`integrate`], with checkpoints; writes the rows to `stream` as they are computed where they
/// are too many for memory.
fn integrate_into(
    stream: Option<&mut Stream<'_>>,
    model: &Model,
    form: Variables,
    asked: Asked,
    checkpoints: &CheckpointArguments,
    plan: impl FnOnce() -> Result<Plan, CliError>,
) -> Result<Run, CliError> {
    let graph = model.graph();
    let assembly = model.assemble(&graph)?;
    if asked.notes {
        say_notes(&assembly)?;
    }
    let mut flow = Flow::new(model, &assembly, form)?;
    let plan = plan()?;
    let tolerances = plan.tolerances(&mut flow);
    let options = plan.options(&tolerances);
    let numbers = memory::numbers(&flow, &plan, checkpoints.path().is_some(), asked.estimate);
    let (rows, limits) = (plan.samples as u64, model.budget().limits());
    let alone = checkpoints.path().is_none() && plan.sensitivities.is_empty();
    let stream = stream.filter(|_| alone && !asked.estimate && memory::is_much(rows, numbers, limits));
    // Of rows that are written at once, only the times are held.
    memory::allow(rows, if stream.is_some() { 1 } else { numbers }, limits)?;
    let begins = checkpoints.resume.is_none();
    let mut checkpoints = Checkpoints::new(checkpoints, model, &plan, form)?;
    let mut derivatives = match plan.sensitivities.as_slice() {
        [] => None,
        parameters => Some(Derivatives::new(model, form, parameters)?),
    };

    let mut verification = asked.verify.then(|| Verification::new(model, &assembly, form));
    if let Some(verification) = &mut verification {
        verification.compare(&flow, &assembly, "the start", plan.t_start, &flow.start)?;
    }

    // Derivatives are known at the rows alone, and a resumed motion is not integrated from its
    // start again.
    let mut again = (asked.fine && alone).then(|| flow.clone());
    let mut beside = asked.estimate.then(|| flow.clone());
    let mut given = stream.map(|stream| Given::new(&flow, stream)).transpose()?;
    interrupt::catch();
    let mut progress = Progress::new(plan.t_start, plan.t_end);
    let mut steps = StepStates::new();
    let observer = |t: f64, y: &[f64]| {
        progress.at(t);
        steps.note(t, y);
        if interrupt::requested() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let start = Instant::now();
    let (solved, error) = match (&mut checkpoints, &mut derivatives, &mut given) {
        (Some(checkpoints), derivatives, _) => {
            checkpoints.solve(&flow, (&plan, &options), derivatives.as_mut(), observer)?
        }
        (None, None, Some(given)) => given.follow(&mut flow, (&plan, &options), observer),
        (None, Some(derivatives), _) => {
            derivatives.follow(&mut flow, plan.t_start, &plan.times(), &options, observer)
        }
        (None, None, None) => Solve::new(&mut flow.motion, plan.t_start, &flow.start)
            .method(&options)
            .events(&mut flow.events)
            .follow(&plan.times(), observer),
    };
    let wall = start.elapsed();
    drop(progress);
    let estimate = beside.as_mut().map(|flow| estimate::companion(flow, (&plan, &options), &solved));

    let Solution { trajectory, occurrences, ending, slides } = &solved;
    let last = match &given {
        Some(given) => given.last.as_ref().map(|(t, y)| (*t, y.as_slice())),
        None => trajectory.last(),
    };
    if let (Some(verification), Some((t, y))) = (&mut verification, last)
        && t != plan.t_start
        && !verification.is_long(&flow)
    {
        verification.compare(&flow, &assembly, "the end", t, y)?;
        if let Some(derivatives) = &derivatives {
            let slopes = derivatives.slopes(&mut flow.clone(), t, y);
            verification.compare_derivatives(model, &assembly, &flow, (t, y), &slopes)?;
        }
    }
    if let Some(verification) = &mut verification {
        compare_resets(verification, model, &assembly, &flow, occurrences)?;
    }
    let passed_at_start = steps
        .iter()
        .next()
        .filter(|_| begins)
        .map(|first| beyond_at_once(&mut flow, &plan, first))
        .unwrap_or_default();
    let end = last.map(|(t, y)| (t, y.to_vec()));
    let events: Vec<String> = flow.events.events().iter().map(|event| event.name().to_owned()).collect();
    let is_full = given.as_ref().is_some_and(Given::has_failed);
    let ending = match (*ending, error) {
        (_, Some(error)) => error.ended().map_or_else(|| Ending::Failed(Box::new(error)), Ending::Ended),
        (Some(solver::Ending::Completed), None) => Ending::Completed,
        (Some(solver::Ending::Event { event }), None) => Ending::Event { name: events[event].clone() },
        (Some(solver::Ending::Stopped) | None, None) if is_full => Ending::Unwritten,
        (Some(solver::Ending::Stopped) | None, None) => Ending::Interrupted,
    };
    let mut largest = Vec::new();
    let (mut table, constraints) = match given {
        Some(given) => {
            largest = given.largest;
            (given.table, given.constraints)
        }
        None => (
            Table::with_derivatives(&mut flow, trajectory, derivatives.as_ref()),
            residuals(&mut flow, trajectory),
        ),
    };
    let estimate =
        estimate.map(|estimate| Estimate::of(&estimate, &mut flow, (&solved, &tolerances), &mut table));
    let resets = assembly.events.iter().any(|event| !event.resets.is_empty());
    let keeps_energy = assembly.keeps_energy() && !resets;
    let lost = match &ending {
        Ending::Completed | Ending::Event { .. } if !resets => {
            let states: Vec<(f64, &[f64])> =
                steps.iter().chain(end.as_ref().map(|(t, y)| (*t, y.as_slice()))).collect();
            let accuracy = (&tolerances, plan.rtol);
            lost_integral(&table, (&assembly, keeps_energy), &mut flow, accuracy, &states)
        }
        _ => None,
    };
    trajectory.iter().for_each(|(_, y)| note_largest(&mut largest, y));
    let lost_inertia = match &ending {
        Ending::Failed(error) => {
            error.reached().and_then(|reached| lost_inertia(&assembly, &mut flow, plan.t_start, reached))
        }
        _ => None,
    };
    let statistics = *trajectory.statistics();
    let fine = again
        .as_mut()
        .and_then(|flow| fine::table(flow, (&plan, &options), statistics.steps, statistics.current_time));
    Ok(Run {
        title: model.title().to_owned(),
        parameters: model.parameters().map(|(name, value)| (name.to_owned(), value)).collect(),
        state: flow.motion.names().to_vec(),
        never_exceeded: tolerances.never_exceeded(&written_start(model), &largest),
        tolerances,
        table,
        estimate,
        constraints,
        dropped: dropped(&assembly),
        jumps: jumps(&assembly),
        keeps_energy,
        lost,
        lost_inertia,
        fine,
        statistics,
        plan,
        events,
        passed_at_start,
        occurrences: occurrences.iter().map(|occurrence| (occurrence.event, occurrence.time)).collect(),
        slides: slides.clone(),
        ending,
        verification,
        wall,
    })
}

/// The events whose functions are zero at the start and go on in the direction of the event: this is
/// no passage. The sides are those at the end of the first step, or of the part of it before an
/// event.
fn beyond_at_once(flow: &mut Flow, plan: &Plan, (t, y): (f64, &[f64])) -> Vec<usize> {
    let count = flow.events.events().len();
    let (mut before, mut after) = (vec![f64::NAN; count], vec![f64::NAN; count]);
    let start = flow.start.clone();
    let evaluated = flow.events.evaluate(plan.t_start, &start, &mut before).is_ok()
        && flow.events.evaluate(t, y, &mut after).is_ok();
    let goes = |&i: &usize| before[i] == 0.0 && flow.events.events()[i].crosses().leaves(-after[i]);
    if evaluated { (0..count).filter(goes).collect() } else { Vec::new() }
}

/// Compares the state after the first occurrence of each event that has a reset.
fn compare_resets(
    verification: &mut Verification,
    model: &Model,
    assembly: &Assembly<'_>,
    flow: &Flow,
    occurrences: &[Occurrence],
) -> Result<(), CliError> {
    for (place, event) in assembly.events.iter().enumerate().filter(|(_, event)| !event.resets.is_empty()) {
        let first = occurrences.iter().find(|occurrence| occurrence.event == place);
        if let Some(Occurrence { time, state_before, state_after, .. }) = first {
            let name = event.name.as_str();
            let jump = Jump { event: name, t: *time, before: state_before, after: state_after };
            verification.compare_reset(model, flow, &jump)?;
        }
    }
    Ok(())
}

/// The start values as the text or the command line has them.
fn written_start(model: &Model) -> Vec<(String, f64)> {
    model.start().map(|values| model.start_names().into_iter().zip(values).collect()).unwrap_or_default()
}

/// What a person may want to know of the equations.
fn say_notes(assembly: &Assembly<'_>) -> Result<(), CliError> {
    say_moved(assembly);
    say_negative_energy(assembly);
    say_changing_masses(assembly);
    if assembly.constraints.held().is_none() && assembly.has_multipliers() {
        let (_, free) = assembly.equations_of(Variables::QuasiVelocities)?;
        if let Some(remark) = choice(assembly, &free.independent) {
            say_choice(&remark);
        }
        energy_remark(assembly).into_iter().for_each(say_choice);
    }
    say_undetermined(assembly);
    Ok(())
}

/// Whether forces or the Lagrangian jump where the state changes.
fn jumps(assembly: &Assembly<'_>) -> bool {
    let (system, graph) = (&assembly.system, assembly.system.graph());
    let (state, lagrangian) = (system.state(), system.lagrangian());
    let jumps = |&f: &Expr<'_>| graph.applies(f, &state, |function| !function.is_continuous());
    system.forces().iter().chain([&lagrangian]).any(jumps)
}

fn residuals(flow: &mut Flow, trajectory: &Trajectory) -> Vec<(String, f64)> {
    let mut worst: Vec<(String, f64)> = flow.constraint_names().into_iter().map(|name| (name, 0.0)).collect();
    for (t, y) in trajectory.iter() {
        note_residuals(&mut worst, flow, t, y);
    }
    worst
}

fn write(
    run: &Run,
    destination: &Destination,
    picture: Option<&(Destination, Wanted)>,
) -> Result<(), CliError> {
    destination.write_table(run)?;
    match picture {
        Some((place, wanted)) => place.write_plot(&drawn(run, wanted)?),
        None => Ok(()),
    }
}

/// The wanted columns of a motion, drawn.
///
/// # Errors
/// [`CliError::Plot`] where it has no such column.
pub fn drawn(run: &Run, wanted: &Wanted) -> Result<Drawing, CliError> {
    let picture = Picture::of(&run.title, &run.record(), wanted);
    Ok(picture.map_err(|source| PlotError::Column { option: "plot", source })?.drawing())
}

impl Run {
    /// An error unless the run was completed and kept what it is proved to keep.
    pub(crate) fn outcome(self) -> Result<(), CliError> {
        let names = self.state;
        if let Some(lost) = self.lost {
            return Err(CliError::Lost(lost));
        }
        match self.ending {
            // The error of the file says why it is unwritten.
            Ending::Completed | Ending::Event { .. } | Ending::Unwritten => Ok(()),
            Ending::Interrupted => Err(CliError::Interrupted { t: self.statistics.current_time }),
            Ending::Ended(limit) => Err(CliError::Ended { t: self.statistics.current_time, limit }),
            Ending::Failed(cause) => Err(CliError::Integration {
                cause,
                names,
                jumps: self.jumps,
                lost_inertia: self.lost_inertia,
            }),
        }
    }
}

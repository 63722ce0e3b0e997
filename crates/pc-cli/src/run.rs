//! `pc run`: integrate, write, sum up.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use pc_mech::Graph;
use pc_model::Model;
use pc_solve::{SolveError, Statistics, solve_observed};

use crate::args::RunArguments;
use crate::conservation::keeps_energy;
use crate::error::CliError;
use crate::output::Destination;
use crate::plan::Plan;
use crate::plot::Picture;
use crate::progress::Progress;
use crate::table::Table;
use crate::{input, interrupt, summary, text};

/// A motion as far as it was computed, and how that went.
#[derive(Debug)]
pub struct Run {
    /// What the model calls itself.
    pub title: String,
    /// The parameters with their values.
    pub parameters: Vec<(String, f64)>,
    /// How it was to be computed.
    pub plan: Plan,
    /// What was reached.
    pub table: Table,
    /// Whether the motion keeps its energy: nothing depends on time and the forces do no work.
    pub keeps_energy: bool,
    /// How it ended.
    pub ending: Ending,
    /// The work done.
    pub statistics: Statistics,
    /// The time it took.
    pub wall: Duration,
}

/// How a run ended.
#[derive(Debug)]
pub enum Ending {
    /// At its end.
    Completed,
    /// By Ctrl-C.
    Interrupted,
    /// The integration could not go on.
    Failed(Box<SolveError>),
}

impl Ending {
    /// In a word.
    pub fn word(&self) -> &'static str {
        match self {
            Ending::Completed => "completed",
            Ending::Interrupted => "interrupted",
            Ending::Failed(_) => "failed",
        }
    }
}

/// Does what `pc run` is asked to.
///
/// # Errors
/// [`CliError`]; what was reached has been written then.
pub fn command(arguments: &RunArguments) -> Result<(), CliError> {
    let destination = Destination::table(arguments.output.as_deref())?;
    let picture = Destination::plot(arguments.plot.as_deref())?;
    let model = input::open(&arguments.model)?;
    let run = integrate(&model, || Plan::new(&model, arguments))?;

    let written = write(&run, &destination, picture.as_ref());
    text::say(format_args!("{}", summary::text(&run)));
    match (run.outcome(), written) {
        (Err(ending), Err(error)) => {
            text::say(format_args!("{}\n", error.report()));
            Err(ending)
        }
        (outcome, written) => outcome.and(written),
    }
}

/// Derives, compiles and integrates the motion of a model; `plan` is asked for once the model is known to be sound.
///
/// # Errors
/// [`CliError`] if there is no motion at all; one that could not be completed is a [`Run`].
pub fn integrate(model: &Model, plan: impl FnOnce() -> Result<Plan, CliError>) -> Result<Run, CliError> {
    let graph = Graph::new();
    let (assembly, equations) = input::derive(model, &graph)?;
    let mut motion = model.compile(&equations, assembly.t_start, &assembly.start)?;
    let plan = plan()?;

    interrupt::catch();
    let mut progress = Progress::new(plan.t_start, plan.t_end);
    let observer = |t: f64, _: &[f64]| {
        progress.at(t);
        if interrupt::requested() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let start = Instant::now();
    let solved =
        solve_observed(&mut motion, plan.t_start, &assembly.start, &plan.times(), &plan.options(), observer);
    let wall = start.elapsed();
    drop(progress);

    let (trajectory, ending) = match solved {
        Ok(trajectory) if trajectory.is_complete() => (trajectory, Ending::Completed),
        Ok(trajectory) => (trajectory, Ending::Interrupted),
        Err(failure) => (failure.reached, Ending::Failed(Box::new(failure.error))),
    };
    Ok(Run {
        title: input::title(model).to_owned(),
        parameters: model.parameters().map(|(name, value)| (name.to_owned(), value)).collect(),
        table: Table::new(&mut motion, &trajectory),
        keeps_energy: keeps_energy(&assembly.system),
        statistics: *trajectory.statistics(),
        plan,
        ending,
        wall,
    })
}

fn write(run: &Run, destination: &Destination, picture: Option<&Destination>) -> Result<(), CliError> {
    destination.write_table(run)?;
    match picture {
        Some(picture) => picture.write_plot(&Picture::of(run)),
        None => Ok(()),
    }
}

impl Run {
    /// Names of the components of the state.
    fn state_names(&self) -> Vec<String> {
        let columns = self.table.coordinates().start..self.table.quasi_velocities().end;
        self.table.columns()[columns].to_vec()
    }

    /// An error unless the run was completed.
    fn outcome(self) -> Result<(), CliError> {
        let names = self.state_names();
        match self.ending {
            Ending::Completed => Ok(()),
            Ending::Interrupted => Err(CliError::Interrupted { t: self.statistics.current_time }),
            Ending::Failed(cause) => Err(CliError::Integration { cause, names }),
        }
    }
}

//! Integration in one call.

use std::error::Error;
use std::fmt;
use std::ops::ControlFlow;

use pc_expr::{Events, VectorField};

use crate::cvode::cvode::{Cvode, Ending};
use crate::error::{SolveError, SolveFailure};
use crate::events::events::Occurrence;
use crate::integration::dense_output::DenseOutput;
use crate::integration::options::Options;
use crate::integration::trajectory::Trajectory;

/// Integrates ẏ = f(t, y) from y(t0) = y0 and returns the states at `times`.
///
/// `y0` has as many numbers as `field` has components. The times go one way, forwards or backwards; the first may be
/// t0. The vector field is not evaluated beyond the last time, nor beyond the stop time of the options.
///
/// # Errors
/// [`SolveFailure`] with the outputs reached before the failure; none if the input is not valid.
pub fn solve<F: VectorField>(
    field: F,
    t0: f64,
    y0: &[f64],
    times: &[f64],
    options: &Options,
) -> Result<Trajectory, Box<SolveFailure>> {
    solve_observed(field, t0, y0, times, options, |_, _| ControlFlow::Continue(()))
}

/// As [`solve`], and gives the end (t, y) of each internal step to `step`, to show progress or to stop.
///
/// If stopped, the trajectory has the outputs before that step and is not
/// [complete](Trajectory::is_complete).
///
/// # Errors
/// As for [`solve`].
pub fn solve_observed<F: VectorField>(
    field: F,
    t0: f64,
    y0: &[f64],
    times: &[f64],
    options: &Options,
    step: impl FnMut(f64, &[f64]) -> ControlFlow<()>,
) -> Result<Trajectory, Box<SolveFailure>> {
    let mut trajectory = Trajectory::new(field.dim());
    let mut options = options.clone();
    options.stop_time = options.stop_time.or(times.last().copied().filter(|t| t.is_finite()));
    let mut cvode = match Cvode::new(field, t0, y0, &options) {
        Ok(cvode) => cvode,
        Err(error) => return Err(Box::new(SolveFailure { reached: trajectory, error })),
    };
    let output = |t, y: &[f64]| {
        trajectory.push(t, y);
        ControlFlow::Continue(())
    };
    let result = cvode.run_observed(times, output, step);
    trajectory.finish(matches!(result, Ok(Ending::Completed)), cvode.statistics());
    match result {
        Ok(_) => Ok(trajectory),
        Err(error) => Err(Box::new(SolveFailure { reached: trajectory, error })),
    }
}

/// Integrates ẏ = f(t, y) from y(t0) = y0 to `end` and returns the motion as a function of time.
///
/// # Errors
/// As for [`Cvode::run_dense`], which also gives what was reached.
pub fn solve_dense<F: VectorField>(
    field: F,
    t0: f64,
    y0: &[f64],
    end: f64,
    options: &Options,
) -> Result<DenseOutput, SolveError> {
    let mut options = options.clone();
    options.stop_time = options.stop_time.or(Some(end).filter(|t| t.is_finite()));
    let mut motion = DenseOutput::default();
    Cvode::new(field, t0, y0, &options)?.run_dense(end, |segment| {
        motion.extend([segment]);
        ControlFlow::Continue(())
    })?;
    Ok(motion)
}

/// A motion with events.
#[derive(Debug, Clone, PartialEq)]
pub struct HybridMotion {
    /// The states at the output times, y⁺ at those of events; a terminal event is the last.
    pub trajectory: Trajectory,
    /// What occurred, in order.
    pub occurrences: Vec<Occurrence>,
    /// How it ended; none if it failed.
    pub ending: Option<Ending>,
}

/// A failed [`solve_with_events`] with what it had reached.
#[derive(Debug)]
#[non_exhaustive]
pub struct HybridFailure {
    /// Outputs and occurrences before the failure.
    pub reached: HybridMotion,
    /// What went wrong.
    pub error: SolveError,
}

impl fmt::Display for HybridFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.error.fmt(f)
    }
}

impl Error for HybridFailure {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        self.error.source()
    }
}

/// As [`solve`], with events.
///
/// # Errors
/// [`HybridFailure`] with what was reached before the failure.
pub fn solve_with_events<F: VectorField, E: Events>(
    field: F,
    t0: f64,
    y0: &[f64],
    times: &[f64],
    options: &Options,
    events: E,
) -> Result<HybridMotion, Box<HybridFailure>> {
    solve_with_events_observed(field, t0, y0, times, options, events, |_, _| ControlFlow::Continue(()))
}

/// As [`solve_with_events`], and gives the end (t, y⁻) of each internal step, or of the part of it before an event, to
/// `step`, to show progress or to stop.
///
/// # Errors
/// As for [`solve_with_events`].
pub fn solve_with_events_observed<F: VectorField, E: Events>(
    field: F,
    t0: f64,
    y0: &[f64],
    times: &[f64],
    options: &Options,
    events: E,
    step: impl FnMut(f64, &[f64]) -> ControlFlow<()>,
) -> Result<HybridMotion, Box<HybridFailure>> {
    let trajectory = Trajectory::new(field.dim());
    let mut motion = HybridMotion { trajectory, occurrences: Vec::new(), ending: None };
    let mut options = options.clone();
    options.stop_time = options.stop_time.or(times.last().copied().filter(|t| t.is_finite()));
    let start = Cvode::new(field, t0, y0, &options).and_then(|cvode| cvode.with_events(events));
    let mut hybrid = match start {
        Ok(hybrid) => hybrid,
        Err(error) => return Err(Box::new(HybridFailure { reached: motion, error })),
    };
    let output = |t, y: &[f64]| {
        motion.trajectory.push(t, y);
        ControlFlow::Continue(())
    };
    let occurred = |occurrence: &Occurrence| {
        motion.occurrences.push(occurrence.clone());
        ControlFlow::Continue(())
    };
    let result = hybrid.run_observed(times, output, occurred, step);
    motion.trajectory.finish(matches!(result, Ok(Ending::Completed)), hybrid.statistics());
    motion.ending = result.as_ref().ok().copied();
    match result {
        Ok(_) => Ok(motion),
        Err(error) => Err(Box::new(HybridFailure { reached: motion, error })),
    }
}

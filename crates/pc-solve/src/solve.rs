//! Integration in one call.

use std::ops::ControlFlow;

use pc_expr::VectorField;

use crate::cvode::{Cvode, Ending};
use crate::error::SolveFailure;
use crate::options::Options;
use crate::trajectory::Trajectory;

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

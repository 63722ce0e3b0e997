//! A motion in legs from checkpoint to checkpoint.

use std::cell::Cell;
use std::num::NonZeroU64;
use std::ops::ControlFlow;

use pc_expr::VectorField;

use super::Checkpoint;
use crate::code::Code;
use crate::cvode::{Cvode, Ending};
use crate::error::{IntegrationError, Reason, SolveError, SolveFailure};
use crate::options::Options;
use crate::trajectory::Trajectory;

/// As [`solve_observed`](crate::solve_observed), with a checkpoint after `every` so many internal steps.
///
/// The motion goes on from the checkpoint `from`, whose outputs are the first of `times`, and is begun anew at each
/// checkpoint with a vector field that `field` makes. So a motion that goes on from any of its checkpoints gives the
/// same outputs, bit for bit, as one that was never interrupted.
///
/// Each checkpoint is given to `save`, `from` too, and the last one again with `true` where `step` stops the motion or it
/// fails: with the outputs beyond it, which are returned, nothing can be begun anew.
///
/// # Errors
/// As for [`solve`](crate::solve()).
pub fn solve_checkpointed<F: VectorField>(
    mut field: impl FnMut() -> F,
    from: Checkpoint,
    times: &[f64],
    options: &Options,
    every: NonZeroU64,
    mut save: impl FnMut(&Checkpoint, bool),
    mut step: impl FnMut(f64, &[f64]) -> ControlFlow<()>,
) -> Result<Trajectory, Box<SolveFailure>> {
    let mut options = options.clone();
    options.stop_time = options.stop_time.or(times.last().copied().filter(|t| t.is_finite()));
    let limit = options.max_steps;
    let mut stand = from;
    loop {
        save(&stand, false);
        let done = stand.outputs.len();
        if done > 0 && done >= times.len() {
            stand.outputs.finish(true, stand.statistics);
            return Ok(stand.outputs);
        }
        let before = (stand.time, stand.statistics);
        let failed = |reached, error| Err(Box::new(SolveFailure { reached, error }));
        // The steps to the next output are counted here, over all legs.
        let unlimited = options.clone().max_steps(u64::MAX);
        let mut cvode = match Cvode::resume(field(), &stand, &unlimited) {
            Ok(cvode) => cvode,
            Err(error) => return failed(stand.outputs, error),
        };
        let (mut steps, mut stopped, mut exhausted) = (0, false, false);
        let since = Cell::new(stand.steps_since_output);
        let outputs = &mut stand.outputs;
        let push = |t, y: &[f64]| {
            outputs.push(t, y);
            since.set(0);
            ControlFlow::Continue(())
        };
        let observed = |t, y: &[f64]| {
            steps += 1;
            since.set(since.get() + 1);
            stopped = step(t, y).is_break();
            exhausted = since.get() > limit;
            if stopped || exhausted || steps == every.get() {
                ControlFlow::Break(())
            } else {
                ControlFlow::Continue(())
            }
        };
        let ending = cvode.run_observed(times.get(done..).unwrap_or_default(), push, observed);
        stand.statistics = before.1.followed_by(&cvode.statistics());
        let ending = match ending {
            Ok(Ending::Stopped) if exhausted => Err(too_much_work(&cvode, limit, times[stand.outputs.len()])),
            // Ended where its last step began.
            Ok(Ending::Stopped) if !stopped && cvode.time() == before.0 => Err(stalled(&cvode)),
            Ok(Ending::Stopped) if !stopped => {
                let passed = outputs_within(&mut cvode, times, &mut stand.outputs);
                stand.steps_since_output =
                    if passed.as_ref().is_ok_and(|n| *n > 0) { 0 } else { since.get() };
                passed.map(|_| Ending::Stopped)
            }
            ending => ending,
        };
        match ending {
            Ok(Ending::Stopped) if !stopped => {
                stand.time = cvode.time();
                stand.state.copy_from_slice(cvode.state());
            }
            ending => {
                let complete = matches!(ending, Ok(Ending::Completed));
                let mut reached = stand.outputs;
                reached.finish(complete, stand.statistics);
                if !complete {
                    let outputs = reached.first(done);
                    save(&Checkpoint { time: before.0, statistics: before.1, outputs, ..stand }, true);
                }
                return match ending {
                    Ok(_) => Ok(reached),
                    Err(error) => failed(reached, error),
                };
            }
        }
    }
}

/// The outputs inside the step whose end the integration stands at, and their number.
fn outputs_within<F: VectorField>(
    cvode: &mut Cvode<F>,
    times: &[f64],
    outputs: &mut Trajectory,
) -> Result<usize, SolveError> {
    let (end, before) = (cvode.time(), outputs.len());
    let direction = cvode.statistics().last_step;
    for &t in times.iter().skip(before).take_while(|&&t| (end - t) * direction >= 0.0) {
        if t == end {
            outputs.push(t, cvode.state());
        } else {
            outputs.push(t, cvode.interpolate(t, 0)?);
        }
    }
    Ok(outputs.len() - before)
}

/// A leg that led nowhere.
fn stalled<F: VectorField>(cvode: &Cvode<F>) -> SolveError {
    ended(cvode, Reason::Stalled)
}

/// Legs that lead too slowly to the output at `t`.
fn too_much_work<F: VectorField>(cvode: &Cvode<F>, steps: u64, t: f64) -> SolveError {
    let message = format!("{steps} internal steps taken before reaching t = {t}.");
    ended(cvode, Reason::Cvode { code: Code::TooMuchWork, message })
}

fn ended<F: VectorField>(cvode: &Cvode<F>, reason: Reason) -> SolveError {
    let (time, state) = (cvode.time(), cvode.state().to_vec());
    SolveError::Integration(Box::new(IntegrationError { reason, time, state, failure: None }))
}

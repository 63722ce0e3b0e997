//! Integration of a flow, with its events.

use std::ops::ControlFlow;

use pc_model::Flow;
use pc_solve::{
    Ending, HybridMotion, Options, SolveError, SolveFailure, Trajectory, solve_observed,
    solve_with_events_observed,
};

/// The motion as far as it can be computed, and why not further.
pub(crate) fn follow(
    flow: &mut Flow,
    t_start: f64,
    times: &[f64],
    options: &Options,
    step: impl FnMut(f64, &[f64]) -> ControlFlow<()>,
) -> (HybridMotion, Option<SolveError>) {
    let (motion, start) = (&mut flow.motion, &flow.start);
    if flow.events.is_empty() {
        return without_events(solve_observed(motion, t_start, start, times, options, step));
    }
    match solve_with_events_observed(motion, t_start, start, times, options, &mut flow.events, step) {
        Ok(motion) => (motion, None),
        Err(failure) => (failure.reached, Some(failure.error)),
    }
}

/// A motion on which nothing happens, as far as it could be computed, and why not further.
pub(crate) fn without_events(
    solved: Result<Trajectory, Box<SolveFailure>>,
) -> (HybridMotion, Option<SolveError>) {
    let motion = |trajectory, ending| HybridMotion { trajectory, occurrences: Vec::new(), ending };
    match solved {
        Ok(trajectory) if trajectory.is_complete() => (motion(trajectory, Some(Ending::Completed)), None),
        Ok(trajectory) => (motion(trajectory, Some(Ending::Stopped)), None),
        Err(failure) => (motion(failure.reached, None), Some(failure.error)),
    }
}

//! Integration of a flow, with its events.

use std::ops::ControlFlow;

use pc_model::Flow;
use pc_solve::{Options, Solution, Solve, SolveError};

/// The motion as far as it can be computed, and why not further.
pub(crate) fn follow(
    flow: &mut Flow,
    t_start: f64,
    times: &[f64],
    options: &Options,
    step: impl FnMut(f64, &[f64]) -> ControlFlow<()>,
) -> (Solution, Option<SolveError>) {
    let solve = Solve::new(&mut flow.motion, t_start, &flow.start).method(options).events(&mut flow.events);
    match solve.run_observed(times, step) {
        Ok(solution) => (solution, None),
        Err(failure) => (failure.reached, Some(failure.error)),
    }
}

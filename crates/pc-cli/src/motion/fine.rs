//! The motion between its rows, as close as it needs to be drawn.

use std::ops::ControlFlow;

use pc_model::Flow;
use pc_solve::{Method, Segment, Solve};

use crate::motion::interrupt;
use crate::motion::plan::Plan;
use crate::motion::table::Table;

/// Numbers that are held.
const MOST_NUMBERS: usize = 4_000_000;

/// Points of a motion, unless its steps have very many each.
const FEWEST: usize = 2000;
const MOST_POINTS: usize = 60;

/// Points of a step, so that the polynomial of the method is seen as the curve that it is: steps of multistep methods are short
/// against what moves, one of Taylor's method is up to half an oscillation.
fn points(method: Method) -> usize {
    match method {
        Method::Adams | Method::Bdf => 3,
        Method::Dop853 | Method::Auto => 8,
        Method::Taylor => 20,
    }
}

/// What an integrator takes two times for the same by.
const ROUNDINGS: f64 = 4.0 * f64::EPSILON;

/// The time at which a table of inputs is read at the end `t` of a step that lies towards `inside`: at a break before the step that
/// of the break, at one behind it the last before it. So a jump has both of its values.
fn side(breaks: &[f64], t: f64, inside: f64) -> f64 {
    let near = ROUNDINGS * t.abs();
    let first = breaks.partition_point(|&time| time < t - near);
    match breaks.get(first).filter(|&&time| time <= t + near) {
        Some(time) if inside < *time => time.next_down(),
        Some(time) => *time,
        None => t,
    }
}

/// The states of the steps of a motion and between them, those before and after events and jumps of inputs included, as a table;
/// none where they do not reach as far as `reached`. The motion is integrated once more: no row of its own depends on it.
pub(crate) fn table(flow: &mut Flow, plan: &Plan, steps: u64, reached: f64) -> Option<Table> {
    let columns = 1 + flow.names.len() + flow.motion.observable_names().len();
    // Where nothing bends the steps are few and long.
    let points = points(plan.method).max((FEWEST / (steps as usize).max(1)).min(MOST_POINTS));
    let most = MOST_NUMBERS / columns;
    // So many that a pixel has many of them all the same.
    let stride = (steps as usize).saturating_mul(points).div_ceil(most).max(1);
    let mut states: Vec<(f64, Vec<f64>)> = Vec::new();
    let mut count = 0;
    let start = flow.start.clone();
    let breaks = flow.motion.signals().breaks().to_vec();
    let mut keep = |t: f64, segment: &Segment| {
        count += 1;
        if count % stride == 0 || states.is_empty() {
            let mut state = vec![0.0; start.len()];
            segment.evaluate(t, &mut state);
            states.push((t, state));
        }
    };
    let options = plan.options();
    let solve = Solve::new(&mut flow.motion, plan.t_start, &start).method(&options).events(&mut flow.events);
    let segment = |segment: Segment| {
        let (from, to) = segment.span();
        keep(side(&breaks, from, to), &segment);
        (1..points).for_each(|i| keep(from + (to - from) * (i as f64 / points as f64), &segment));
        keep(side(&breaks, to, from), &segment);
        if interrupt::requested() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    // What fails there has failed before, and been said.
    let _ = solve.start().ok()?.run_dense(plan.t_end, segment, |_| ControlFlow::Continue(()));
    let (last, _) = states.last()?;
    // Steps of the same method from the same start end in the same places, but for the last.
    let is_whole = (reached - last).abs() <= 0.01 * (reached - plan.t_start).abs();
    is_whole.then(|| Table::of_states(flow, &states))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_break_is_read_on_the_side_of_the_step() {
        let breaks = [0.0, 1.0, 2.5];
        let before = 1.0f64.next_down();
        // Forwards the step before the break ends there, backwards the step behind it does.
        assert_eq!([side(&breaks, 1.0, 0.4), side(&breaks, 1.0, 1.7)], [before, 1.0]);
        // The end of a step may miss the break by rounding, on either side.
        for t in [1.0 - 2.0 * f64::EPSILON, 1.0 + 2.0 * f64::EPSILON] {
            assert_eq!([side(&breaks, t, 0.4), side(&breaks, t, 1.7)], [before, 1.0]);
        }
        assert_eq!([side(&breaks, 0.7, 0.4), side(&[], 1.0, 0.4)], [0.7, 1.0]);
    }
}

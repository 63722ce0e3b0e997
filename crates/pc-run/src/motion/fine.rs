//! The motion between its rows, with as many points as pictures need.

use std::ops::ControlFlow;

use pc_model::Flow;
use pc_solve::{Method, Options, Segment, Solve};

use crate::motion::table::Table;
use crate::observer::Observer;
use crate::plan::Plan;

/// The greatest count of numbers held in memory.
const MOST_NUMBERS: usize = 4_000_000;

/// The smallest number of points of a motion, unless a step would then have more than `MOST_POINTS`.
const FEWEST: usize = 2000;
const MOST_POINTS: usize = 60;

/// The number of points in a step, enough to show the polynomial of the method as a curve: steps of multistep
/// methods are short compared with an oscillation, while a step of Taylor's method can be half of one.
fn points(method: Method) -> usize {
    match method {
        Method::Adams | Method::Bdf => 3,
        Method::Dop853 | Method::Auto => 8,
        Method::Taylor => 20,
    }
}

/// The relative difference up to which an integrator treats two times as equal.
const ROUNDINGS: f64 = 4.0 * f64::EPSILON;

/// The time at which a table of inputs is read at an end `t` of a step that contains `inside`: for a break
/// after `inside`, it is the last number before the break; for one before `inside`, it is the break itself.
/// In this way, both values at a jump are shown.
fn side(breaks: &[f64], t: f64, inside: f64) -> f64 {
    let near = ROUNDINGS * t.abs();
    let first = breaks.partition_point(|&time| time < t - near);
    match breaks.get(first).filter(|&&time| time <= t + near) {
        Some(time) if inside < *time => time.next_down(),
        Some(time) => *time,
        None => t,
    }
}

/// A table of the states at the ends of steps and between them, including those before and after events and
/// jumps of inputs; none if they do not reach as far as `reached`. The motion is integrated again, so that
/// its rows do not depend on this.
pub(crate) fn table(
    flow: &mut Flow,
    (plan, options): (&Plan, &Options),
    steps: u64,
    reached: f64,
    observer: &dyn Observer,
) -> Option<Table> {
    let columns = 1 + flow.names.len() + flow.motion.observable_names().len();
    // Nearly straight motions have few, long steps.
    let points = points(plan.method).max((FEWEST / (steps as usize).max(1)).min(MOST_POINTS));
    let most = MOST_NUMBERS / columns;
    // With more points than these, leaving some out does not show: a pixel has many.
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
    let solve = Solve::new(&mut flow.motion, plan.t_start, &start).method(options).events(&mut flow.events);
    let segment = |segment: Segment| {
        let (from, to) = segment.span();
        keep(side(&breaks, from, to), &segment);
        (1..points).for_each(|i| keep(from + (to - from) * (i as f64 / points as f64), &segment));
        keep(side(&breaks, to, from), &segment);
        if observer.is_stopped() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    // A failure has already been reported by the first integration.
    let _ = solve.start().ok()?.run_dense(plan.t_end, segment, |_| ControlFlow::Continue(()));
    let (last, _) = states.last()?;
    // The same method from the same start makes the same steps, except the last.
    let is_whole = (reached - last).abs() <= 0.01 * (reached - plan.t_start).abs();
    is_whole.then(|| Table::of_states(flow, states))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_break_is_read_on_the_side_of_the_step() {
        let breaks = [0.0, 1.0, 2.5];
        let before = 1.0f64.next_down();
        // Forwards, the step before the break ends there; backwards, the step after it does.
        assert_eq!([side(&breaks, 1.0, 0.4), side(&breaks, 1.0, 1.7)], [before, 1.0]);
        // The end of a step may miss the break by rounding, on either side.
        for t in [1.0 - 2.0 * f64::EPSILON, 1.0 + 2.0 * f64::EPSILON] {
            assert_eq!([side(&breaks, t, 0.4), side(&breaks, t, 1.7)], [before, 1.0]);
        }
        assert_eq!([side(&breaks, 0.7, 0.4), side(&[], 1.0, 0.4)], [0.7, 1.0]);
    }
}

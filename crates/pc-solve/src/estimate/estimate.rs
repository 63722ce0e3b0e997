//! The distance between a motion and its companion.

use std::ops::ControlFlow;

use pc_expr::{Events, VectorField};

use crate::error::SolveError;
use crate::estimate::companion::Companion;
use crate::events::events::Occurrence;
use crate::integration::integration::Ending;
use crate::integration::trajectory::Trajectory;
use crate::settings::options::Options;
use crate::solve::failure::SolveFailure;
use crate::solve::solution::Solution;
use crate::solve::solve::Solve;

/// The global error of a value y whose companion is ỹ: |y − ỹ|, but at least the rounding error
/// ε|y|/2 of y.
pub fn error_of(value: f64, beside: f64) -> f64 {
    let distance = (value - beside).abs();
    // f64::max would lose a NaN
    let rounding = f64::EPSILON / 2.0 * value.abs();
    if distance < rounding { rounding } else { distance }
}

/// The estimated global errors of the outputs of a motion.
///
/// ```
/// use pc_solve::{ErrorEstimate, NoEvents, Options, Solve, from_fn};
///
/// let turn = || from_fn(2, |_t, y, ydot| { ydot[0] = y[1]; ydot[1] = -y[0]; Ok(()) });
/// let (start, times, options) = ([1.0, 0.0], [50.0, 100.0], Options::default());
/// let motion = Solve::new(turn(), 0.0, &start).method(&options).run(&times)?;
/// let estimate = ErrorEstimate::of(&motion, (turn(), 0.0, &start), NoEvents, &times, &options);
/// let (estimated, y) = (estimate.errors(&motion, 1)[0], motion.trajectory.state(1)[0]);
/// let error = (y - 100.0_f64.cos()).abs();
/// assert!(estimated < 10.0 * error && error < 10.0 * estimated);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct ErrorEstimate {
    companion: Companion,
    beside: Solution,
    /// The number of outputs that can be compared.
    len: usize,
    failure: Option<SolveError>,
}

impl ErrorEstimate {
    /// The errors of `motion`, which was integrated from y(t0) = y0 with these events and options;
    /// the field and the events are in the state in which they were before that integration, and
    /// `times` are the output times requested.
    pub fn of<F: VectorField>(
        motion: &Solution,
        start: (F, f64, &[f64]),
        events: impl Events,
        times: &[f64],
        options: &Options,
    ) -> ErrorEstimate {
        ErrorEstimate::observed(motion, start, events, times, options, |_, _| ControlFlow::Continue(()))
    }

    /// Like [`of`](ErrorEstimate::of), but passes the end (t, ỹ⁻) of each step of the companion to
    /// `step`, to show progress or to stop the companion.
    pub fn observed<F: VectorField>(
        motion: &Solution,
        (mut field, t0, y0): (F, f64, &[f64]),
        events: impl Events,
        times: &[f64],
        options: &Options,
        step: impl FnMut(f64, &[f64]) -> ControlFlow<()>,
    ) -> ErrorEstimate {
        let companion = Companion::of(&mut field, options, motion.trajectory.statistics());
        // As far as the motion came, and to the next output where an event ended it.
        let reached = &times[..motion.trajectory.len().min(times.len())];
        let solve = Solve::new(field, t0, y0).method(companion.options()).events(events);
        let (beside, failure) = SolveFailure::split(solve.run_observed(reached, step));
        let len = comparable(motion, &beside);
        ErrorEstimate { companion, beside, len, failure }
    }

    /// How the companion was integrated.
    pub fn companion(&self) -> &Companion {
        &self.companion
    }

    /// The outputs of the companion; the first [`len`](ErrorEstimate::len) correspond to those of
    /// the motion.
    pub fn beside(&self) -> &Trajectory {
        &self.beside.trajectory
    }

    /// The occurrences of events in the companion, in order.
    pub fn occurrences(&self) -> &[Occurrence] {
        &self.beside.occurrences
    }

    /// The number of outputs whose errors are known: all outputs of the motion, unless the
    /// companion failed, was stopped or had a different terminal event.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Whether no error is known.
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The errors of the components at output number `i`, which is less than
    /// [`len`](ErrorEstimate::len); if an event ended both motions, the last errors are those of
    /// the state at the event, whenever it occurred in each.
    pub fn errors(&self, motion: &Solution, i: usize) -> Vec<f64> {
        let (state, beside) = (motion.trajectory.state(i), self.beside.trajectory.state(i));
        state.iter().zip(beside).map(|(value, beside)| error_of(*value, *beside)).collect()
    }

    /// The outputs before which more events occurred in one of the motions than in the other: their
    /// errors include the changes made by events.
    pub fn beyond_events(&self, motion: &Solution) -> Vec<usize> {
        let direction = motion.trajectory.statistics().first_step.signum();
        let before = |solution: &Solution, i: usize| {
            let t = solution.trajectory.times()[i];
            solution.occurrences.partition_point(|occurrence| direction * (t - occurrence.time) >= 0.0)
        };
        (0..self.len).filter(|&i| before(motion, i) != before(&self.beside, i)).collect()
    }

    /// How the companion ended; none if it failed.
    pub fn ending(&self) -> Option<Ending> {
        self.beside.ending
    }

    /// Why the companion failed, if it did.
    pub fn failure(&self) -> Option<&SolveError> {
        self.failure.as_ref()
    }
}

/// The number of initial outputs that two motions have in common: at the same times, or at the event that
/// ended both.
fn comparable(motion: &Solution, beside: &Solution) -> usize {
    let (outputs, others) = (motion.trajectory.times(), beside.trajectory.times());
    let same = outputs.iter().zip(others).take_while(|(t, s)| t == s).count();
    let ends_alike = matches!(motion.ending, Some(Ending::Event { .. })) && motion.ending == beside.ending;
    let is_last = same + 1 == outputs.len() && outputs.len() == others.len();
    if ends_alike && is_last { outputs.len() } else { same }
}

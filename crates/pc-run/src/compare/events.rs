//! Rows at which an event has happened in one motion and not yet in another that is the same but for errors.

use crate::compare::difference::{SAFETY, TELLING};
use crate::motion::accuracy::ROUNDING;
use crate::motion::run::Run;

/// The times of the events of a motion and of its companion, and the time at which both end.
struct Events {
    own: Vec<f64>,
    beside: Vec<f64>,
    end: f64,
}

impl Events {
    fn of(run: &Run) -> Events {
        let own: Vec<f64> = run.occurrences.iter().map(|occurrence| occurrence.time).collect();
        // What an incomplete companion has not reached is not known; the rows there have no errors either.
        let beside = match &run.accuracy {
            Some(accuracy) if accuracy.incomplete.is_none() => accuracy.events.clone(),
            _ => own.clone(),
        };
        Events { own, beside, end: run.reached() }
    }

    /// The times of event number k in both; what has not happened by the end may happen later.
    fn at(&self, k: usize) -> [f64; 2] {
        [&self.own, &self.beside].map(|times| times.get(k).copied().unwrap_or(self.end))
    }
}

/// For each of the times, whether it lies between those of one event in the two motions and their companions. Values there
/// differ by what the event changes, however accurate they are.
pub(crate) fn between_events(runs: [&Run; 2], times: &[f64]) -> Vec<bool> {
    let [a, b] = runs.map(Events::of);
    let count = [&a.own, &a.beside, &b.own, &b.beside].map(Vec::len).into_iter().fold(0, usize::max);
    let span = times.last().zip(times.first()).map_or(0.0, |(last, first)| (last - first).abs());
    let mut between = vec![false; times.len()];
    let mut leave_out = |of: &[f64]| {
        let rounding = ROUNDING * of.iter().fold(0.0f64, |most, t| most.max(t.abs()));
        let from = of.iter().copied().fold(f64::INFINITY, f64::min) - rounding;
        let to = of.iter().copied().fold(f64::NEG_INFINITY, f64::max) + rounding;
        // An event whose time is not even known to this part of the motion tells that its errors have grown.
        if to - from <= TELLING * span {
            for (between, t) in between.iter_mut().zip(times) {
                *between |= (from..=to).contains(t);
            }
        }
    };
    let (mut uncertain, mut agree) = (0.0f64, true);
    for k in 0..count {
        let (of_a, of_b) = (a.at(k), b.at(k));
        leave_out(&of_a);
        leave_out(&of_b);
        uncertain = uncertain.max(time_error(of_a) + time_error(of_b));
        agree &= (of_a[0] - of_b[0]).abs() <= allowed(uncertain, of_a[0]);
        if agree {
            leave_out(&[of_a, of_b].concat());
        }
    }
    between
}

/// By how much the times of the events that end two motions may differ; none where they are not known.
pub(crate) fn ends_allowed(runs: [&Run; 2]) -> f64 {
    let last = |run: &Run| {
        let events = Events::of(run);
        time_error(events.at(events.own.len().saturating_sub(1)))
    };
    allowed(last(runs[0]) + last(runs[1]), runs[0].reached())
}

fn time_error([own, beside]: [f64; 2]) -> f64 {
    (own - beside).abs()
}

fn allowed(errors: f64, t: f64) -> f64 {
    SAFETY * errors + ROUNDING * t.abs()
}

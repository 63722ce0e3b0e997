//! Timing in turns.

use std::hint::black_box;
use std::time::{Duration, Instant};

/// Length of a turn.
const SLICE: Duration = Duration::from_micros(100);
/// Most turns of each variant: more do not lower the smallest times.
const MOST: usize = 1000;
/// Fewest turns.
const FEWEST: usize = 3;

/// Computes something from the state; false where it fails.
pub(crate) type Call<'a> = dyn FnMut(&[f64], &mut [f64]) -> bool + 'a;

/// Durations, one for each round.
#[derive(Clone, Debug, Default)]
pub(crate) struct Times(Vec<f64>);

impl Times {
    pub(crate) fn push(&mut self, time: f64) {
        self.0.push(time);
    }

    /// How many there are.
    pub(crate) fn len(&self) -> usize {
        self.0.len()
    }

    /// The shortest, the 10th percentile and the median.
    pub(crate) fn quantiles(&self) -> [f64; 3] {
        let mut sorted = self.0.clone();
        sorted.sort_by(f64::total_cmp);
        [0.0, 0.1, 0.5].map(|part| {
            let place = (part * sorted.len() as f64) as usize;
            sorted.get(place.min(sorted.len().saturating_sub(1))).copied().unwrap_or(f64::NAN)
        })
    }
}

/// One way to compute something.
pub(crate) struct Variant<'a> {
    pub(crate) name: &'static str,
    /// Operations of one evaluation, where these are known.
    pub(crate) operations: Option<usize>,
    /// Length of what it computes.
    pub(crate) outputs: usize,
    pub(crate) call: Box<Call<'a>>,
}

/// Nanoseconds per evaluation of each variant; the variants take turns until the time is spent.
pub(crate) fn interleave(state: &[f64], variants: &mut [Variant<'_>], patience: Duration) -> Vec<Times> {
    let calls: Vec<u32> = variants.iter_mut().map(|variant| calls_in_a_slice(state, variant)).collect();
    let mut times = vec![Times::default(); variants.len()];
    let start = Instant::now();
    for round in 0..MOST {
        if round >= FEWEST && start.elapsed() > patience {
            break;
        }
        // Every other round goes backwards, so that no variant always follows the same one.
        for turn in 0..variants.len() {
            let i = if round % 2 == 0 { turn } else { variants.len() - 1 - turn };
            let duration = slice(state, &mut variants[i], calls[i]);
            times[i].push(duration.as_secs_f64() * 1e9 / f64::from(calls[i]));
        }
    }
    times
}

fn calls_in_a_slice(state: &[f64], variant: &mut Variant<'_>) -> u32 {
    let mut calls = 1;
    loop {
        let duration = slice(state, variant, calls);
        if duration >= SLICE / 2 || calls >= 1 << 20 {
            let scale = SLICE.as_secs_f64() / duration.as_secs_f64().max(1e-9);
            return ((f64::from(calls) * scale) as u32).max(1);
        }
        calls *= 2;
    }
}

fn slice(state: &[f64], variant: &mut Variant<'_>, calls: u32) -> Duration {
    // The address of the state depends on the outputs, masked to zero, so each call waits for the
    // one before, as in an integrator.
    let mask = black_box(0u64);
    let mut outputs = vec![0.0f64; variant.outputs];
    let start = Instant::now();
    for _ in 0..calls {
        let bits = outputs.iter().fold(0, |bits, output| bits | output.to_bits());
        (variant.call)(&state[(bits & mask) as usize..], &mut outputs);
    }
    let duration = start.elapsed();
    black_box(&outputs);
    duration
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_in_order() {
        let mut times = Times::default();
        (0..10).rev().for_each(|time| times.push(f64::from(time)));
        assert_eq!((times.len(), times.quantiles()), (10, [0.0, 1.0, 5.0]));
        assert!(Times::default().quantiles().iter().all(|time| time.is_nan()));
    }

    #[test]
    fn every_variant_gets_its_turns_on_the_state() {
        let variant = |factor: f64| Variant {
            name: "multiple",
            operations: None,
            outputs: 1,
            call: Box::new(move |state: &[f64], outputs: &mut [f64]| {
                assert_eq!(state, [2.0, 3.0]);
                outputs[0] = factor * state[0];
                true
            }),
        };
        let times = interleave(&[2.0, 3.0], &mut [variant(1.0), variant(-1.0)], Duration::ZERO);
        assert!(times.iter().all(|times| times.len() == FEWEST));
    }
}

//! Timing variants of a computation in turns.

use std::hint::black_box;
use std::time::{Duration, Instant};

/// How often each variant gets its turn.
pub(crate) const ROUNDS: usize = 300;
/// How long a turn is.
const SLICE: Duration = Duration::from_micros(100);

/// Computes ẏ from y.
pub(crate) type Call<'a> = dyn FnMut(&[f64], &mut [f64]) + 'a;

/// One way to compute ẏ from y.
pub(crate) struct Variant<'a> {
    /// What the table calls it.
    pub(crate) name: String,
    call: Box<Call<'a>>,
}

impl<'a> Variant<'a> {
    /// The variant of that name.
    pub(crate) fn new(name: impl Into<String>, call: Box<Call<'a>>) -> Variant<'a> {
        Variant { name: name.into(), call }
    }

    /// ẏ at y.
    pub(crate) fn at(&mut self, y: &[f64]) -> Vec<f64> {
        let mut dy = vec![0.0; y.len()];
        (self.call)(y, &mut dy);
        dy
    }
}

/// Durations, one for each round, in the order of the rounds.
#[derive(Clone, Debug, Default)]
pub(crate) struct Times(pub(crate) Vec<f64>);

impl Times {
    /// The shortest.
    pub(crate) fn min(&self) -> f64 {
        quantile(&self.0, 0.0)
    }

    /// The 10th percentile.
    pub(crate) fn p10(&self) -> f64 {
        quantile(&self.0, 0.1)
    }

    /// The median.
    pub(crate) fn median(&self) -> f64 {
        quantile(&self.0, 0.5)
    }

    /// The median of the ratios to `other` within a round: what slows a whole round drops out.
    pub(crate) fn ratio_to(&self, other: &Times) -> f64 {
        let ratios: Vec<f64> = self.0.iter().zip(&other.0).map(|(a, b)| a / b).collect();
        quantile(&ratios, 0.5)
    }
}

fn quantile(values: &[f64], fraction: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let place = (fraction * sorted.len() as f64) as usize;
    sorted.get(place.min(sorted.len().saturating_sub(1))).copied().unwrap_or(f64::NAN)
}

/// e^(mean of the logarithms)
pub(crate) fn geometric_mean(values: &[f64]) -> f64 {
    (values.iter().map(|v| v.ln()).sum::<f64>() / values.len() as f64).exp()
}

/// Nanoseconds a call of each variant near `state`, by turns of about [`SLICE`], [`ROUNDS`] of them.
///
/// Each call waits for the one before: where its state is depends on all outputs. Every other round goes
/// through the variants backwards, so that none has always the same one before it.
pub(crate) fn interleave(state: &[f64], variants: &mut [Variant<'_>]) -> Vec<Times> {
    let calls: Vec<u32> = variants.iter_mut().map(|variant| calls_in_a_slice(state, variant)).collect();
    let mut times = vec![Times::default(); variants.len()];
    for round in 0..ROUNDS {
        for turn in 0..variants.len() {
            let i = if round % 2 == 0 { turn } else { variants.len() - 1 - turn };
            let duration = slice(state, &mut variants[i], calls[i]);
            times[i].0.push(duration.as_nanos() as f64 / f64::from(calls[i]));
        }
    }
    times
}

fn calls_in_a_slice(state: &[f64], variant: &mut Variant<'_>) -> u32 {
    let mut calls = 1;
    loop {
        // The best of three, since an interruption would end the search too early.
        let duration = (0..3).map(|_| slice(state, variant, calls)).min().unwrap_or_default();
        if duration >= SLICE / 2 || calls >= 1 << 20 {
            let scale = SLICE.as_secs_f64() / duration.as_secs_f64().max(1e-9);
            return ((f64::from(calls) * scale) as u32).max(1);
        }
        calls *= 2;
    }
}

fn slice(state: &[f64], variant: &mut Variant<'_>, calls: u32) -> Duration {
    // The state begins where the outputs, masked to nothing, say. It is not written between calls: code that
    // loads several numbers at once would otherwise wait for those just stored one at a time, which no
    // integrator makes it do.
    let mask = black_box(0u64);
    // Outputs are read one by one, in an order the compiler does not know, for the same reason the other way
    // round.
    let order: Vec<usize> = (0..state.len()).map(black_box).collect();
    let mut dy = vec![0.0f64; state.len()];
    let start = Instant::now();
    for _ in 0..calls {
        let bits = order.iter().fold(0, |bits, &i| bits | dy[i].to_bits());
        (variant.call)(&state[(bits & mask) as usize..], &mut dy);
    }
    let duration = start.elapsed();
    black_box(&dy);
    duration
}

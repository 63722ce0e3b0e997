//! Refinement of the samples of functions along a step.
//!
//! Between two samples a and b of a function g, which are h apart in time, g differs from their
//! chord by g[a, b, c] (t − t_a)(t − t_b), the remainder of Newton's interpolation with the divided
//! difference through a third sample c. As far as the samples show, a function with the same sign
//! at a and b keeps that sign in between, and a function that changes sign passes through zero
//! once, if
//! ```text
//! (√|a| + √|b|)² > |g[a, b, c]| h²   and   |b − a| > |g[a, b, c]| h².
//! ```
//! An interval is halved if this condition fails with the third sample taken from either
//! neighbouring interval.

use crate::events::samples::{Look, Sample};

/// The safety factor for the remainder, since its divided difference is only an estimate.
const SAFETY: f64 = 3.0;
/// The maximum number of samples in a search.
const MOST: usize = 256;
/// Intervals shorter than this fraction of the whole interval are not halved.
const SHORTEST: f64 = 1.0 / 4096.0;
/// An interval is divided at this fraction if the functions fail at its midpoint.
const BESIDE: f64 = 0.4375;

/// Adds samples between `left` and the last of `samples` where a function may have more roots than
/// its signs show.
///
/// The samples end where the functions fail; the time and the failure are then returned.
pub(crate) fn look_closer<E, F: FnMut(f64, &mut [f64]) -> Result<(), E>>(
    left: &Sample,
    samples: &mut Vec<Sample>,
    look: &mut Look<'_, F>,
) -> Option<(f64, E)> {
    let shortest = SHORTEST * (samples.last()?.t - left.t).abs();
    let mut k = 0;
    while k < samples.len() && samples.len() < MOST {
        let from = if k == 0 { left } else { &samples[k - 1] };
        let (start, end) = (from.t, samples[k].t);
        if (end - start).abs() <= shortest || !is_doubtful(left, samples, k) {
            k += 1;
            continue;
        }
        let middle = start + 0.5 * (end - start);
        match look.at(middle) {
            Ok(sample) => samples.insert(k, sample),
            // The functions may have a pole there alone.
            Err(failure) => match look.at(start + BESIDE * (end - start)) {
                Ok(sample) => samples.insert(k, sample),
                Err(_) => {
                    samples.drain(k..).for_each(|sample| look.room.take_back(sample));
                    return Some((middle, failure));
                }
            },
        }
        // The previous interval has a new neighbour.
        k = k.saturating_sub(1);
    }
    None
}

/// Whether a function may have more roots than its signs show in the interval that ends at sample
/// `k`.
fn is_doubtful(left: &Sample, samples: &[Sample], k: usize) -> bool {
    let at = |k: usize| if k == 0 { left } else { &samples[k - 1] };
    let (a, b) = (at(k), at(k + 1));
    let before = k.checked_sub(1).map(at);
    let after = samples.get(k + 1);
    let h = b.t - a.t;
    (0..a.values.len()).any(|i| {
        let (from, to) = (a.values[i], b.values[i]);
        let slope = (to - from) / h;
        let bend = |c: &Sample| (((c.values[i] - to) / (c.t - b.t) - slope) / (c.t - a.t)).abs();
        let remainder = before.into_iter().chain(after).map(bend).fold(0.0, f64::max) * h * h;
        let distance = if from.signum() * to.signum() > 0.0 {
            (from.abs().sqrt() + to.abs().sqrt()).powi(2)
        } else {
            (to - from).abs()
        };
        distance < SAFETY * remainder
    })
}

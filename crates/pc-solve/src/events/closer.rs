//! Where functions are looked at more closely.
//!
//! Between two samples a and b of a function g, h apart in time, g differs from their chord by g[a, b, c] (t − t_a)(t − t_b), the
//! remainder of Newton's interpolation with the divided difference through a third sample c. A function with samples on one side
//! of zero stays there in between, and one with samples on both sides passes through zero once, as far as the samples tell, if
//! ```text
//! (√|a| + √|b|)² > |g[a, b, c]| h²   and   |b − a| > |g[a, b, c]| h².
//! ```
//! An interval for which one of its neighbours lets doubt that is halved.

use crate::events::samples::{Look, Sample};

/// The remainder is estimated by another divided difference, and taken for so many times what that says.
const SAFETY: f64 = 3.0;
/// Most samples of a search.
const MOST: usize = 256;
/// No interval is halved that is shorter than this part of the whole.
const SHORTEST: f64 = 1.0 / 4096.0;

/// Adds samples from `left` through `samples` where a function may have more roots than its signs tell.
///
/// Where the functions have no value the samples end, with the failure.
pub(crate) fn look_closer<E, F: FnMut(f64, &mut [f64]) -> Result<(), E>>(
    left: &Sample,
    samples: &mut Vec<Sample>,
    look: &mut Look<'_, F>,
) -> Option<E> {
    let shortest = SHORTEST * (samples.last()?.t - left.t).abs();
    let mut k = 0;
    while k < samples.len() && samples.len() < MOST {
        let from = if k == 0 { left } else { &samples[k - 1] };
        let (start, end) = (from.t, samples[k].t);
        if (end - start).abs() <= shortest || !is_doubtful(left, samples, k) {
            k += 1;
            continue;
        }
        match look.at(start + 0.5 * (end - start)) {
            Ok(middle) => samples.insert(k, middle),
            Err(failure) => {
                samples.drain(k..).for_each(|sample| look.room.take_back(sample));
                return Some(failure);
            }
        }
        // The interval before has another neighbour now.
        k = k.saturating_sub(1);
    }
    None
}

/// Whether a function may have more roots than its signs tell in the interval that ends at sample number `k`.
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

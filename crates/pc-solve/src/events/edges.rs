//! Sampling where functions have no value along a step: at a pole that is hit exactly, and beyond
//! an edge of their domain.
//!
//! Functions may have passed through zero before such an edge, as √(1 − t) − 0.2 does at t = 0.96,
//! although the next sample lies beyond it: samples are therefore taken up to the edge.

use crate::events::samples::{Look, SAME, Sample};

/// Where functions have no value at a time, they are evaluated on both sides of it, at this
/// distance in multiples of the rounding error of the time.
const BESIDE: f64 = 1.0;

/// Extends the samples after `left` where the functions have failed at a time: with samples on both
/// sides of that time, as for a pole, if the functions have values there; else with samples up to
/// the edge, in which case the failure beyond the edge is returned. At the end of the search, `to`,
/// the values just before `to` are used.
pub(super) fn approach<E, F: FnMut(f64, &mut [f64]) -> Result<(), E>>(
    left: &Sample,
    samples: &mut Vec<Sample>,
    (t, failure): (f64, E),
    to: f64,
    look: &mut Look<'_, F>,
) -> Option<E> {
    let from = samples.last().unwrap_or(left).t;
    let distance = (BESIDE * SAME * t.abs().max(1e-3 * (to - left.t).abs())).copysign(to - left.t);
    if (t - distance - from) * distance > 0.0
        && let (Ok(before), Ok(after)) = (look.at(t - distance), look.at(t + distance))
    {
        if (to - after.t) * distance > 0.0 {
            samples.extend([before, after]);
        } else {
            samples.push(Sample { t: to, ..before });
        }
        return None;
    }
    Some(edge(left, samples, (t, failure), look))
}

/// Adds samples between the last one, or `left`, and the time at which the functions have failed,
/// ever nearer to the edge beyond which they fail; returns the failure nearest to the edge.
pub(super) fn edge<E, F: FnMut(f64, &mut [f64]) -> Result<(), E>>(
    left: &Sample,
    samples: &mut Vec<Sample>,
    (mut beyond, mut failure): (f64, E),
    look: &mut Look<'_, F>,
) -> E {
    let mut inside = samples.last().unwrap_or(left).t;
    let least = f64::EPSILON * inside.abs().max(beyond.abs());
    while (beyond - inside).abs() > least {
        let middle = inside + 0.5 * (beyond - inside);
        if middle == inside || middle == beyond {
            break; // there is no time between
        }
        match look.at(middle) {
            Ok(sample) => {
                inside = middle;
                samples.push(sample);
            }
            Err(nearer) => (beyond, failure) = (middle, nearer),
        }
    }
    failure
}

//! Jumps and poles at which functions change their signs.
//!
//! A time at which a function changes its sign is bracketed to rounding error. At the distances d,
//! 8 d, … from that time, on both sides, a continuous function grows, a function that jumps stays
//! nearly constant, and a function with a pole of order p falls by a factor of 8ᵖ from each
//! distance to the next.

use crate::events::samples::{Look, Sample};

/// How a function changes its sign.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Break {
    /// Through zero, as far as the samples show.
    None,
    /// By a jump.
    Jump,
    /// Through infinity.
    Pole,
}

/// The ratio of successive distances.
const RATIO: f64 = 8.0;
/// The number of distances on each side.
const DISTANCES: i32 = 4;
/// Near a pole a function falls by at least this factor from one distance to the next.
const FALL: f64 = 1.5;
/// A function counts as jumping if, on each side, it varies by at most this fraction of its jump.
const STEADY: f64 = 1e-3;
/// A jump is larger than this fraction of the function's largest value in the step; anything
/// smaller may be rounding error.
const RESOLVED: f64 = 1e-6;

/// How each function changes its sign between `a` and `b`, which are close to each other, judging
/// by its values at the distances, which are multiples of `rounding`: on both sides, or on one side
/// only if the other side lies before the step or a function fails there.
pub(crate) fn breaks<E, F: FnMut(f64, &mut [f64]) -> Result<(), E>>(
    a: &Sample,
    b: &Sample,
    rounding: f64,
    look: &mut Look<'_, F>,
) -> Vec<Break> {
    let (direction, start) = (b.t - a.t, look.room.start);
    let mut side = |from: f64, sign: f64| -> Vec<Sample> {
        let offset = |k: i32| (rounding * RATIO.powi(k)).copysign(sign * direction);
        let samples: Option<_> = (1..=DISTANCES).map(|k| look.at(from + offset(k)).ok()).collect();
        samples.unwrap_or_default()
    };
    let farthest = rounding * RATIO.powi(DISTANCES);
    let has_room = (a.t - start).abs() >= farthest;
    let before = if has_room { side(a.t, -1.0) } else { Vec::new() };
    let after = side(b.t, 1.0);
    let kind = |i: usize| {
        let values = |samples: &[Sample]| samples.iter().map(|sample| sample.values[i]).collect::<Vec<f64>>();
        kind((a.values[i], &values(&before)), (b.values[i], &values(&after)), look.room.largest[i])
    };
    let kinds = (0..a.values.len()).map(kind).collect();
    before.into_iter().chain(after).for_each(|sample| look.room.take_back(sample));
    kinds
}

/// The same for one function, from its values at the bracket and at growing distances on each side
/// of it, or on one side; if both lists are empty, nothing is known.
fn kind((a, before): (f64, &[f64]), (b, after): (f64, &[f64]), largest: f64) -> Break {
    if before.is_empty() && after.is_empty() {
        return Break::None;
    }
    let falls = |at: f64, values: &[f64]| {
        let is_one_side = values.iter().all(|value| value * at > 0.0);
        is_one_side && values.windows(2).all(|pair| pair[0].abs() >= FALL * pair[1].abs())
    };
    if falls(a, before) && falls(b, after) && a * b < 0.0 {
        return Break::Pole;
    }
    let jump = (b - a).abs();
    let steady = |at: f64, values: &[f64]| values.iter().all(|value| (value - at).abs() <= STEADY * jump);
    if jump > RESOLVED * largest && steady(a, before) && steady(b, after) { Break::Jump } else { Break::None }
}

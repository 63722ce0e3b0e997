//! Deliberate rounding errors, to measure their effect on a result.

use std::cell::Cell;

/// Whether a value is at most a bound; false for NaN.
pub(crate) fn within(value: f64, bound: f64) -> bool {
    value <= bound
}

/// Half a unit in the last place of 1.
pub(crate) const UNIT: f64 = f64::EPSILON / 2.0;

/// Moves numbers by one part in 2⁵³, up or down at random, or leaves them unchanged.
///
/// The results of a computation repeated in this way scatter as far as its rounding errors reach: widely
/// after cancellation, and after division by small numbers.
#[derive(Debug)]
pub(crate) struct Rounding {
    /// The state of the generator; `None` if numbers stay unchanged.
    state: Cell<Option<u64>>,
}

impl Rounding {
    /// The rounding that leaves numbers unchanged.
    pub(crate) fn none() -> Rounding {
        Rounding { state: Cell::new(None) }
    }

    /// The rounding that moves numbers, differently for each seed.
    pub(crate) fn made(seed: u64) -> Rounding {
        Rounding { state: Cell::new(Some(seed)) }
    }

    /// Whether numbers stay unchanged.
    pub(crate) fn is_none(&self) -> bool {
        self.state.get().is_none()
    }

    /// The number, moved or unchanged.
    pub(crate) fn of(&self, value: f64) -> f64 {
        let Some(state) = self.state.get() else { return value };
        let next = step(state);
        self.state.set(Some(next));
        let up = mix(next) >> 63 == 0;
        value * if up { 1.0 + f64::EPSILON } else { 1.0 - f64::EPSILON }
    }

    /// The result of a computation during which numbers stay unchanged.
    pub(crate) fn suspended<T>(&self, compute: impl FnOnce() -> T) -> T {
        let state = self.state.take();
        let result = compute();
        self.state.set(state);
        result
    }
}

/// Pseudo-random numbers, the same on every run: SplitMix64 of Steele, Lea and Flood (2014).
#[derive(Clone, Debug)]
pub(crate) struct Random {
    state: u64,
}

impl Random {
    pub(crate) fn new(seed: u64) -> Random {
        Random { state: mix(seed) }
    }

    /// Between −1 and 1.
    pub(crate) fn signed(&mut self) -> f64 {
        self.state = step(self.state);
        (mix(self.state) >> 11) as f64 * f64::EPSILON - 1.0
    }
}

fn step(state: u64) -> u64 {
    state.wrapping_add(0x9e37_79b9_7f4a_7c15)
}

fn mix(state: u64) -> u64 {
    let z = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

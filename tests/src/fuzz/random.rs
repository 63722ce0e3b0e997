//! Choices of a generator, the same for the same seed.

use crate::classical::SplitMix64;

/// Random choices.
#[derive(Clone, Debug)]
pub struct Random(SplitMix64);

impl Random {
    /// The choices of model number `index` of a campaign.
    pub fn new(seed: u64, index: u64) -> Random {
        let mut campaign = SplitMix64::new(seed);
        Random(SplitMix64::new(campaign.next_bits() ^ SplitMix64::new(index).next_bits()))
    }

    /// One of 0..count.
    pub fn below(&mut self, count: usize) -> usize {
        self.0.below(count)
    }

    /// True in so many of a hundred cases.
    pub fn chance(&mut self, percent: usize) -> bool {
        self.below(100) < percent
    }

    /// One of the choices.
    pub fn pick<'a, T>(&mut self, choices: &'a [T]) -> &'a T {
        &choices[self.below(choices.len())]
    }

    /// A number of two decimals between the bounds, not zero.
    pub fn decimal(&mut self, low: f64, high: f64) -> f64 {
        let number = (self.0.uniform(low, high) * 100.0).round() / 100.0;
        if number == 0.0 { 0.01 } else { number }
    }

    /// A number between the bounds with all its digits.
    pub fn number(&mut self, low: f64, high: f64) -> f64 {
        self.0.uniform(low, high)
    }

    /// Puts a list into another order.
    pub fn shuffle<T>(&mut self, list: &mut [T]) {
        for i in (1..list.len()).rev() {
            list.swap(i, self.below(i + 1));
        }
    }
}

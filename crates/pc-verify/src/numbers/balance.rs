//! Sums, with the size of their terms.

use crate::numbers::rounding::within;

/// The sum of some terms, and the size of the largest of them.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Balance {
    pub(crate) sum: f64,
    pub(crate) largest: f64,
}

impl Balance {
    pub(crate) fn add(&mut self, term: f64) {
        self.sum += term;
        if !within(term.abs(), self.largest) {
            self.largest = term.abs();
        }
    }
}

//! The units in which the components of a state are measured.

use crate::linear::linearizer::Linearizer;
use crate::stability::steady_motions::periods;

/// Below this size all lengths of a state are those of a small system.
const SMALL: f64 = 0.1;

impl Linearizer {
    /// Measures coordinates that are no angles by the largest of them at a state if all of them are small, so that a bead on a
    /// ring of a few micrometres is not sought metres away; everything else by one.
    pub(super) fn measure_by(&mut self, t: f64, state: &[f64]) {
        let periods = periods(&mut self.motion, t, state);
        let is_length = |i: &usize| *i < self.sizes.coordinates && periods[*i].is_none();
        let lengths: Vec<usize> = (0..state.len()).filter(is_length).collect();
        let largest = lengths.iter().map(|&i| state[i].abs()).fold(0.0, f64::max);
        self.units = vec![1.0; state.len()];
        if largest > 0.0 && largest < SMALL {
            lengths.into_iter().for_each(|i| self.units[i] = largest);
        }
    }

    /// The state as numbers of its units.
    pub(super) fn in_units(&self, state: &[f64]) -> Vec<f64> {
        state.iter().zip(&self.units).map(|(y, unit)| y / unit).collect()
    }

    /// Whether the state has small units.
    pub(super) fn is_small(&self) -> bool {
        self.units.iter().any(|unit| *unit < 1.0)
    }
}

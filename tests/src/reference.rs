//! End states of the built-in models, to sixteen digits.
//!
//! Each comes from an extrapolated integration of the classical equations in arithmetic of 34 digits, rounded once.

mod holonomic;
mod nonholonomic;
#[cfg(test)]
mod tests;

use holonomic::HOLONOMIC;
use nonholonomic::NONHOLONOMIC;

/// The state in which a built-in model must arrive.
#[derive(Clone, Copy, Debug)]
pub struct Reference {
    /// Name of the built-in model.
    pub model: &'static str,
    /// Time of arrival; all motions start at t = 0.
    pub t_end: f64,
    /// Names of the columns of [`start`](Reference::start) and [`state`](Reference::state): the coordinates, then
    /// the quasi-velocities, without those that constraints say vanish.
    pub columns: &'static [&'static str],
    /// State at t = 0.
    pub start: &'static [f64],
    /// State at [`t_end`](Reference::t_end); where a frame differs from that of the integration, only the
    /// coordinates, which do not depend on it.
    pub state: &'static [f64],
    /// Integrals that must not drift, under their names in the model, and `energy` where it is conserved.
    pub conserved: &'static [&'static str],
}

impl Reference {
    /// Those of `values`, one for each of the [columns](Reference::columns), that belong to the columns of these names.
    pub fn pick(&self, names: impl IntoIterator<Item = impl ToString>, values: &[f64]) -> Vec<f64> {
        let value = |name: String| self.columns.iter().position(|column| *column == name).map(|i| values[i]);
        names.into_iter().map(|name| value(name.to_string()).unwrap_or(f64::NAN)).collect()
    }
}

/// The reference states of all models, in the order of the models' names the holonomic ones, then the others.
pub fn references() -> impl Iterator<Item = &'static Reference> {
    HOLONOMIC.iter().chain(NONHOLONOMIC)
}

/// The reference of a built-in model, or `None` where there is none.
pub fn reference(model: &str) -> Option<&'static Reference> {
    references().find(|reference| reference.model == model)
}

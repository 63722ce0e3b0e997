//! Phase volume and the measures that a motion keeps.
//!
//! In goes a system, constrained or not, out comes the density of an invariant measure. `invariant_measure` finds it,
//! `reducing_multiplier` takes Chaplygin's new time from it.

pub(crate) mod invariant_measure;
pub(crate) mod reducing_multiplier;

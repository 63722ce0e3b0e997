//! Phase volume and the measures that a motion keeps.
//!
//! In goes a system, constrained or not, out comes the density of an invariant measure. `invariant_measure` finds it,
//! `phase_measure` says of any motion what is known, Liouville's theorem first, and `reducing_multiplier` takes
//! Chaplygin's new time from it.

pub(crate) mod invariant_measure;
pub(crate) mod phase_measure;
pub(crate) mod reducing_multiplier;

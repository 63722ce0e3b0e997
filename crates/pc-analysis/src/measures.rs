//! Phase volume and invariant measures.
//!
//! A system, constrained or not, gives the density of an invariant measure. `invariant_measure` finds it,
//! `phase_measure` combines all results for a motion, with Liouville's theorem first, and
//! `reducing_multiplier` derives Chaplygin's new time from it.

pub(crate) mod invariant_measure;
pub(crate) mod phase_measure;
pub(crate) mod reducing_multiplier;

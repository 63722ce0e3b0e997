//! Phase volume and invariant measures.
//!
//! The density of an invariant measure is derived from a system, constrained or not. `invariant_measure`
//! finds it, `phase_measure` combines all results for a motion, beginning with Liouville's theorem, and
//! `reducing_multiplier` derives Chaplygin's new time from the density.

pub(crate) mod invariant_measure;
pub(crate) mod phase_measure;
pub(crate) mod reducing_multiplier;

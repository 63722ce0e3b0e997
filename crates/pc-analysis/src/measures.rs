//! Phase volume and invariant measures.
//!
//! The density of an invariant measure is derived from a system, constrained or not. `invariant_measure`
//! finds it from given factors, `darboux` as a power of a polynomial, `phase_measure` combines all results for a motion, beginning with Liouville's theorem, and
//! `reducing_multiplier` derives Chaplygin's new time from the density.

pub(crate) mod darboux;
pub(crate) mod invariant_measure;
pub(crate) mod phase_measure;
pub(crate) mod reducing_multiplier;

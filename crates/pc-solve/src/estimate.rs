//! The global error of a motion, from a second motion beside it.
//!
//! From an integrated motion, its field and its options it computes the errors of the outputs. Read
//! `companion` first, which says how the second motion is integrated, then `estimate`, their distance.

pub(crate) mod companion;
pub(crate) mod estimate;

//! The global error of a motion, estimated from a second integration of it.
//!
//! From an integrated motion, its field and its options it computes the errors of the outputs. Read
//! `companion` first, which says how the second motion is integrated, then `estimate`, which
//! computes the distance between the two.

pub(crate) mod companion;
pub(crate) mod estimate;

//! The global error of a motion, estimated from a second integration of it.
//!
//! The errors of the outputs are computed from an integrated motion, its field and its options.
//! Read `companion` first, which says how the second motion is integrated, then `estimate`, which
//! computes the distance between the two motions.

pub(crate) mod companion;
pub(crate) mod estimate;

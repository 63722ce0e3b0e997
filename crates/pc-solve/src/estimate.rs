//! The global error of a motion, from a second motion beside it.
//!
//! In go a motion that was integrated, its field and its options, out come the errors of its outputs. Read
//! `companion` first, which says how the second motion is integrated, then `estimate`, their distance.

pub(crate) mod companion;
pub(crate) mod estimate;

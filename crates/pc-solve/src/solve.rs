//! Integration in one call.
//!
//! `solve` integrates with any method and returns a `solution` or a `failure`; `integrals` adds
//! integrals along the motion.

pub(crate) mod failure;
#[cfg(feature = "cvode")]
pub(crate) mod integrals;
pub(crate) mod solution;
pub(crate) mod solve;

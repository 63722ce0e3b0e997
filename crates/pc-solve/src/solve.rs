//! Integration in one call.
//!
//! `solve` integrates by any method to a `solution` or a `failure`, with `integrals` along the
//! motion.

pub(crate) mod failure;
#[cfg(feature = "cvode")]
pub(crate) mod integrals;
pub(crate) mod solution;
pub(crate) mod solve;

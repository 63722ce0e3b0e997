//! Integration in one call.
//!
//! `solve` by any method, with a `solution` or a `failure` coming out; `integrals` along the motion.

pub(crate) mod failure;
#[cfg(feature = "cvode")]
pub(crate) mod integrals;
pub(crate) mod solution;
#[cfg(feature = "cvode")]
pub(crate) mod solve;

//! What is known of identities that the graph does not settle: proved, open, disproved.
//!
//! `identity` is the verdict; `sample` evaluates at pseudo-random points near a state, and `running_error` tells a small
//! number from what rounding left of zero.

pub(crate) mod identity;
pub(crate) mod running_error;
pub(crate) mod sample;

//! Events: their functions, and how their times are located.
//!
//! `events` defines events given by closures, and occurrences; `samples` holds values along a step;
//! `closer` refines the samples where there is doubt, and `edges` extends them where functions have
//! no value; `root_finding` locates the first zero along a step, and `breaks` distinguishes zeros
//! from jumps and poles.

pub(crate) mod breaks;
pub(crate) mod closer;
pub(crate) mod edges;
pub(crate) mod events;
pub(crate) mod root_finding;
pub(crate) mod samples;

//! Events: their functions, and their location.
//!
//! `events` are given by closures, with their occurrences; `samples` are values along a step, which `closer` adds to where
//! there is doubt; `root_finding` locates the first zeros of functions along a step.

pub(crate) mod closer;
pub(crate) mod events;
pub(crate) mod root_finding;
pub(crate) mod samples;

//! Events: what they are given by, and where they occur.
//!
//! `events` takes closures and tells what occurred; `samples` are what is seen along a step, `root_finding` locates where functions along a step pass through zero
//! first.

pub(crate) mod events;
pub(crate) mod root_finding;
pub(crate) mod samples;

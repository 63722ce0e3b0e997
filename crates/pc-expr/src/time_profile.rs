//! How a vector field depends on time explicitly, looked at before an integrator steps over it.
//!
//! In goes a program and an interval of time, out come the times at which an integrator must look. Read `interval` and
//! `jet` (enclosures of functions and of their derivatives), `part` (what of a program is watched), `scan` (where it
//! turns, bends and jumps), then `profile`, what a field offers of it.

pub(crate) mod interval;
pub(crate) mod jet;
pub(crate) mod part;
pub(crate) mod profile;
pub(crate) mod scan;
#[cfg(test)]
mod tests;

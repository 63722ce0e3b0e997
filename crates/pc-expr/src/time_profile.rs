//! The explicit dependence of a vector field on time, examined before an integrator steps over it.
//!
//! A program and an interval of time give the times at which an integrator must look. Read `interval` and
//! `jet` (enclosures of functions and their derivatives), `part` (the watched part of a program), `scan`
//! (where it turns, bends and jumps), then `profile`, the interface of a field.

pub(crate) mod interval;
pub(crate) mod jet;
pub(crate) mod part;
pub(crate) mod profile;
pub(crate) mod scan;
#[cfg(test)]
mod tests;

//! What a vector field may do between two evaluations, examined before an integrator steps over it.
//!
//! A program and an interval of time give the times at which an integrator must look. Read `interval` and
//! `jet` (enclosures of functions and their derivatives), `motion` (enclosures of time and state), `part` (the
//! watched part of a program), `scan` (where that part turns, bends and jumps) and `surprises` (which of these
//! are hidden), then `profile`, functions of time, and `steep`, functions of the state: the interfaces of a
//! field.

pub(crate) mod interval;
pub(crate) mod jet;
pub(crate) mod motion;
pub(crate) mod part;
pub(crate) mod profile;
pub(crate) mod scan;
pub(crate) mod steep;
pub(crate) mod surprises;
#[cfg(test)]
mod tests;

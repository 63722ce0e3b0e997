//! Holonomic systems of many forms, described by closures: derived against classical equations and against
//! their definition, end states against references of 16 digits, integrals, structure coefficients; the same motion in two
//! frames, and in any gauge.

mod chains;
mod closed_forms;
mod definition;
mod forces;
mod harness;
mod judge;
mod pendulums;
mod rheonomic;
mod rigid_body;
mod shared;
mod two_frames;

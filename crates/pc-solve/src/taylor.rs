//! Taylor's method of adaptive order and step [Jorba, Zou 2005].
//!
//! `stepper` is the method, `step` one of its steps. Each ends where the series at its start still holds: `step_length` says how far
//! that is by the last coefficients, `foresight` looks for what a series cannot know, and the rates at the end have to be those of the
//! `polynomial`.
//! `branches` are those of a field with corners and jumps, and `corners` finds where one ends.

mod branches;
mod corners;
mod foresight;
mod polynomial;
mod step;
mod step_length;
pub(crate) mod stepper;

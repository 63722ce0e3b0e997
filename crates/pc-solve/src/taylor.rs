//! Taylor's method of adaptive order and step [Jorba, Zou 2005].
//!
//! `stepper` is the method, and `step` makes one of its steps. A step extends as far as the series
//! at its start is accurate: `step_length` estimates this length from the last coefficients,
//! `foresight` looks for features that a series cannot show, and at the end the rates must agree
//! with those of the `polynomial`. `branches` handles fields with corners and jumps, and `corners`
//! finds where a branch ends.

mod branches;
mod corners;
mod foresight;
mod polynomial;
mod step;
mod step_length;
pub(crate) mod stepper;

//! Taylor's method of adaptive order and step [Jorba, Zou 2005].
//!
//! `stepper` is the method. Each step ends where the series at its start still holds: `step_length` says how far that is by the last
//! coefficients, `foresight` looks for what a series cannot know, and the rates at the end have to be those of the `polynomial`.
//! `corners` are where the branch of a field that the series belongs to ends.

pub(crate) mod corners;
pub(crate) mod foresight;
pub(crate) mod polynomial;
pub(crate) mod step_length;
pub(crate) mod stepper;

//! The method that is chosen while the motion is integrated: explicit where it is not stiff, implicit where it is.
//!
//! `switch` is the stepper and its rules, `growth` estimates how fast neighbouring motions leave each other, `stepper` makes
//! it a method.

mod growth;
mod stepper;
pub(crate) mod switch;

//! The method that switches during the integration: explicit where the motion is not stiff,
//! implicit where it is stiff.
//!
//! `switch` holds the rules for switching, `growth` estimates the largest eigenvalue of ∂f/∂y,
//! `stepper` implements the method.

mod growth;
mod stepper;
pub(crate) mod switch;

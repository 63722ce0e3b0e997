//! Sensitivities that are integrated along with the motion.
//!
//! `sensitivities` specifies the derivatives; `variation` holds their equations, with ∂f/∂y
//! obtained from whatever the field offers (`linearisation`); CVODES evaluates these equations
//! through `equations`. `columns` holds the data of an integration with sensitivities, `forward`
//! integrates the columns, and `interpolation` gives them inside a step.

pub(crate) mod columns;
pub(crate) mod equations;
pub(crate) mod forward;
pub(crate) mod interpolation;
pub(crate) mod linearisation;
pub(crate) mod sensitivities;
pub(crate) mod variation;

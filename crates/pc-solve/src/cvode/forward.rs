//! Sensitivities, integrated along with the motion.
//!
//! `sensitivities` specifies the derivatives; `variation` holds their equations, with ∂f/∂y from
//! whatever the field offers (`linearisation`), called by CVODES through `equations`. `columns`
//! belong to an integration, `forward` integrates them, `interpolation` gives them inside a step.

pub(crate) mod columns;
pub(crate) mod equations;
pub(crate) mod forward;
pub(crate) mod interpolation;
pub(crate) mod linearisation;
pub(crate) mod sensitivities;
pub(crate) mod variation;

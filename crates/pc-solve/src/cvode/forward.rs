//! Sensitivities, integrated along with the motion.
//!
//! `sensitivities` says which derivatives; `variation` are their equations, with ∂f/∂y by whatever the field offers
//! (`linearisation`), called by CVODES as `equations`. `columns` are those of an integration, `forward` integrates
//! them, `interpolation` gives them inside a step.

pub(crate) mod columns;
pub(crate) mod equations;
pub(crate) mod forward;
pub(crate) mod interpolation;
pub(crate) mod linearisation;
pub(crate) mod sensitivities;
pub(crate) mod variation;

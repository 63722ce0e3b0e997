//! Sensitivities, integrated along with the motion.
//!
//! `sensitivities` says which derivatives; `variation` are their equations, with ∂f/∂y by whatever the field offers
//! (`linearisation`), called by CVODES as `equations`. `columns` is what an integration keeps of them, `forward` what it does
//! with them, `interpolation` what they are inside a step.

pub(crate) mod columns;
pub(crate) mod equations;
pub(crate) mod forward;
pub(crate) mod interpolation;
pub(crate) mod linearisation;
pub(crate) mod sensitivities;
pub(crate) mod variation;

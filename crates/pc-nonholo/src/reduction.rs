//! Equations in independent velocities.
//!
//! A system with constraints gives its equations in independent velocities, and the reactions. `adapted` turns
//! constraints into vanishing quasi-velocities, `constrained` puts them in after differentiation (30), (32),
//! `voronets` solves them for velocities (35).

pub(crate) mod adapted;
pub(crate) mod constrained;
pub(crate) mod voronets;

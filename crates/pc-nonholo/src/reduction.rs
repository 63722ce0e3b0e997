//! Equations in independent velocities.
//!
//! From a system with constraints to its equations in independent velocities and the reactions. `adapted`
//! turns constraints into vanishing quasi-velocities, `constrained` substitutes them after differentiation
//! (30), (32), and `voronets` solves them for velocities (35).

pub(crate) mod adapted;
pub(crate) mod constrained;
pub(crate) mod voronets;

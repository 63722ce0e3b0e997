//! Equations of the velocities that constraints leave.
//!
//! In goes a system with constraints, out come its equations in independent velocities, and the reactions.
//! `adapted` makes constraints vanishing quasi-velocities, `constrained` puts them in after differentiation (30), (32),
//! `voronets` solves them for velocities (35).

pub(crate) mod adapted;
pub(crate) mod constrained;
pub(crate) mod voronets;

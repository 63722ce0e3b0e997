//! Particles and rigid bodies: their contributions to the kinetic energy, to the force function and, by (8),
//! to the forces.
//!
//! Read `moving` (how a point moves with a frame, and the contribution of a body), `particle` and
//! `rigid_body`, then `body`, which is either of them. `velocity` is what a system stores about its bodies.

pub(crate) mod body;
pub(crate) mod moving;
pub(crate) mod particle;
pub(crate) mod rigid_body;
pub(crate) mod velocity;

//! Lie groups in coordinates: numbers for integrators, expressions for frames.
//!
//! A group provides invariant frames, exp and log, composition and projection. Read `group` (the
//! interface), then one of the groups: rotations of the plane and of space, motions of the plane and of
//! space, Heisenberg groups, products. `rotation`, `exponential` and `stumpff` are shared computations.

pub(crate) mod direct_product;
pub(crate) mod euler_angles;
pub(crate) mod exponential;
pub(crate) mod group;
pub(crate) mod heisenberg;
pub(crate) mod plane_motions;
pub(crate) mod plane_rotations;
pub(crate) mod rigid_motions;
pub(crate) mod rotation;
pub(crate) mod rotation_matrices;
pub(crate) mod stumpff;
pub(crate) mod unit_quaternions;

//! Projection of states to constraints and integrals.
//!
//! `constraint_manifold` is the surface on which constraints hold, with conditions that follow from them (`followers`) and components that are prescribed
//! (`holding`); `nearest` finds the nearest velocities on it, `yielding` those that keep some values as far as possible; `unit_quaternions` of joints
//! have length 1; `double_point` examines places where constraints lose rank; `integrals` are first integrals that are kept, `keeping` gives them to a
//! motion.

pub(crate) mod constraint_manifold;
pub(crate) mod double_point;
pub(crate) mod followers;
pub(crate) mod holding;
pub(crate) mod integrals;
pub(crate) mod keeping;
pub(crate) mod nearest;
pub(crate) mod unit_quaternions;
pub(crate) mod yielding;

//! Projection of states onto constraints and integrals.
//!
//! `constraint_manifold` is the surface on which constraints hold, with conditions that follow from them (`followers`) and components that
//! are prescribed (`holding`); `nearest` finds the nearest velocities on this surface, and `yielding` velocities of
//! which some keep their values as far as possible; `unit_quaternions` normalises the quaternions of joints;
//! `double_point` examines states where constraints lose rank; `integrals` are first integrals that are kept constant,
//! and `keeping` adds them to a motion.

pub(crate) mod constraint_manifold;
pub(crate) mod double_point;
pub(crate) mod followers;
pub(crate) mod holding;
pub(crate) mod integrals;
pub(crate) mod keeping;
pub(crate) mod nearest;
pub(crate) mod unit_quaternions;
pub(crate) mod yielding;

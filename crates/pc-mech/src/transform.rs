//! Transformations of a system into another system with the same motions.
//!
//! `quasi_velocities` changes to other η, `lagrange` changes back to ẋ, `velocities` converts states
//! between them; `restriction` keeps the last η at zero, `reduction` leaves out ignorable coordinates, and
//! `orthonormal_frame` makes the mass matrix the unit matrix.

pub(crate) mod lagrange;
pub(crate) mod orthonormal_frame;
pub(crate) mod quasi_velocities;
pub(crate) mod reduction;
pub(crate) mod restriction;
pub(crate) mod velocities;

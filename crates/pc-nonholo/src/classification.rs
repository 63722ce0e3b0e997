//! Classification of constraints: which bind, which are redundant, which are integrable.
//!
//! `classification` classifies conditions on positions and velocities by Frobenius' test. It uses `binding`,
//! which finds the constraints that bind the motion, with the help of states found by `positions`; `reach`,
//! which finds the allowed velocities; and `involutive`, which finds the directions that these velocities
//! reach by commutators. `combinations` finds constraints that are integrable together.

pub(crate) mod binding;
pub(crate) mod classification;
pub(crate) mod combinations;
pub(crate) mod involutive;
pub(crate) mod positions;
pub(crate) mod reach;

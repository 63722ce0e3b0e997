//! Classification of constraints: which bind, which are redundant, which are integrable.
//!
//! `classification` classifies conditions on positions and velocities by Frobenius' test. It uses `binding`,
//! which finds the constraints that bind the motion, with the help of states found by `positions`; `reach`,
//! the allowed velocities; and `involutive`, the directions that these reach by commutators. `combinations`
//! finds constraints that are integrable together.

pub(crate) mod binding;
pub(crate) mod classification;
pub(crate) mod combinations;
pub(crate) mod involutive;
pub(crate) mod positions;
pub(crate) mod reach;

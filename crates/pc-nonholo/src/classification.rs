//! Classification of constraints: which bind, which are redundant, which are integrable.
//!
//! Conditions on positions and velocities are classified: `classification` by Frobenius' test, with `reach`,
//! the allowed velocities, `involutive`, the directions that these reach by commutators, and `binding`, the
//! constraints that bind the motion at a state found by `positions`. `combinations` finds constraints that
//! are integrable together.

pub(crate) mod binding;
pub(crate) mod classification;
pub(crate) mod combinations;
pub(crate) mod involutive;
pub(crate) mod positions;
pub(crate) mod reach;

//! Classification of constraints: which bind, which are redundant, which are integrable.
//!
//! Conditions on positions and velocities are given their kinds: `classification` by Frobenius' test, with `reach`,
//! the velocities allowed, `involutive`, the directions that these reach by commutators, and `binding`, which of them
//! bind the motion at a state that `positions` finds. `combinations` writes those that are integrable together.

pub(crate) mod binding;
pub(crate) mod classification;
pub(crate) mod combinations;
pub(crate) mod involutive;
pub(crate) mod positions;
pub(crate) mod reach;

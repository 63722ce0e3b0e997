//! What constraints do: which bind, which follow, which can be integrated.
//!
//! In go conditions on positions and velocities, out come their kinds: `classification` by Frobenius' test, with `reach`,
//! the velocities allowed, `involutive`, the directions that these reach by commutators, and `binding`, which of them hold
//! the motion at a state that `positions` finds. `combinations` writes those that can be integrated together.

pub(crate) mod binding;
pub(crate) mod classification;
pub(crate) mod combinations;
pub(crate) mod involutive;
pub(crate) mod positions;
pub(crate) mod reach;

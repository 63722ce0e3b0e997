//! What constraints do: which bind, which follow, which can be integrated.
//!
//! In go conditions on positions and velocities, out come their kinds: `classification` by Frobenius' test, with
//! `involutive`, the directions that velocities reach by commutators, and `binding`, which of them hold the motion at a
//! state that `positions` finds.

pub(crate) mod binding;
pub(crate) mod classification;
pub(crate) mod involutive;
pub(crate) mod positions;

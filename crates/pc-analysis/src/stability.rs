//! Steady motions and their stability.
//!
//! Compiled equations and a guess yield a steady motion and verdicts on its stability. `steady_motion` finds
//! the motion with its first approximation, `spectrum` decides its stability from eigenvalues in the
//! `reachable` directions, and `second_variation` from integrals, for which `definite` finds a definite
//! combination of quadratic forms; `steady_search` applies all of these to the steady motion near a start,
//! `steady_motions` to those found from many starts.

pub(crate) mod definite;
mod reachable;
pub(crate) mod second_variation;
pub(crate) mod spectrum;
pub(crate) mod steady_motion;
pub(crate) mod steady_motions;
pub(crate) mod steady_search;

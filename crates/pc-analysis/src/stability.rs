//! Steady motions and what can be said of motions near them.
//!
//! In go compiled equations and a guess, out come a steady motion and verdicts on its stability. `steady_motion` finds it with
//! its first approximation, `spectrum` judges by eigenvalues, `second_variation` by integrals, for which `definite` looks for
//! a definite combination of quadratic forms; `steady_search` asks all of them about the steady motion near a start, `steady_motions` about
//! all that are found from many.

pub(crate) mod definite;
pub(crate) mod second_variation;
pub(crate) mod spectrum;
pub(crate) mod steady_motion;
pub(crate) mod steady_motions;
pub(crate) mod steady_search;

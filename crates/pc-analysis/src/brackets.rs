//! Poisson brackets, and the functions that commute with everything.
//!
//! A system, an algebra or constraints give brackets (12) and their Casimirs. `poisson_bracket` is the
//! bracket of a system, `almost_poisson` that of a constrained one, `casimirs` searches for the Casimirs of
//! either.

pub(crate) mod almost_poisson;
pub(crate) mod casimirs;
pub(crate) mod poisson_bracket;

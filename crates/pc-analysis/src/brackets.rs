//! Poisson brackets, and the functions that commute with all others.
//!
//! Brackets (12) and their Casimirs are derived from a system, an algebra or constraints. `poisson_bracket`
//! is the bracket of a system, `almost_poisson` that of a constrained one, and `casimirs` searches for the
//! Casimirs of either.

pub(crate) mod almost_poisson;
pub(crate) mod casimirs;
pub(crate) mod poisson_bracket;

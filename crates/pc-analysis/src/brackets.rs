//! Poisson brackets, and the functions that commute with all others.
//!
//! Brackets (12) and their Casimirs are derived from a system, an algebra or constraints. `poisson_bracket` is the bracket of a
//! system, `almost_poisson` that of a nonholonomic one, whose constraints determine `dependent_momenta`, `dirac` that of a system
//! under constraints on its positions; `casimirs` searches for the Casimirs of any of them. `bracket_algebra` expresses the
//! brackets of integrals through the integrals, `integrability` says whether these suffice, and `canonical_variables` whether
//! functions are canonical variables.

pub(crate) mod almost_poisson;
pub(crate) mod bracket_algebra;
pub(crate) mod canonical_variables;
pub(crate) mod casimirs;
pub(crate) mod dependent_momenta;
pub(crate) mod dirac;
pub(crate) mod integrability;
pub(crate) mod poisson_bracket;

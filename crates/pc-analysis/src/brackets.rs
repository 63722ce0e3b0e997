//! Poisson brackets and what commutes with everything.
//!
//! In go a system, an algebra or constraints, out come brackets (12) and their Casimirs. `poisson_bracket` is the bracket of a
//! system, `almost_poisson` that of constrained ones, `casimirs` searches either.

pub(crate) mod almost_poisson;
pub(crate) mod casimirs;
pub(crate) mod poisson_bracket;

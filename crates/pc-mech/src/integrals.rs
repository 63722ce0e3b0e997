//! What a motion keeps: rates along it, Poisson brackets, Casimirs, integrals from an ansatz.

pub(crate) mod ansatz;
pub(crate) mod bracket;
pub(crate) mod casimir;
pub(crate) mod conserved;
pub(crate) mod cyclic;
pub(crate) mod polynomials;

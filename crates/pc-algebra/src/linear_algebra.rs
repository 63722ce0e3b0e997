//! Matrices of expressions and of rational numbers.
//!
//! `matrix` is the container; `affine` extracts coefficients from expressions; `block_triangular` and `inverse`
//! invert matrices of expressions without introducing singularities. `echelon` does elimination over the rationals.

pub(crate) mod affine;
pub(crate) mod block_triangular;
pub(crate) mod echelon;
pub(crate) mod inverse;
pub(crate) mod matrix;

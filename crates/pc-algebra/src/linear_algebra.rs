//! Matrices of expressions and of rational numbers.
//!
//! `matrix` is the container; `affine` takes coefficients out of expressions; `block_triangular` and `inverse` invert
//! matrices of expressions without new singularities. `echelon` eliminates over the rationals.

pub(crate) mod affine;
pub(crate) mod block_triangular;
pub(crate) mod echelon;
pub(crate) mod inverse;
pub(crate) mod matrix;

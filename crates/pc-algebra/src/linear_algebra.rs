//! Matrices of expressions, of rational numbers and of residues.
//!
//! `matrix` is the container; `affine` takes coefficients out of expressions; `block_triangular` and `inverse` invert
//! matrices of expressions without new singularities. `echelon` eliminates over the rationals, `prime_field` over a
//! prime field, where only a rank is asked for.

pub(crate) mod affine;
pub(crate) mod block_triangular;
pub(crate) mod echelon;
pub(crate) mod inverse;
pub(crate) mod matrix;
pub(crate) mod prime_field;

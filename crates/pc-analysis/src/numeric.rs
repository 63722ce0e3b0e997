//! Eigenvalues and Newton's method, in numbers.

pub(crate) mod dense;
pub(crate) mod newton;
pub(crate) mod program;

//! Numerical methods: eigenvalues and Newton's method.

pub(crate) mod dense;
pub(crate) mod equilibrated;
pub(crate) mod newton;
pub(crate) mod program;

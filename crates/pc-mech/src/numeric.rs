//! Numerical solution of dense linear equations.

pub(crate) mod least_squares;
pub(crate) mod singular_values;

//! Dense linear equations in numbers.

pub(crate) mod least_squares;
pub(crate) mod singular_values;

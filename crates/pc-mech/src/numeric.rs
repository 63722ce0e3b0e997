//! Dense linear algebra and Newton's method, in numbers.

pub(crate) mod dense;
pub(crate) mod least_squares;
pub(crate) mod newton;

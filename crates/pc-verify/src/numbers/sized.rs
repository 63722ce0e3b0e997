//! Values with the sizes of their terms.

/// A value, and the size of the terms of which it is the sum.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sized {
    pub(crate) value: f64,
    pub(crate) size: f64,
}

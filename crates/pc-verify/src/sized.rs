//! Values with the size of the rounding errors in them.

/// A value, and how large the terms are that it is made up of.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Sized {
    pub(crate) value: f64,
    pub(crate) size: f64,
}

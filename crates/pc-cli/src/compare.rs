//! Whether two motions are the same.
//!
//! In go two runs at the same times, out comes a [`Comparison`](comparison::Comparison): for each column that both have,
//! and for each pair of `formula`s, a [`Difference`](difference::Difference). It is printed by `page`; `error` says what
//! cannot be compared, and that motions differ.

pub mod comparison;
pub mod difference;
pub mod error;
pub(crate) mod formula;
pub(crate) mod page;

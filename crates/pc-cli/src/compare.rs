//! Whether two motions are the same.
//!
//! In go two runs at the same times, out comes a [`Comparison`](comparison::Comparison): for each
//! column that both have, and for each pair of `formula`s, a
//! [`Difference`](difference::Difference). `page` prints it; `error` lists what cannot be compared,
//! and is also the result where motions differ.

pub mod comparison;
pub mod difference;
pub mod error;
pub(crate) mod formula;
pub(crate) mod page;

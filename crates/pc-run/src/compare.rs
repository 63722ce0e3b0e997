//! Whether two motions are the same.
//!
//! Two models, each with its options, are [`compared`](compared::Compared), by a `comparison` of the two runs: for each
//! column that both have, and for each pair of `formula`s, a
//! [`Difference`](difference::Difference). `page` prints it; `error` lists what cannot be compared,
//! and is also the result where motions differ.

pub mod compared;
pub mod comparison;
pub mod difference;
pub mod error;
mod formula;
mod page;

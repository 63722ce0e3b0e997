//! Finds out whether two motions are the same.
//!
//! Two models, each with its options, are [`compared`](compared::Compared) by a `comparison` of the two runs, which
//! finds a [`Difference`](difference::Difference) for each column that both have and for each pair of `formula`s.
//! `page` prints the comparison; `error` lists the reasons why motions cannot be compared, and is also the result where
//! they differ.

pub mod compared;
pub mod comparison;
pub mod difference;
pub mod error;
mod formula;
mod page;

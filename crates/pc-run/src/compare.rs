//! Finds out whether two motions are the same.
//!
//! Two models, each with its options, are [`compared`](compared::Compared) by a `comparison` of the two runs, which
//! finds a [`Difference`](difference::Difference) for each column that both have and for each pair of `formula`s. It is judged
//! by the errors of both columns, as far as these are [`known`](known::Known); rows at which `events` have happened in one
//! motion only are left out. `page` prints the comparison, and `table` writes it; `error` lists the reasons why motions cannot be compared, and is
//! also the result where they differ, or where nothing can be told.

pub mod compared;
pub mod comparison;
pub mod difference;
pub mod error;
mod events;
mod formula;
pub mod known;
mod page;
mod table;

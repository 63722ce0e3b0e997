//! Destinations of results: standard output, or a file that is written whole or not at all.
//!
//! A finished run, page or picture becomes bytes at a `destination`; without a file, `standard_output` writes. A `text`
//! and a `table` go to either.
//! Beyond the `size_limit` of the system, nothing can be written.

pub mod destination;
#[cfg(unix)]
pub mod size_limit;
pub mod standard_output;
pub mod table;
pub mod text;

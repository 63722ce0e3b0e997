//! Destinations of results: standard output, or a file that is written whole or not at all.
//!
//! A finished run, page or picture becomes bytes at a `destination`; without a file, `standard_output` writes.

pub mod destination;
pub mod standard_output;

//! Where results go: standard output, or a file that is there whole or not at all.
//!
//! In goes a finished run or its picture, out come bytes at their place. `standard_output` and `atomic` write, the latter
//! files that are replaced whole; `csv`, `json` and `npz` are the formats, and `destination` chooses among all these.

pub(crate) mod atomic;
pub(crate) mod csv;
pub mod destination;
pub(crate) mod json;
pub(crate) mod npz;
pub mod standard_output;

//! Where results go: standard output, or a file that is there whole or not at all.
//!
//! `output` decides, `atomic` replaces files whole, `csv`, `json` and `npz` are the formats.

pub(crate) mod atomic;
pub(crate) mod csv;
pub(crate) mod json;
pub(crate) mod npz;
pub mod output;

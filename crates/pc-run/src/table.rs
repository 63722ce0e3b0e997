//! Tables: each format has one writer for motions, sweeps and linearizations.
//!
//! `rows` are a table as formats see it, `array` is a matrix with a name; `csv`, `json`, `npz`, `parquet` and `mat` are the formats,
//! chosen by the name of a `file`.

pub mod array;
pub mod csv;
pub mod file;
pub(crate) mod json;
pub(crate) mod mat;
pub(crate) mod npz;
#[cfg(feature = "parquet")]
pub(crate) mod parquet;
pub mod rows;

//! Tables: for each format, one writer serves motions, sweeps and linearizations.
//!
//! `rows` is a table as the writers see it, and `array` a matrix with a name; `csv`, `json`, `npz`, `parquet` and `mat` are the
//! formats, which are chosen by the name of a `file`.

pub mod array;
pub mod csv;
pub mod file;
pub(crate) mod json;
pub(crate) mod mat;
pub(crate) mod npz;
#[cfg(feature = "parquet")]
pub(crate) mod parquet;
pub mod rows;

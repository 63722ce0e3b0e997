//! Tables: for each format, one writer serves motions, sweeps and linearizations.
//!
//! `rows` is a table as the writers see it, of which some columns may be `chosen`, and `array` a matrix with a name; `csv`, `json`,
//! `npz`, `parquet` and `mat` write them. A result is `tabulated` in the `format` that is asked for, or given by the name of its
//! `file`.

pub mod array;
pub mod chosen;
pub mod csv;
pub mod file;
pub mod format;
pub(crate) mod json;
pub(crate) mod mat;
pub(crate) mod npz;
#[cfg(feature = "parquet")]
pub(crate) mod parquet;
pub mod rows;
pub mod tabulated;

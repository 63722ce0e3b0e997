//! The table of a sweep as a file, made from its journal with memory independent of the number of
//! members.
//!
//! A journal and the sheet of its rows become a file. `csv`, `json`, `npz` and `parquet` are the formats,
//! `destination` chooses one.

mod csv;
pub(crate) mod destination;
mod json;
mod npz;
#[cfg(feature = "parquet")]
mod parquet;

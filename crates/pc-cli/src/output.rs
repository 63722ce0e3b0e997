//! Destinations of results: standard output, or a file that is written whole or not at all.
//!
//! A finished run or its picture becomes bytes at a destination. A `place` is examined before
//! anything is computed; `atomic` writes there, by a `partial` file that replaces the old one
//! whole; without a place, `standard_output` writes. `rescue` saves a result that cannot be
//! written, and `kept` says where it is. A `stream` takes rows as they are computed. `csv`, `json`
//! and `npz` are the formats, and `destination` chooses among all these.

pub(crate) mod atomic;
pub(crate) mod csv;
pub mod destination;
pub(crate) mod json;
pub mod kept;
pub(crate) mod npz;
pub(crate) mod partial;
pub(crate) mod place;
pub(crate) mod rescue;
pub mod standard_output;
pub(crate) mod stream;

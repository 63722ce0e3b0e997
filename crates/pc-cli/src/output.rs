//! Where results go: standard output, or a file that is there whole or not at all.
//!
//! In goes a finished run or its picture, out come bytes at their place. A `place` is looked at before anything is computed;
//! `atomic` writes there, by a `partial` file that replaces the old one whole, and `standard_output` where there is none. What
//! becomes of a result that cannot be written is in `rescue`, and `kept` says where it is. A `stream` is
//! written while there are rows to come. `csv`, `json` and `npz` are the formats, and `destination` chooses
//! among all these.

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

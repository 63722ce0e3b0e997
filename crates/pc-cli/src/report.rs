//! Reports for readers.
//!
//! The results of a command become lines. `text` formats numbers and lines; `notes` are remarks on
//! constraints, `verification` reports the second derivation, `summary` a run, and `record` is a
//! run for pages and pictures.

pub mod notes;
mod record;
pub mod summary;
pub mod text;
pub mod verification;

//! Reports for readers.
//!
//! The results of a command become lines. `text` formats numbers and lines; `notes` are remarks on constraints,
//! `verification` reports the second derivation, `summary` a run, and `record` is what pages and pictures show of it.

pub mod notes;
mod record;
pub mod summary;
pub mod text;
pub mod verification;

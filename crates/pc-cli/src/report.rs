//! What is said to people.
//!
//! In goes what a command has found, out come lines. `text` sets numbers and lines; `notes` are said of constraints beside the
//! equations, `verification` of the second derivation, `summary` of a run.

pub mod notes;
pub mod summary;
pub mod text;
pub mod verification;

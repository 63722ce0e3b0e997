//! The terminal: who waits for a run.
//!
//! `observer` tells the terminal what a run says, by lines of `text` and by a bar: `progress` of a motion, `progress_of_members` of a
//! sweep. `interrupt` is Ctrl-C.

pub(crate) mod interrupt;
pub(crate) mod observer;
mod progress;
mod progress_of_members;
pub mod text;

//! The terminal: who waits for a run.
//!
//! `observer` tells the terminal what a run says, by lines of `text` and by a bar: `progress` of a motion, `progress_of_members` of a
//! sweep, `progress_of_parts` of a page. `interrupt` is Ctrl-C.

pub(crate) mod interrupt;
pub(crate) mod observer;
mod progress;
mod progress_of_members;
pub(crate) mod progress_of_parts;
pub mod text;

//! The page of `pc live`, which follows the text of a model.
//!
//! ```text
//! connection ─ guard ─► answer ─ request ─┬─ page: the page itself, with an editor
//!                                         ├─ results ─ compute ─► equations, motion, verdicts, a line each
//!                                         ├─ order ─ program ─► what a command prints or writes
//!                                         └─ original: the text is saved
//! ```
//! [`server`] listens on this computer alone; [`guard`] lets in who knows the token. Results are computed in this process, whose
//! [`kept`] equations make a motion follow a slider; commands are run as a user runs them, each as a process of its own.
//! `live/PROTOCOL.md` says what the page and the server say to each other.

mod answer;
mod compute;
mod desk;
mod diagnostics;
mod guard;
mod kept;
mod notebook;
mod order;
mod original;
mod page;
mod program;
mod request;
mod results;
pub(crate) mod server;
mod values;

pub(crate) use desk::Desk;
pub(crate) use original::Original;

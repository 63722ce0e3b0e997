//! `pc check`: whether a model holds together.
//!
//! In goes a model, out comes a report on it. `frame` says what is known of its frame, `integrals` what its motion keeps,
//! `steady` which steady motion is near; `command` puts these together, as text or for programs.

mod combinations;
mod command;
mod frame;
mod integrals;
mod measure;
mod steady;

pub use command::command;

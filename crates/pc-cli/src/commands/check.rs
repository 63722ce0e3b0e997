//! `pc check`: the consistency and the properties of a model.
//!
//! A model gives a report. `frame` describes its frame, `integrals` the conserved quantities, `steady` the nearest
//! steady motion; `command` puts these together, as text or for programs.

mod combinations;
mod command;
mod frame;
mod integrals;
mod measure;
mod steady;

pub use command::command;

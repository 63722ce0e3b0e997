//! The command line, and the model it names.
//!
//! In goes a command line, out come the arguments of a command, and a model. Read `options` first,
//! the arguments shared by commands, with the `forms` of equations; then those of single commands:
//! `sweep`, `report`, `linear`, `compare`, `bench`, `drawn` (pictures), `checkpoint`, `models` and
//! other `tools`. `command_line` is all of them with their `examples`, and `input` turns MODEL into
//! a model and its equations.

pub mod bench;
pub mod checkpoint;
pub mod command_line;
pub mod compare;
pub mod drawn;
mod examples;
pub mod forms;
pub mod input;
pub mod linear;
pub mod models;
pub mod options;
pub mod report;
pub mod sweep;
pub mod tools;

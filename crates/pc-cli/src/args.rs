//! The command line, and the model it names.
//!
//! In goes a command line, out come the arguments of a command, and a model. Read `options` first, the options of the
//! commands with the `forms` of equations, with those of a `sweep` and of a page (`report`), and those for a `checkpoint`; `command_line` is all
//! of them, and `input` turns MODEL into a model and its equations.

pub mod checkpoint;
pub mod command_line;
pub mod forms;
pub mod input;
pub mod options;
pub mod report;
pub mod sweep;

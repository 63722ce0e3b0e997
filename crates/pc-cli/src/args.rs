//! The command line, and the model it names.
//!
//! In goes a command line, out come the arguments of a command, and a model. Read `options` first, the options of the commands,
//! and the `forms` of equations; then the options of a `sweep`, of a page (`report`), of linearizations (`linear`, at the state
//! that `steady` chooses), of a comparison (`compare`) and of measurements (`bench`), those of every `table`, those that say what is `drawn`, those for
//! a `checkpoint`, for `models` and for other `tools` around models; `command_line` has all of them with their `examples`, and
//! `input` turns MODEL into a model and its equations.

pub mod bench;
pub mod checkpoint;
pub mod command_line;
pub mod compare;
pub mod drawn;
mod examples;
pub(crate) mod forms;
pub mod input;
pub mod linear;
pub mod live;
pub mod models;
pub mod options;
pub mod report;
pub mod steady;
pub mod sweep;
pub mod table;
pub mod tools;

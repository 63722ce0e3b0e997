//! What stands on the command line, and the model it leads to.
//!
//! `args` has the commands and their options, `sweep` those of a sweep, `input` makes of MODEL a model and its equations.

pub mod args;
pub mod input;
pub mod sweep;

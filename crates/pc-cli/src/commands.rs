//! The commands, a file each; sweeps have a room of their own.
//!
//! In go the arguments of a command, out comes what it was asked for, or an error. `models` lists those that come with the
//! program, `check` says whether one holds together, `derive` prints its equations, `theory` what can be said of its motions, `run` integrates it, `emit` writes its
//! equations as source, and `import` makes models of files in other formats.

pub mod check;
pub mod derive;
pub mod emit;
pub mod import;
pub mod models;
pub mod run;
pub mod theory;

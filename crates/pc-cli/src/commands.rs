//! The commands, a file each; sweeps have a room of their own.
//!
//! Each takes its arguments and gives a result or an error. `models` lists the built-in models, `check` checks a
//! model, `derive` prints its equations, `theory` the analysis of its motions, `run` integrates it, `report` makes a page of all this, `emit` writes its
//! equations as source, and `import` makes models from files in other formats.

pub mod check;
pub mod derive;
pub mod emit;
pub mod import;
pub mod models;
pub mod report;
pub mod run;
pub mod theory;

//! The commands, a file each.
//!
//! Each takes its arguments and gives a result or an error. `new` begins a model, `schema` is the
//! format for editors, `models` lists the built-in models, `check` checks a model, `derive` prints
//! its equations, `theory` the analysis of its motions, `linearize` the motions near a state,
//! `equilibria` the states of rest, `run` integrates a model, `sweep` many members of one, whose shards `merge` puts together,
//! `compare` compares two motions,
//! `report` makes a page of all this, `emit` writes equations as source, or by `fmu` as an FMU,
//! `bench` measures them, and `import` makes models from files in other formats. `completions`,
//! `man` and `version` are about the program.

pub mod bench;
pub mod check;
pub mod compare;
pub mod completions;
pub mod derive;
pub mod emit;
pub mod equilibria;
pub mod fmu;
pub mod import;
pub mod linearize;
pub mod man;
pub mod merge;
pub mod models;
pub mod new;
pub mod report;
pub mod run;
pub mod schema;
pub mod sweep;
pub mod theory;
pub mod version;

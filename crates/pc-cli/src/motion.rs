//! The computation of a motion, from a plan to a finished run.
//!
//! In go a model and a command line, out comes a [`Run`](run::Run). Read `plan` first, what was asked for, and
//! `memory`, whether its rows have room; `given` integrates it where its rows are written at once, with a `progress` bar, an `interrupt`, and a `checkpoint` now
//! and then, which is known by its `identity` and has a `checkpoint_error`; `fine` is what a picture shows between its rows; `table` and `run` are what comes out.

pub mod checkpoint;
pub mod checkpoint_error;
pub(crate) mod fine;
pub(crate) mod given;
pub(crate) mod identity;
pub(crate) mod interrupt;
pub(crate) mod memory;
pub mod plan;
pub(crate) mod progress;
pub mod run;
pub(crate) mod sensitivities;
pub mod table;

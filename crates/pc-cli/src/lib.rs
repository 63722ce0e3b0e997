//! The program `pc`: check, derive and run text models of mechanical systems.
//!
//! ```text
//! arguments ─ input ─► Model ─ derive, check, theory, emit ─► equations, ranks, integrals, source
//!                            ─ run, sweep, compare, linearize, equilibria ─► by pc_run ─► tables, pictures, summaries
//! ```
//! Each command is a function of its arguments; `main` only dispatches. Results go to standard
//! output or files (`output`), remarks and bars to standard error (`terminal`).
//!
//! # Around it
//!
//! Below: [`pc_run`], what a run is; [`pc_model`], the models; [`pc_print`], [`pc_report`] and [`pc_fmu`], what is written of
//! them. Front pages in the order of reading: [`pc_expr`], [`pc_algebra`], [`pc_mech`],
//! [pc-nonholo](../pc_nonholo/index.html), [pc-analysis](../pc_analysis/index.html), [`pc_solve`].

pub mod error;
mod exit_code;

pub mod args;
pub(crate) mod bench;
pub mod commands;
mod live;
pub mod output;
pub mod terminal;

pub use error::CliError;

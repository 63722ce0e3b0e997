//! The program `pc`: check, derive and run text models of mechanical systems.
//!
//! ```text
//! MODEL ─ input ─► Model ─ derive ─► equations, printed
//!                        ─ check  ─► ranks, residuals, integrals, printed
//!                        ─ sweep  ─► many motions, a Record of each in a Journal ─► CSV, JSON, npz, Parquet
//!                        ─ run    ─► Run: a Table and how it came about
//!                                    ├─ output ─► CSV, JSON, npz
//!                                    ├─ plot   ─► SVG, PNG
//!                                    └─ summary
//! ```
//! Each command is a function of its arguments; `main` only dispatches. What a command computes goes to standard
//! output, what it says about it to standard error.

pub mod args;
pub mod binding;
pub mod check;
pub mod derive;
pub mod emit;
pub mod error;
mod follow;
mod identity;
pub mod input;
mod interrupt;
pub mod models;
pub mod output;
pub mod plan;
pub mod plot;
mod progress;
pub mod run;
pub mod saving;
mod sensitivities;
pub mod summary;
pub mod sweep;
pub mod table;
pub mod text;
pub mod verification;

pub use error::CliError;

//! The program `pc`: check, derive and run text models of mechanical systems.
//!
//! ```text
//! MODEL ─ input ─► Model ─ derive ─► equations, printed
//!                        ─ check  ─► ranks, residuals, integrals, printed
//!                        ─ linearize, equilibria ─► matrices and eigenvalues, printed or in a file
//!                        ─ compare ─► two Runs, and their difference
//!                        ─ sweep  ─► many motions, a Record of each in a Journal ─► CSV, JSON, npz, Parquet
//!                        ─ run    ─► Run: a Table and a record of the integration
//!                                    ├─ output ─► CSV, JSON, npz
//!                                    ├─ plot   ─► SVG, PNG, PDF
//!                                    └─ summary
//! ```
//! Each command is a function of its arguments; `main` only dispatches. Results go to standard
//! output, remarks to standard error.
//!
//! # Around it
//!
//! Below: [`pc_model`], the models; [`pc_print`], [`pc_report`] and [`pc_fmu`], what is written of
//! them; [`pc_solve`], the motions; [`pc_analysis`], their analysis. Front pages in the order of
//! reading: [`pc_expr`], [`pc_algebra`], [`pc_mech`], [`pc_nonholo`], [`pc_analysis`],
//! [`pc_solve`].

pub mod error;
mod exit_code;

pub mod args;
pub(crate) mod bench;
pub mod commands;
pub mod output;
pub mod terminal;

pub use error::CliError;

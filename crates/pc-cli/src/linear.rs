//! Linearizations and equilibria of a model, for people and for programs.
//!
//! `ground` makes a linearizer of a model with its start; `pc_analysis` computes, and this folder
//! only shows the results. A linearization becomes `text`, `json`, or arrays of numbers (`arrays`)
//! in a file (`file`, with `mat` for one of its formats); `locus` is the table of eigenvalues over
//! a parameter, `found` the list of equilibria. `error` lists the errors.

pub(crate) mod arrays;
pub mod error;
pub(crate) mod file;
pub(crate) mod found;
pub(crate) mod ground;
pub(crate) mod json;
pub(crate) mod locus;
mod mat;
pub(crate) mod text;

//! Linearizations and equilibria of a model, for people and for programs.
//!
//! A model becomes a linearizer with its start (`ground`), by which `pc_analysis` computes at the state that is asked for, also with other values
//! (`near`); here is only what is said of it. A linearization becomes `text`, `json`, or arrays of numbers (`arrays`) in a file (`file`, with `mat` for one of its formats);
//! `compared` has its matrices compared with a second derivation, and `locus` is the table of eigenvalues over a parameter, `found` the list of equilibria. `error` lists the errors.

pub(crate) mod arrays;
pub(crate) mod compared;
pub mod error;
pub(crate) mod file;
pub(crate) mod found;
pub(crate) mod ground;
pub(crate) mod json;
pub(crate) mod locus;
mod mat;
pub(crate) mod near;
pub(crate) mod text;

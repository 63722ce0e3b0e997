//! Linearizations and equilibria of a model, for people and for programs.
//!
//! A model becomes a linearizer with a start (`linearizable`), which `pc_analysis` uses at the requested `state`, and also with other values
//! (`near`). A single linearization is `linearized`, which is printed as `text` or `json`; `compared` compares its matrices with a second
//! derivation. `locus` is the table of eigenvalues against a parameter, `locus_picture` its picture, `found` the list of equilibria, and `trim` a state of rest or
//! steady motion that is found by choosing inputs. `arrays` contains the numbers of all these, and `output` writes them to files; `error`
//! lists the errors.

mod arrays;
pub(crate) mod compared;
pub mod error;
pub mod found;
mod json;
pub(crate) mod linearizable;
pub mod linearized;
pub mod locus;
pub mod locus_picture;
pub(crate) mod near;
mod output;
pub mod state;
mod text;
pub mod trim;

//! Linearizations and equilibria of a model, for people and for programs.
//!
//! A model becomes a linearizer with its start (`ground`), by which `pc_analysis` computes at the `state` that is asked for, also with other
//! values (`near`). One linearization is `linearized`, printed as `text` or `json`; `compared` has its matrices compared with a second
//! derivation. `locus` is the table of eigenvalues over a parameter, `found` the list of equilibria, `trim` a state of rest or steady
//! motion by the choice of inputs. `arrays` are their numbers, and `output`
//! writes files; `error` lists the errors.

mod arrays;
mod compared;
pub mod error;
pub mod found;
pub(crate) mod ground;
mod json;
pub mod linearized;
pub mod locus;
pub(crate) mod near;
mod output;
pub mod state;
mod text;
pub mod trim;

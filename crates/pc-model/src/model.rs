//! A model, ready to be asked for its equations.
//!
//! `model` is what a document becomes, `start` the start of a motion with other values than those of the file,
//! `builtin` the models that come with the library.

pub(crate) mod builtin;
pub(crate) mod model;
pub(crate) mod start;

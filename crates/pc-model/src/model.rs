//! A model: a document with the values of its parameters, and errors put at their places in it.
//!
//! In goes a [`Document`](crate::Document), out comes a [`Model`](model::Model) that can be asked for its equations.
//! Read `model` first; `blame` finds the place in the file to which an error of the derivation belongs, `start` begins
//! the motion at other values than those of the file, `given` and `choices` are quasi-velocities that are asked for beside those of the text, `builtin` are the models that come with the library.

pub(crate) mod blame;
pub(crate) mod builtin;
pub(crate) mod choices;
pub(crate) mod given;
pub(crate) mod model;
pub(crate) mod start;

//! Models: documents with values of their parameters, and errors located in them.
//!
//! A [`Document`](crate::Document) becomes a [`Model`](model::Model), from which equations are derived. Read
//! `model` first; `blame` finds the entry in the file that causes an error of the derivation, `start_values` changes
//! the start values, `given` and `choices` handle quasi-velocities requested in addition to those of the text,
//! `stored` is a model as it is written to files, `builtin` contains the models that come with the library, and `tags` groups them by keywords.

pub(crate) mod blame;
pub(crate) mod builtin;
pub(crate) mod choices;
pub(crate) mod given;
pub(crate) mod model;
pub(crate) mod start_values;
pub(crate) mod stored;
pub(crate) mod tags;

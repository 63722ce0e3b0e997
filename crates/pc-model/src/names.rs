//! Names and expressions of a model, resolved to expressions of a graph.
//!
//! `scope` knows what a name stands for at its place; `definitions` are resolved in their order.

pub(crate) mod definitions;
pub(crate) mod scope;

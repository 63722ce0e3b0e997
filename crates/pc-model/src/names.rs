//! Names and expressions of a model, resolved to expressions of a graph.
//!
//! In goes an expression of the text, out comes one of the graph. Read `stage` first, what an expression may contain by the
//! place where it stands; `scope` knows what a name stands for there, `functions` what a function does, and `definitions`
//! are resolved in their order; `points` of bodies with joints follow from how these move.

pub(crate) mod definitions;
pub(crate) mod functions;
pub(crate) mod points;
pub(crate) mod scope;
pub(crate) mod stage;

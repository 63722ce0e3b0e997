//! Names and expressions of a model, resolved to expressions of a graph.
//!
//! An expression of the text becomes one of the graph. Read `stage` first, which names an expression may
//! contain, depending on its place; `scope` gives the meaning of a name there, `functions` that of a
//! function, `rates` that of derivatives with respect to time, and `definitions` are resolved in their
//! order; `points` of bodies with joints are functions of the coordinates.

pub(crate) mod definitions;
pub(crate) mod functions;
pub(crate) mod points;
pub(crate) mod rates;
pub(crate) mod scope;
pub(crate) mod stage;

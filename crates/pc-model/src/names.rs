//! Names and expressions of a model, resolved to expressions of a graph.
//!
//! An expression in the text becomes an expression in the graph. Read `stage` first: which names an
//! expression may contain, depending on its place in the text. `scope` gives the meaning of a name in that
//! place, `functions` and `declared` the meaning of a function, and `rates` the meaning of derivatives with respect to time;
//! `definitions` resolves definitions in their order; `points` expresses points of bodies with joints as
//! functions of the coordinates, `body_motion` the motion of a body, `contacts` where a body touches a plane, and `momenta` what bodies that are `moving` have: mass
//! centre, momentum, energy.

pub(crate) mod body_motion;
pub(crate) mod contacts;
pub(crate) mod declared;
pub(crate) mod definitions;
pub(crate) mod functions;
pub(crate) mod momenta;
pub(crate) mod moving;
pub(crate) mod points;
pub(crate) mod rates;
pub(crate) mod scope;
pub(crate) mod stage;

//! The printed content of the equations.
//!
//! The equations of an assembled model are `derived` in a `form`, by a `principle`, and turned into a `sheet`: kinematics, brackets,
//! equations, energy, with the `operations` they cost, the `reactions` and the kinds of their `constraints`.

pub(crate) mod constraints;
pub(crate) mod derived;
pub(crate) mod form;
pub(crate) mod operations;
pub(crate) mod principle;
pub(crate) mod reactions;
pub(crate) mod sheet;

//! The printed content of the equations.
//!
//! The equations of an assembled model are `derived` in a `form` and turned into a `sheet`: kinematics, brackets,
//! equations, energy, with the `operations` they cost and the kinds of their `constraints`.

pub(crate) mod constraints;
pub(crate) mod derived;
pub(crate) mod form;
pub(crate) mod operations;
pub(crate) mod sheet;

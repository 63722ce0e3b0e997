//! The printed content of the equations.
//!
//! A `form` of an assembled model is `derived`, and becomes a `sheet`: kinematics, brackets, equations, energy, with the `operations` that they cost and
//! the kinds of `constraints`.

pub(crate) mod constraints;
pub(crate) mod derived;
pub(crate) mod form;
pub(crate) mod operations;
pub(crate) mod sheet;

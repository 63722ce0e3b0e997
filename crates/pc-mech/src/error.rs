//! Errors of mechanical systems.
//!
//! `mech`: the error of the crate, with its predicates. One file per topic, in the order of a
//! derivation: `shape`, `frame`, `lagrangian`, `body`, `tree`, `force`, `constraint`, `integral`,
//! `matrix`, `evaluation`. `lists`: names and states in their messages.

pub(crate) mod body;
pub(crate) mod constraint;
pub(crate) mod evaluation;
pub(crate) mod force;
pub(crate) mod frame;
pub(crate) mod integral;
pub(crate) mod lagrangian;
mod lists;
pub(crate) mod matrix;
pub(crate) mod mech;
pub(crate) mod shape;
pub(crate) mod tree;

pub use body::BodyError;
pub use constraint::ConstraintError;
pub use evaluation::EvaluationError;
pub use force::ForceError;
pub use frame::FrameError;
pub use integral::IntegralError;
pub use lagrangian::LagrangianError;
pub use matrix::MatrixError;
pub use mech::MechError;
pub use shape::ShapeError;
pub(crate) use shape::shape;
pub use tree::TreeError;

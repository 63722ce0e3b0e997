//! Settings of an integration, to which errors refer: `nonlinear_solver`, `tolerance` and
//! `inequality`, and the `options` that contain them.

pub(crate) mod inequality;
pub(crate) mod nonlinear_solver;
pub(crate) mod options;
pub(crate) mod tolerance;

//! Derivatives of a motion with respect to its start and to parameters, and gradients of
//! functionals of it.
//!
//! CVODES integrates the derivatives, or an explicit method does so with the equations of variation
//! as part of its state (`explicit`). `solve` returns them as a `trajectory` in one call,
//! `forward_output` during an integration. `adjoint` integrates backwards for the gradient of a
//! `functional`, with `adjoint_options`: `adjoint_pass` goes through the pieces of the motion, each
//! a `motion_record`, and `adjoint_field` holds the equations, with the help of a `transpose`.

pub(crate) mod adjoint;
pub(crate) mod adjoint_field;
pub(crate) mod adjoint_options;
pub(crate) mod adjoint_pass;
pub(crate) mod explicit;
pub(crate) mod forward_output;
pub(crate) mod functional;
pub(crate) mod motion_record;
pub(crate) mod solve;
pub(crate) mod trajectory;
pub(crate) mod transpose;

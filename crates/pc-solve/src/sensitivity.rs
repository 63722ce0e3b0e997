//! Derivatives of a motion with respect to its start and to parameters, and gradients of
//! functionals of the motion.
//!
//! Either CVODES integrates the derivatives, or an explicit method does, with the derivatives as
//! part of its state (`explicit`). In one call, `solve` returns them as a `trajectory`; during an
//! integration, `forward_output` gives them. `adjoint` integrates backwards to find the gradient of
//! a `functional`, with `adjoint_options`: `adjoint_pass` goes through the pieces of the motion,
//! each a `motion_record`, and `adjoint_field` holds the equations, with the help of a `transpose`.

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

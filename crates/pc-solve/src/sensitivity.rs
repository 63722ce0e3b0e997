//! Derivatives of a motion by its start and by parameters, and gradients of functionals of it.
//!
//! CVODES integrates the derivatives, or DOP853 with the equations of variation in its state (`explicit`), returned as a `trajectory`, in one call by `solve`, or by `forward_output`. `adjoint`
//! integrates backwards for the gradient of a `functional`, with `adjoint_options`: `adjoint_pass`
//! goes through the pieces of the motion, each a `motion_record`, and `adjoint_field` holds the
//! equations, by a `transpose`.

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

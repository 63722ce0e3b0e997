//! Derivatives of a motion by its start and by parameters, and gradients of functionals of it.
//!
//! In go `options`, which derivatives; `forward` integrates them along with the motion by `variation`, with `trajectory`
//! coming out. `adjoint` goes backwards for a gradient, with `adjoint_field`. `linearisation` is ∂f/∂y by whatever the
//! field offers.

pub(crate) mod saltation;

pub(crate) mod adjoint;
pub(crate) mod adjoint_field;
pub(crate) mod adjoint_pass;
pub(crate) mod forward;
pub(crate) mod forward_output;
pub(crate) mod linearisation;
pub(crate) mod options;
pub(crate) mod trajectory;
pub(crate) mod transpose;
pub(crate) mod variation;

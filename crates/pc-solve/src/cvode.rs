//! SUNDIALS CVODES, safe to hold and to call.
//!
//! `context`, `handles`, `return_code` and `callback` are the boundary to C: owned objects, codes as errors, vector
//! fields as callbacks. `cvode` is the integration step by step, made by `setup`, with `interpolation`, `dense` and
//! `quadrature` inside its steps, `breaks` and `foresight` where the field is not smooth in time, `restart` and
//! `checkpoint` to go on.

pub(crate) mod breaks;
pub(crate) mod callback;
pub(crate) mod context;
pub(crate) mod cvode;
pub(crate) mod foresight;
pub(crate) mod handles;
pub(crate) mod interpolation;
pub(crate) mod quadrature;
pub(crate) mod restart;
pub(crate) mod return_code;
pub(crate) mod setup;
pub(crate) mod stepper;

//! A safe interface to SUNDIALS CVODES.
//!
//! `context`, `handles` and `callback` are the boundary to C: owned objects, vector fields as callbacks. `options` are
//! its options, `cvode` is the integration step by step, made by `setup`, with `interpolation`, `projection` and
//! `quadrature_callbacks` inside its steps, and `integrals` computed as a `quadrature`; `breaks` and `foresee`, by
//! `foresight`, handle fields that are not smooth in time; `restart` continues after jumps; `statistics` counts the
//! work. `stepper` makes it a method, `integration` begins an integration by it. `linear` are its linear systems,
//! `forward` its sensitivities. `version` names the library.

pub(crate) mod breaks;
pub(crate) mod callback;
pub(crate) mod context;
pub(crate) mod cvode;
pub(crate) mod foresee;
pub(crate) mod foresight;
pub(crate) mod forward;
pub(crate) mod handles;
pub(crate) mod integrals;
pub(crate) mod integration;
pub(crate) mod interpolation;
pub(crate) mod linear;
pub(crate) mod projection;
pub(crate) mod quadrature;
pub(crate) mod quadrature_callbacks;
pub(crate) mod restart;
pub(crate) mod setup;
pub(crate) mod statistics;
pub(crate) mod stepper;
pub(crate) mod version;

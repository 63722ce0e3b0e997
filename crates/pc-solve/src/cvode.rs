//! A safe interface to SUNDIALS CVODES.
//!
//! `context`, `handles` and `callback` form the boundary with C: owned objects, vector fields as
//! callbacks. `cvode` makes steps; `setup` constructs the method, `interpolation` and `projection`
//! give states inside steps; `integrals` are computed as a `quadrature`, through the
//! `quadrature_callbacks`; `breaks` and `foresee`, with `foresight`, handle fields that are not
//! smooth in time; `restart` continues after jumps; `statistics` counts the work. `stepper`
//! implements the interface of a method, and `integration` starts an integration with CVODES.
//! `linear` solves the linear systems of the method, `forward` its equations of variation.
//! `version` gives the version of the library.

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
mod operations;
pub(crate) mod projection;
pub(crate) mod quadrature;
pub(crate) mod quadrature_callbacks;
pub(crate) mod restart;
pub(crate) mod setup;
pub(crate) mod statistics;
pub(crate) mod stepper;
pub(crate) mod version;

//! The C interface to the Poincaré–Chetaev equations: opaque handles over the models of [`pc_model`].
//!
//! Nothing is exported yet.

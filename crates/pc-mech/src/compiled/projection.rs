//! States brought back to where the motion stays.
//!
//! `constraint_manifold` is the surface on which constraints hold, with conditions that follow (`followers`) and states
//! some components of which are prescribed (`holding`); `integrals` are first integrals that are kept.

pub(crate) mod constraint_manifold;
pub(crate) mod followers;
pub(crate) mod holding;
pub(crate) mod integrals;

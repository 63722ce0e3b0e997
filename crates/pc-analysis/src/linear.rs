//! The motions near a state, to first order.
//!
//! Equations of motion in independent quasi-velocities, and the [`Leaf`](linearizer::Leaf) on which a motion
//! stays, give matrices. Read `leaf` first (which coordinates are independent); `linearizer` evaluates the
//! derivatives (those of reactions with `reactions`), `linearization` combines them; `second_order` writes them as M q̈ + G q̇ + K q = F u and
//! `modes` finds eigenvectors. `root_locus` follows eigenvalues over a parameter (`assignment` pairs them),
//! `equilibria` searches a box for equilibria, `trim` chooses inputs and parts of a state so that it is one.

pub(crate) mod assignment;
pub(crate) mod equilibria;
pub(crate) mod leaf;
pub(crate) mod linearization;
pub(crate) mod linearizer;
pub(crate) mod modes;
pub(crate) mod reactions;
pub(crate) mod root_locus;
pub(crate) mod second_order;
pub(crate) mod trim;

//! The motions near a state, to first order in the deviations from it.
//!
//! The matrices are computed from equations of motion in independent quasi-velocities, or with multipliers, and the
//! [`Leaf`](linearizer::Leaf) on which a motion stays. Read `leaf` first, which selects independent coordinates; `linearizer` evaluates
//! the derivatives, those of reactions using `reactions`; `statics` has the conditions of steady motion, which `search`
//! solves near a state, and `linearization` combines the derivatives there; `second_order` writes the equations as M q̈ + G q̇ + K q = F u and
//! `modes` finds eigenvectors. `root_locus` follows eigenvalues as a parameter varies (`assignment` pairs them),
//! `equilibria` searches a box for equilibria, and `trim` chooses inputs and components of the state so that the state
//! is an equilibrium. `units` says how a state is measured.

pub(crate) mod assignment;
pub(crate) mod conserved;
pub(crate) mod equilibria;
pub(crate) mod family;
pub(crate) mod leaf;
pub(crate) mod linearization;
pub(crate) mod linearizer;
pub(crate) mod modes;
pub(crate) mod reactions;
pub(crate) mod root_locus;
pub(crate) mod search;
pub(crate) mod second_order;
pub(crate) mod statics;
pub(crate) mod trim;
pub(crate) mod units;

//! The motions near a state, to first order.
//!
//! In: equations of motion in independent quasi-velocities, and the [`Leaf`](linearizer::Leaf) on which a motion stays. Out:
//! matrices. Read `leaf` first, what coordinates are independent; `linearizer` evaluates the derivatives, `linearization` puts
//! them together; `second_order` writes them as M q̈ + G q̇ + K q = F u and `modes` finds eigenvectors. `root_locus` follows
//! eigenvalues over a parameter (`assignment` pairs them), `equilibria` looks for all equilibria in a box.

pub(crate) mod assignment;
pub(crate) mod equilibria;
pub(crate) mod leaf;
pub(crate) mod linearization;
pub(crate) mod linearizer;
pub(crate) mod modes;
pub(crate) mod root_locus;
pub(crate) mod second_order;

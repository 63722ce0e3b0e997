//! The linear systems (I − γ ∂f/∂y) x = b of Newton's iteration, and who solves them.
//!
//! `linear` says which solvers there are, `choice` takes one. Direct ones are `dense`, `band` and `sparse` with
//! `sparse_lu` (made known to SUNDIALS by `direct`), and `quotients` for Jacobians that are not given; `krylov` iterates,
//! with a `preconditioner`. `handles` own SUNDIALS' objects.

pub(crate) mod band;
pub(crate) mod choice;
pub(crate) mod dense;
pub(crate) mod direct;
pub(crate) mod handles;
pub(crate) mod krylov;
pub(crate) mod linear;
pub(crate) mod preconditioner;
pub(crate) mod quotients;
pub(crate) mod sparse;
pub(crate) mod sparse_lu;

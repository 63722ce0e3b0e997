//! The linear systems (I − γ ∂f/∂y) x = b of Newton's iteration, and who solves them.
//!
//! `solver` says which there are, with `krylov` and its `preconditioner`; `choice` takes one, and `linear` gives it to
//! CVODES. Direct ones are `dense`, `band` and `sparse` with `sparse_lu` (made known to SUNDIALS by `direct`), and
//! `quotient_jacobian`, of `quotients`, where the Jacobian is not given; `gmres` iterates. `work` is what the callbacks
//! keep, `handles` own SUNDIALS' objects.

pub(crate) mod band;
pub(crate) mod choice;
pub(crate) mod dense;
pub(crate) mod direct;
pub(crate) mod gmres;
pub(crate) mod handles;
pub(crate) mod krylov;
pub(crate) mod linear;
pub(crate) mod preconditioner;
pub(crate) mod quotient_jacobian;
pub(crate) mod quotients;
pub(crate) mod solver;
pub(crate) mod sparse;
pub(crate) mod sparse_lu;
pub(crate) mod work;

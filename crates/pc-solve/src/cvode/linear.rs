//! The linear systems (I − γ ∂f/∂y) x = b of Newton's iteration, and their solvers.
//!
//! `solver` lists them, with `krylov` and its `preconditioner`; `choice` selects one, and `linear`
//! attaches it to CVODES. Direct solvers are `dense`, `band` and `sparse` with `sparse_lu`
//! (registered with SUNDIALS by `direct`); where no Jacobian is given, `quotient_jacobian` computes
//! it from `quotients`; `gmres` is iterative. `work` is the data of the callbacks, `handles` owns
//! the objects of SUNDIALS.

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

//! Solves M w = r, symbolically or numerically.
//!
//! `cost` estimates, from the zeros of M, which of the two is cheaper. `symbolic` writes M⁻¹ out, using
//! `symbolic_ldl`; `numeric` factorises at each state, using `dense_ldl`. Under constraints, w includes
//! multipliers and the matrix is that of a `saddle_point` problem, which `solver` solves; for a tree with
//! loops, `schur` solves joint by joint. `columns` leaves out zeros, `products` are the columns of the Jacobian of a
//! large tree, `observed` the derivatives of the observables, `pivots` checks that no pivot vanishes, `prologue` computes
//! once what depends on parameters alone.

pub(crate) mod columns;
pub(crate) mod cost;
pub(crate) mod dense_ldl;
pub(crate) mod numeric;
pub(crate) mod observed;
pub(crate) mod pivots;
pub(crate) mod products;
pub(crate) mod prologue;
pub(crate) mod saddle_point;
pub(crate) mod schur;
pub(crate) mod solver;
pub(crate) mod symbolic;
pub(crate) mod symbolic_ldl;

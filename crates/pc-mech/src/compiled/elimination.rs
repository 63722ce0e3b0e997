//! M w = r solved, in expressions or in numbers.
//!
//! `cost` finds from the zeros of M which is cheaper. `symbolic` writes M⁻¹ out by `symbolic_ldl`; `numeric` factorises
//! at each state by `dense_ldl`. Under constraints w has multipliers and the matrix is a saddle point's: `saddle_point`,
//! by `solver`; of a tree with loops `schur` solves, joint after joint. `columns` leaves out zeros, `pivots` watches that the
//! choice of pivots stays sound, `prologue` computes once what parameters alone determine.

pub(crate) mod columns;
pub(crate) mod cost;
pub(crate) mod dense_ldl;
pub(crate) mod numeric;
pub(crate) mod pivots;
pub(crate) mod prologue;
pub(crate) mod saddle_point;
pub(crate) mod schur;
pub(crate) mod solver;
pub(crate) mod symbolic;
pub(crate) mod symbolic_ldl;

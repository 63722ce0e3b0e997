//! Our direct linear solvers, each wrapped as a `SUNLinearSolver`.

use std::ffi::c_int;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::slice;

use sundials_sys as sys;

use super::handles::{Matrix, Solver};
use crate::cvode::context::Context;
use crate::cvode::handles::numbers_of;
use crate::error::SolveError;

const SUCCESS: c_int = 0;
/// The return code of `SUNLinSolSetup` for a failure that a shorter step, and hence a smaller γ,
/// may avoid.
const SINGULAR: c_int = sys::SUNLS_LUFACT_FAIL as c_int;
/// The return code of `SUNLinSolSolve` for a failure that a shorter step may avoid.
const NOT_SOLVED: c_int = sys::SUNLS_PACKAGE_FAIL_REC as c_int;
const FATAL: c_int = -1;

/// The matrix has no inverse.
#[derive(Debug)]
pub(super) struct Singular;

/// The factors of a matrix whose entries change while its address stays the same.
pub(super) trait Factors {
    /// Factorises `matrix`, in place or not.
    ///
    /// # Safety
    /// `matrix` is the one for which the factors were made, and nothing else uses it.
    unsafe fn factorise(&mut self, matrix: sys::SUNMatrix) -> Result<(), Singular>;

    /// Replaces b by x with A x = b.
    ///
    /// # Safety
    /// As for [`factorise`](Factors::factorise), which has succeeded; `matrix` has not changed
    /// since.
    unsafe fn solve(&mut self, matrix: sys::SUNMatrix, b: &mut [f64]) -> Result<(), Singular>;
}

/// A solver that uses `factors`, for `matrix` only.
pub(super) fn solver<S: Factors>(
    context: &mut Context,
    _matrix: &Matrix,
    factors: S,
) -> Result<Solver, SolveError> {
    // SAFETY: the context is live.
    let raw = unsafe { sys::SUNLinSolNewEmpty(context.raw()) };
    let raw = context.check_new("SUNLinSolNewEmpty", raw)?;
    // SAFETY: the solver is live and ours alone, and so is its table of operations.
    unsafe {
        let solver = &mut *raw.as_ptr();
        solver.content = Box::into_raw(Box::new(factors)).cast();
        let operations = &mut *solver.ops;
        operations.gettype = Some(kind);
        operations.setup = Some(setup::<S>);
        operations.solve = Some(solve::<S>);
        operations.free = Some(free::<S>);
    }
    Ok(Solver::from_raw(raw))
}

unsafe extern "C" fn kind(_solver: sys::SUNLinearSolver) -> sys::SUNLinearSolver_Type {
    sys::SUNLinearSolver_Type_SUNLINEARSOLVER_DIRECT
}

unsafe extern "C" fn setup<S: Factors>(solver: sys::SUNLinearSolver, matrix: sys::SUNMatrix) -> c_int {
    // SAFETY: the content is an `S`, which nobody else uses during a call of CVODES.
    let factors = unsafe { &mut *(*solver).content.cast::<S>() };
    // Unwind safe: after a panic, which would be a bug in the factorisation, the integration ends.
    // SAFETY: CVODES gives the matrix that the solver was set with.
    match catch_unwind(AssertUnwindSafe(|| unsafe { factors.factorise(matrix) })) {
        Ok(Ok(())) => SUCCESS,
        Ok(Err(Singular)) => SINGULAR,
        Err(_) => FATAL,
    }
}

unsafe extern "C" fn solve<S: Factors>(
    solver: sys::SUNLinearSolver,
    matrix: sys::SUNMatrix,
    x: sys::N_Vector,
    b: sys::N_Vector,
    _tolerance: f64,
) -> c_int {
    // SAFETY: the content is an `S`, which nobody else uses during a call of CVODES.
    let factors = unsafe { &mut *(*solver).content.cast::<S>() };
    // SAFETY: both are live serial vectors of the same length; they are distinct.
    let (x, b) = unsafe {
        let len = sys::N_VGetLength(x) as usize;
        let x = slice::from_raw_parts_mut(numbers_of(x), len);
        (x, slice::from_raw_parts(numbers_of(b), len))
    };
    x.copy_from_slice(b);
    // SAFETY: CVODES gives the matrix that it has set the solver up with.
    match catch_unwind(AssertUnwindSafe(|| unsafe { factors.solve(matrix, x) })) {
        Ok(Ok(())) if x.iter().all(|value| value.is_finite()) => SUCCESS,
        Ok(_) => NOT_SOLVED,
        Err(_) => FATAL,
    }
}

unsafe extern "C" fn free<S: Factors>(solver: sys::SUNLinearSolver) -> sys::SUNErrCode {
    // SAFETY: the content was made by `Box::into_raw` and is owned by the solver, which is freed
    // with it.
    unsafe {
        drop(Box::from_raw((*solver).content.cast::<S>()));
        sys::SUNLinSolFreeEmpty(solver);
    }
    SUCCESS
}

//! Owning handles of matrices and linear solvers.
//!
//! Each frees its object when dropped and must be dropped before its [`Context`].

use std::ptr::NonNull;

use sundials_sys as sys;

use crate::cvode::context::Context;
use crate::cvode::handles::Vector;
use crate::error::SolveError;

/// An n × n `SUNMatrix`.
pub(super) struct Matrix(NonNull<sys::_generic_SUNMatrix>);

impl Matrix {
    pub(super) fn dense(context: &mut Context, n: usize) -> Result<Self, SolveError> {
        let n = n as sys::sunindextype;
        // SAFETY: the context is live.
        let raw = unsafe { sys::SUNDenseMatrix(n, n, context.raw()) };
        context.check_new("SUNDenseMatrix", raw).map(Matrix)
    }

    /// A band matrix with `lower` < n diagonals below the main one and `upper` < n above it.
    pub(super) fn band(
        context: &mut Context,
        n: usize,
        lower: usize,
        upper: usize,
    ) -> Result<Self, SolveError> {
        let [n, lower, upper] = [n, lower, upper].map(|number| number as sys::sunindextype);
        // SAFETY: the context is live.
        let raw = unsafe { sys::SUNBandMatrix(n, upper, lower, context.raw()) };
        context.check_new("SUNBandMatrix", raw).map(Matrix)
    }

    /// Takes ownership of a matrix of another kind.
    pub(super) fn from_raw(raw: NonNull<sys::_generic_SUNMatrix>) -> Self {
        Matrix(raw)
    }

    pub(super) fn raw(&self) -> sys::SUNMatrix {
        self.0.as_ptr()
    }
}

impl Drop for Matrix {
    fn drop(&mut self) {
        // SAFETY: the matrix is owned.
        unsafe { sys::SUNMatDestroy(self.0.as_ptr()) };
    }
}

/// A `SUNLinearSolver`.
pub(super) struct Solver(NonNull<sys::_generic_SUNLinearSolver>);

impl Solver {
    pub(super) fn dense(context: &mut Context, y: &Vector, matrix: &Matrix) -> Result<Self, SolveError> {
        // SAFETY: all three are live and of one context; only the sizes of `y` and `matrix` are
        // read.
        let raw = unsafe { sys::SUNLinSol_Dense(y.raw(), matrix.raw(), context.raw()) };
        context.check_new("SUNLinSol_Dense", raw).map(Solver)
    }

    pub(super) fn band(context: &mut Context, y: &Vector, matrix: &Matrix) -> Result<Self, SolveError> {
        // SAFETY: all three are live and of one context; only the sizes of `y` and `matrix` are
        // read.
        let raw = unsafe { sys::SUNLinSol_Band(y.raw(), matrix.raw(), context.raw()) };
        context.check_new("SUNLinSol_Band", raw).map(Solver)
    }

    /// Takes ownership of a solver of another kind.
    pub(super) fn from_raw(raw: NonNull<sys::_generic_SUNLinearSolver>) -> Self {
        Solver(raw)
    }

    pub(super) fn raw(&self) -> sys::SUNLinearSolver {
        self.0.as_ptr()
    }
}

impl Drop for Solver {
    fn drop(&mut self) {
        // SAFETY: the linear solver is owned.
        unsafe { sys::SUNLinSolFree(self.0.as_ptr()) };
    }
}

//! Dense matrices.

use std::ffi::{c_int, c_void};
use std::slice;

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::lu::partial_pivoting::{factor, solve};
use faer::perm::PermRef;
use faer::{MatMut, MatRef, Par};
use pc_expr::{Failure, VectorField};
use sundials_sys as sys;

use super::direct::{self, Factors, Singular};
use super::handles::{Matrix, Solver};
use crate::cvode::callback::{Callbacks, nan_slice};
use crate::cvode::context::Context;
use crate::cvode::handles::{Vector, numbers_of};
use crate::error::{NonFinite, SolveError};

/// The number of components from which the blocked factorisation is used. In interleaved
/// measurements, this factorisation takes 1/4 of the time that SUNDIALS takes at 64 components, 1/5
/// at 100, 1/8 at 200 and 1/25 at 400; a solve takes 1/1.4, 1/1.7, 1/2 and 1/3; below about 20
/// components the factorisation of SUNDIALS is faster.
const BLOCKED_FROM: usize = 64;

/// The solver for a dense `matrix`.
pub(super) fn solver(context: &mut Context, y: &Vector, matrix: &Matrix) -> Result<Solver, SolveError> {
    let dim = y.as_slice().len();
    if dim < BLOCKED_FROM {
        return Solver::dense(context, y, matrix);
    }
    let request = factor::lu_in_place_scratch::<usize, f64>(dim, dim, Par::Seq, Default::default())
        .or(solve::solve_in_place_scratch::<usize, f64>(dim, 1, Par::Seq));
    let blocked = Blocked { rows: vec![0; dim], rows_inverse: vec![0; dim], memory: MemBuffer::new(request) };
    direct::solver(context, matrix, blocked)
}

/// Factorises P A = L U in place, in blocks of columns.
struct Blocked {
    rows: Vec<usize>,
    rows_inverse: Vec<usize>,
    memory: MemBuffer,
}

impl Factors for Blocked {
    unsafe fn factorise(&mut self, matrix: sys::SUNMatrix) -> Result<(), Singular> {
        let dim = self.rows.len();
        // SAFETY: the matrix is dense, dim × dim, column-major and contiguous, and ours during the
        // call.
        let entries = unsafe { slice::from_raw_parts_mut(sys::SUNDenseMatrix_Data(matrix), dim * dim) };
        factor::lu_in_place(
            MatMut::from_column_major_slice_mut(entries, dim, dim),
            &mut self.rows,
            &mut self.rows_inverse,
            Par::Seq,
            MemStack::new(&mut self.memory),
            Default::default(),
        );
        let pivots = (0..dim).map(|i| entries[i + i * dim]);
        if pivots.into_iter().any(|pivot| pivot == 0.0 || !pivot.is_finite()) {
            Err(Singular)
        } else {
            Ok(())
        }
    }

    unsafe fn solve(&mut self, matrix: sys::SUNMatrix, b: &mut [f64]) -> Result<(), Singular> {
        let dim = self.rows.len();
        // SAFETY: as in `factorise`.
        let entries = unsafe { slice::from_raw_parts(sys::SUNDenseMatrix_Data(matrix), dim * dim) };
        let factors = MatRef::from_column_major_slice(entries, dim, dim);
        solve::solve_in_place(
            factors,
            factors,
            PermRef::new_checked(&self.rows, &self.rows_inverse, dim),
            MatMut::from_column_major_slice_mut(b, dim, 1),
            Par::Seq,
            MemStack::new(&mut self.memory),
        );
        Ok(())
    }
}

impl<F: VectorField> Callbacks<F> {
    fn jacobian(&mut self, t: f64, y: &[f64], jacobian: &mut [f64]) -> c_int {
        let dim = self.dim;
        self.guard(|field, offset| {
            let y = offset.map_or(y, |offset| offset.state_of(y));
            field.jacobian(t, y, jacobian)?;
            match jacobian.iter().position(|entry| !entry.is_finite()) {
                None => Ok(()),
                Some(k) => Err(Failure::recoverable(NonFinite::Jacobian {
                    row: field.component_name(k % dim),
                    column: field.component_name(k / dim),
                    value: jacobian[k],
                    t,
                })),
            }
        })
    }
}

/// `CVLsJacFn`.
///
/// # Safety
/// Called by CVODES with the address of a [`UserData<F>`](crate::cvode::callback::UserData), a
/// vector of its dimension and a dense square matrix.
pub(super) unsafe extern "C" fn jacobian<F: VectorField>(
    t: f64,
    y: sys::N_Vector,
    _ydot: sys::N_Vector,
    matrix: sys::SUNMatrix,
    user_data: *mut c_void,
    _tmp1: sys::N_Vector,
    _tmp2: sys::N_Vector,
    _tmp3: sys::N_Vector,
) -> c_int {
    // SAFETY: the address is of a live `Callbacks<F>`, which nobody else uses during a call of
    // CVODES.
    let callbacks = unsafe { &mut *user_data.cast::<Callbacks<F>>() };
    // SAFETY: `y` is a live serial vector of length `dim`; `matrix` is dense, dim × dim,
    // column-major and contiguous.
    let (y, matrix) = unsafe {
        let y = slice::from_raw_parts(numbers_of(y), callbacks.dim);
        (y, nan_slice(sys::SUNDenseMatrix_Data(matrix), callbacks.dim * callbacks.dim))
    };
    callbacks.jacobian(t, y, matrix)
}

//! Band matrices.

use std::ffi::{c_int, c_void};
use std::slice;

use pc_expr::VectorField;
use sundials_sys as sys;

use crate::cvode::callback::Callbacks;
use crate::cvode::handles::numbers_of;

/// A `CVLsJacFn` that writes the field's sparse Jacobian.
///
/// # Safety
/// Called by CVODES with the address of a [`UserData<F>`](crate::cvode::callback::UserData), a
/// vector of its dimension and a band matrix that contains the field's pattern.
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
    // SAFETY: `y` is a live serial vector of length `dim`; the columns of a band matrix are stored
    // one after the other, `ldim` numbers each, with the entry of the diagonal at `diagonal`, and
    // CVODES has set them to 0.
    let (y, ldim, diagonal, data) = unsafe {
        let ldim = sys::SUNBandMatrix_LDim(matrix) as usize;
        let data = slice::from_raw_parts_mut(sys::SUNBandMatrix_Data(matrix), ldim * callbacks.dim);
        let y = slice::from_raw_parts(numbers_of(y), callbacks.dim);
        (y, ldim, sys::SUNBandMatrix_StoredUpperBandwidth(matrix) as usize, data)
    };
    callbacks.entries(t, y, |(i, j), value, _| data[j * ldim + diagonal + i - j] = value)
}

//! The callback for the equations of variation.

use std::ffi::{c_int, c_void};
use std::slice;

use pc_expr::VectorField;
use sundials_sys as sys;

use crate::cvode::callback::{Callbacks, nan_slice};
use crate::cvode::handles::numbers_of;

/// `CVSensRhsFn`.
///
/// # Safety
/// Called by CVODES with the address of a [`UserData<F>`](crate::cvode::callback::UserData) whose
/// variation has `count` columns, and with vectors of its dimension.
pub(crate) unsafe extern "C" fn rates<F: VectorField>(
    count: c_int,
    t: f64,
    y: sys::N_Vector,
    _ydot: sys::N_Vector,
    columns: *mut sys::N_Vector,
    rates: *mut sys::N_Vector,
    user_data: *mut c_void,
    _tmp1: sys::N_Vector,
    _tmp2: sys::N_Vector,
) -> c_int {
    // SAFETY: the address is of a live `Callbacks<F>`, which nobody else uses during a call of
    // CVODES.
    let callbacks = unsafe { &mut *user_data.cast::<Callbacks<F>>() };
    let (dim, count) = (callbacks.dim, usize::try_from(count).unwrap_or(0));
    // SAFETY: `y` is a live serial vector of length `dim`, the others are arrays of `count`
    // vectors.
    let (y, columns, rates) = unsafe {
        let y = slice::from_raw_parts(numbers_of(y), dim);
        (y, slice::from_raw_parts(columns, count), slice::from_raw_parts(rates, count))
    };
    let columns = columns.iter().zip(rates).map(|(&s, &rate)| {
        // SAFETY: all are live serial vectors of length `dim`, and the rates distinct from all
        // others.
        unsafe {
            let s = slice::from_raw_parts(numbers_of(s), dim);
            (s, nan_slice(numbers_of(rate), dim))
        }
    });
    let mut variation = std::mem::take(&mut callbacks.variation);
    let answer = callbacks.guard(|field, offset| {
        let y = offset.map_or(y, |offset| offset.state_of(y));
        variation.rates(field, t, y, columns)
    });
    callbacks.variation = variation;
    answer
}

//! Motions as functions of time.

use std::ffi::c_uint;

use pc_solve::{DenseOutput, InputError, SolveError};

use crate::api::solver::{integrate, pc_solver};
use crate::ffi::boundary::entry;
use crate::ffi::call_error::CallError;
use crate::ffi::error::pc_error;
use crate::ffi::pointer::{clear, free, handle, room, write};
use crate::ffi::status::pc_status;
use crate::machinery::engine::Integration;

/// A motion as a function of time. It never changes, so any number of threads may use it. Free it
/// with pc_dense_free.
pub struct pc_dense {
    motion: DenseOutput,
    dim: usize,
}

/// Writes the derivative of y of the given order, 0 for y itself, at a time in the last internal
/// step, from the polynomial of the method, whose degree is the order of that step. The step
/// extends from step_time − last_step to step_time of pc_statistics, but not beyond an event; there
/// is no such step before the first step or just after a reset. y satisfies the constraints; its
/// derivatives are those of the polynomial.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_solver_interpolate(
    solver: *mut pc_solver,
    t: f64,
    derivative: c_uint,
    y: *mut f64,
    y_length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let interpolate = |integration: &mut Integration, dim: usize| {
        // SAFETY: null or room for `y_length` numbers, as the preamble demands.
        let y = unsafe { room(y, y_length, dim, "y") }?;
        y.copy_from_slice(integration.interpolate(t, derivative)?);
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { integrate(solver, error, interpolate) }
}

/// Integrates to the time t, which must differ from that of the solver, as pc_solver_advance
/// does, and records the motion from the previous time of the solver on; this takes (order + 2) ×
/// dim numbers for each internal step. `dense` is also made when PC_EVENT or PC_STOPPED is
/// returned; it then ends where the integration ended.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_solver_run_dense(
    solver: *mut pc_solver,
    t: f64,
    dense: *mut *mut pc_dense,
    error: *mut *mut pc_error,
) -> pc_status {
    let run = |integration: &mut Integration, dim: usize| {
        let (motion, ending) = integration.run_dense(t)?;
        let made = Box::new(pc_dense { motion, dim });
        // SAFETY: null or memory for a handle, as the preamble demands.
        unsafe { write(dense, Box::into_raw(made), "dense") }?;
        integration.ended(ending)
    };
    let checked = || {
        // SAFETY: as the preamble demands.
        unsafe { clear(dense, "dense") }
    };
    // SAFETY: `error` is null or memory for a pointer.
    match unsafe { entry(error, checked) } {
        // SAFETY: as the preamble demands.
        pc_status::PC_OK => unsafe { integrate(solver, error, run) },
        refused => refused,
    }
}

/// Computes a value of the motion at a time: the state, or its rate.
type Value = fn(&DenseOutput, f64) -> Result<Vec<f64>, InputError>;

/// Writes this value at t.
///
/// # Safety
/// `dense` is null or a live handle, `y` is null or points to memory for `y_length` numbers, and
/// `error` is null or points to memory for a pointer.
unsafe fn at(
    dense: *const pc_dense,
    value: Value,
    t: f64,
    (y, y_length): (*mut f64, usize),
    error: *mut *mut pc_error,
) -> pc_status {
    let evaluate = || {
        // SAFETY: as promised.
        let dense = unsafe { handle(dense, "dense") }?;
        // SAFETY: as promised.
        let y = unsafe { room(y, y_length, dense.dim, "y") }?;
        let value = value(&dense.motion, t).map_err(SolveError::from)?;
        y.copy_from_slice(&value);
        Ok::<(), CallError>(())
    };
    // SAFETY: as promised.
    unsafe { entry(error, evaluate) }
}

/// Writes y(t). At an event this is the state after the event, except at the very end of the
/// motion, where it is the limit from before. Inside a step the state deviates from the constraints
/// by the error of a step; pc_system_project moves it onto the constraints.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_dense_eval(
    dense: *const pc_dense,
    t: f64,
    y: *mut f64,
    y_length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    // SAFETY: as the preamble demands.
    unsafe { at(dense, DenseOutput::evaluate, t, (y, y_length), error) }
}

/// Writes the rate of y at t. The rate may jump by the error of a step where one step meets the
/// next.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_dense_rate(
    dense: *const pc_dense,
    t: f64,
    ydot: *mut f64,
    ydot_length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    // SAFETY: as the preamble demands.
    unsafe { at(dense, DenseOutput::derivative, t, (ydot, ydot_length), error) }
}

/// The length of the state; 0 for NULL.
#[unsafe(no_mangle)]
pub extern "C" fn pc_dense_dim(dense: Option<&pc_dense>) -> usize {
    dense.map_or(0, |dense| dense.dim)
}

/// The time at which the motion begins; NaN for NULL.
#[unsafe(no_mangle)]
pub extern "C" fn pc_dense_t_begin(dense: Option<&pc_dense>) -> f64 {
    span(dense).0
}

/// The time at which the motion ends, which precedes its beginning if the motion runs backwards in
/// time; NaN for NULL.
#[unsafe(no_mangle)]
pub extern "C" fn pc_dense_t_end(dense: Option<&pc_dense>) -> f64 {
    span(dense).1
}

fn span(dense: Option<&pc_dense>) -> (f64, f64) {
    dense.and_then(|dense| dense.motion.span()).unwrap_or((f64::NAN, f64::NAN))
}

/// Frees a motion. NULL is allowed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_dense_free(dense: *mut pc_dense) {
    // SAFETY: null or a handle of ours that nobody uses any more.
    unsafe { free(dense) };
}

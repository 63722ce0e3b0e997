//! A solver between its steps: another start, a function that follows the steps, errors.

use std::ffi::{c_int, c_void};

use crate::api::solver::{integrate, pc_solver};
use crate::ffi::call_error::CallError;
use crate::ffi::error::pc_error;
use crate::ffi::pointer::{apart, numbers, room};
use crate::ffi::status::pc_status;
use crate::ffi::user_data::{User, pc_destroy};
use crate::machinery::engine::Integration;
use crate::machinery::watch::Monitor;

/// Receives the end (t, y) of each internal step, or of the part of a step before an event, where
/// y is the state before the event; the order of the method in this step, and the length of the
/// step, with the sign of the direction. It may lie beyond the time to which the call integrates.
/// Returns 0 to continue; anything else ends the call with PC_STOPPED. Otherwise it is like
/// pc_observer.
pub type pc_monitor = Option<
    unsafe extern "C" fn(
        t: f64,
        y: *const f64,
        y_length: usize,
        order: c_int,
        step: f64,
        user: *mut c_void,
    ) -> c_int,
>;

/// Puts a solver at the state y and the time t, as a new solver would be that pc_solver_new makes
/// with the same options: the method, the statistics, the counts of events and the integrals that
/// are kept begin anew, and either direction of time may follow. Events that were added,
/// observers, sensitivities with their starts, and the parameters that the solver has, stay.
/// After a failure the solver is as it was.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_solver_reset(
    solver: *mut pc_solver,
    t: f64,
    y: *const f64,
    y_length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let reset = |integration: &mut Integration, dim: usize| {
        // SAFETY: null or `y_length` numbers, as the preamble demands.
        let y = unsafe { numbers(y, y_length, dim, "y") }?;
        Ok(integration.reset(t, y)?)
    };
    // SAFETY: as the preamble demands.
    unsafe { integrate(solver, error, reset) }
}

/// Sets the function that is called after each internal step from now on, in all calls that
/// integrate, on their thread, in place of the previous one; NULL for none. It follows the work
/// of the method, shows progress, or stops the integration; it does not change the steps.
/// `destroy`, unless NULL, is called with `user` exactly once: by this call if it fails or
/// `monitor` is NULL, else when another monitor takes its place or the solver is freed. `destroy`
/// must not use the solver while the solver is being freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_solver_set_monitor(
    solver: *mut pc_solver,
    monitor: pc_monitor,
    user: *mut c_void,
    destroy: pc_destroy,
    error: *mut *mut pc_error,
) -> pc_status {
    let user = User { data: user, destroy };
    let mut unused = monitor.map(|function| Monitor { function, user });
    let exchange = |integration: &mut Integration, _: usize| {
        std::mem::swap(&mut integration.monitor, &mut unused);
        Ok(())
    };
    // SAFETY: as the preamble demands.
    let status = unsafe { integrate(solver, error, exchange) };
    // Dropped once the solver is no longer in use: `destroy` may call functions on it.
    drop(unused);
    status
}

/// Writes what the error test of the last internal step compared, at its end: the weights 1/(rtol
/// |y_i| + atol_i) of the components, and the estimated local errors e_i. A step is accepted if
/// the root mean square of the products is at most 1. Each of the two arrays has the length of
/// the state; one that is NULL, of length 0, is left out. PC_ADAMS, PC_BDF and the BDF steps of
/// PC_AUTO have estimates of each component; for other steps the errors are refused with
/// PC_UNSUPPORTED. Before the first step they are refused with PC_INVALID_ARGUMENT.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_solver_errors(
    solver: *const pc_solver,
    weights: *mut f64,
    weights_length: usize,
    errors: *mut f64,
    errors_length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let read = |integration: &mut Integration, dim: usize| {
        if weights_length == dim && errors_length == dim {
            apart((weights, dim, "weights"), (errors, dim, "errors"))?;
        }
        if !(weights.is_null() && weights_length == 0) {
            // SAFETY: room for `weights_length` numbers, as the preamble demands.
            let weights = unsafe { room(weights, weights_length, dim, "weights") }?;
            integration.error_weights(weights);
        }
        if !(errors.is_null() && errors_length == 0) {
            // SAFETY: room for `errors_length` numbers, as the preamble demands.
            let errors = unsafe { room(errors, errors_length, dim, "errors") }?;
            const NONE: CallError = CallError::Unsupported {
                what: "an estimate of the error of each component",
                why: "the method of the last step has none; PC_ADAMS and PC_BDF do",
            };
            errors.copy_from_slice(integration.local_errors()?.ok_or(NONE)?);
        }
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { integrate(solver, error, read) }
}

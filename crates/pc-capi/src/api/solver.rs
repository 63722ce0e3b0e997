//! Integration.

use std::ffi::{CString, c_int, c_void};
use std::ops::ControlFlow;
use std::sync::Mutex;

use pc_expr::Events;
use pc_solve::Checkpoint;

use crate::api::options::{pc_solver_options, take};
use crate::ffi::boundary::entry;
use crate::ffi::call_error::CallError;
use crate::ffi::error::pc_error;
use crate::ffi::pointer::{clear, free, handle, numbers, room, write};
use crate::ffi::status::pc_status;
use crate::ffi::strings::c_string;
use crate::machinery::engine::Integration;
use crate::machinery::event_set::Followed;
use crate::machinery::exclusive::Exclusive;
use crate::machinery::system::{Inner, Inventory, inside, pc_system};

/// An integration, with its current time and state. Free it with pc_solver_free.
pub struct pc_solver {
    pub(crate) inner: Exclusive<Integration>,
    pub(crate) dim: usize,
    /// Names of the events, which may be read while an observer runs.
    pub(crate) event_names: Mutex<Vec<CString>>,
}

impl pc_solver {
    pub(crate) fn boxed(integration: Integration, events: &Followed, dim: usize) -> *mut pc_solver {
        let names = events.events().iter().map(|event| c_string(event.name())).collect();
        let inner = Exclusive::new(integration);
        Box::into_raw(Box::new(pc_solver { inner, dim, event_names: Mutex::new(names) }))
    }
}

/// Receives the state at each output time. Returns 0 to continue; anything else ends the run
/// with PC_STOPPED. It may call any function on other handles, and must return normally: no
/// exceptions, no longjmp.
pub type pc_observer =
    Option<unsafe extern "C" fn(t: f64, y: *const f64, y_length: usize, user: *mut c_void) -> c_int>;

/// Makes a solver that integrates the system from the state y at the time t, with its current
/// parameters, or from the start of the model if y is NULL, of length 0; t is then ignored.
/// `options` may be NULL. Projection after each step keeps states on the constraints, and the
/// integrals of pc_model_keep at their values at this start. The events of the model are followed:
/// where one occurs, the state is reset as the model says, and a terminal event ends the call with
/// PC_EVENT.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_solver_new(
    system: *const pc_system,
    options: *const pc_solver_options,
    t: f64,
    y: *const f64,
    y_length: usize,
    solver: *mut *mut pc_solver,
    error: *mut *mut pc_error,
) -> pc_status {
    let new = |inventory: &Inventory, inner: &mut Inner| {
        let dim = inventory.dim();
        // SAFETY: null or options, as the preamble demands.
        let options = unsafe { take(options, "options")?.options(dim, inventory.deadline()) }?;
        let (t, y) = if y.is_null() && y_length == 0 {
            inventory.start()
        } else {
            // SAFETY: `y_length` numbers, as the preamble demands.
            (t, unsafe { numbers(y, y_length, dim, "y") }?)
        };
        inner.field.prepare(options.method());
        let events = Followed::new(inner.events.clone());
        let integration =
            Integration::new(inner.field.clone(), &Checkpoint::start(t, y), options, events.clone())?;
        let made = pc_solver::boxed(integration, &events, dim);
        // SAFETY: null or memory for a handle, as the preamble demands.
        unsafe { write(solver, made, "solver") }
    };
    let checked = || {
        // SAFETY: as the preamble demands.
        unsafe { clear(solver, "solver") }
    };
    // SAFETY: `error` is null or memory for a pointer.
    match unsafe { entry(error, checked) } {
        // SAFETY: as the preamble demands.
        pc_status::PC_OK => unsafe { inside(system, error, new) },
        refused => refused,
    }
}

/// Frees a solver. NULL is allowed. It does nothing when called from an observer or function of
/// this solver.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_solver_free(solver: *mut pc_solver) {
    // SAFETY: null or a live handle, as the preamble demands.
    if unsafe { solver.as_ref() }.is_none_or(|solver| solver.inner.close()) {
        // SAFETY: null or a handle of ours that nobody uses any more.
        unsafe { free(solver) };
    }
}

/// Calls `body` with the integration and the length of its state.
///
/// # Safety
/// `solver` is null or a live handle, and `error` is null or points to memory for a pointer.
pub(crate) unsafe fn integrate(
    solver: *const pc_solver,
    error: *mut *mut pc_error,
    body: impl FnOnce(&mut Integration, usize) -> Result<(), CallError>,
) -> pc_status {
    let body = || {
        // SAFETY: as promised.
        let solver = unsafe { handle(solver, "solver") }?;
        body(&mut *solver.inner.take()?, solver.dim)
    };
    // SAFETY: as promised.
    unsafe { entry(error, body) }
}

/// Makes a solver continue with the current parameters and inputs of the system: it restarts
/// at its current state, at order 1. This is how inputs change between two calls of
/// pc_solver_advance. The system must be that of the solver, or one of the same model. Returns
/// PC_UNSUPPORTED if the solver has events added by pc_solver_add_event.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_solver_take_parameters(
    solver: *mut pc_solver,
    system: *const pc_system,
    error: *mut *mut pc_error,
) -> pc_status {
    let mut values = Vec::new();
    let read = |_: &Inventory, inner: &mut Inner| {
        values.extend_from_slice(inner.field.parameters());
        Ok(())
    };
    // SAFETY: as the preamble demands.
    match unsafe { inside(system, error, read) } {
        pc_status::PC_OK => {}
        refused => return refused,
    }
    let set = |integration: &mut Integration, _: usize| integration.set_parameters(&values);
    // SAFETY: as the preamble demands.
    unsafe { integrate(solver, error, set) }
}

/// Integrates to the time t, in the direction of the first step, and writes the state there.
/// When PC_EVENT or PC_STOPPED is returned, it is the state where the integration ended, and
/// pc_solver_time gives the time; the next call continues from there. After a failure
/// pc_solver_time and pc_solver_state give the time and state that were reached. PC_LIMIT is such a
/// failure; it is due to the time limit or the pc_cancel of the system's options.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_solver_advance(
    solver: *mut pc_solver,
    t: f64,
    y: *mut f64,
    y_length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let advance = |integration: &mut Integration, dim: usize| {
        // SAFETY: null or room for `y_length` numbers, as the preamble demands.
        let y = unsafe { room(y, y_length, dim, "y") }?;
        let ending = integration.advance(t)?;
        y.copy_from_slice(integration.state());
        integration.ended(ending)
    };
    // SAFETY: as the preamble demands.
    unsafe { integrate(solver, error, advance) }
}

/// Takes one internal step in the direction of `towards`, or the part of it before an event, and
/// writes the time at its end, which may lie beyond `towards`, and the state there; both are also
/// written when PC_EVENT or PC_STOPPED is returned.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_solver_step(
    solver: *mut pc_solver,
    towards: f64,
    t: *mut f64,
    y: *mut f64,
    y_length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let step = |integration: &mut Integration, dim: usize| {
        if t.is_null() {
            return Err(CallError::Null { what: "t" });
        }
        // SAFETY: the pointers are as the preamble demands.
        let y = unsafe { room(y, y_length, dim, "y") }?;
        let ending = integration.step(towards)?;
        y.copy_from_slice(integration.state());
        // SAFETY: as the preamble demands.
        unsafe { write(t, integration.time(), "t") }?;
        integration.ended(ending)
    };
    // SAFETY: as the preamble demands.
    unsafe { integrate(solver, error, step) }
}

/// Integrates through the times, which increase or decrease throughout, and calls `observer`
/// at each with the state, which is valid during the call, and with `user`. Returns PC_STOPPED if
/// the observer stops it. At the time of an event the observer receives the state after the event;
/// at a terminal event the observer is called for the last time, and PC_EVENT is returned.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_solver_run(
    solver: *mut pc_solver,
    times: *const f64,
    times_length: usize,
    observer: pc_observer,
    user: *mut c_void,
    error: *mut *mut pc_error,
) -> pc_status {
    let run = |integration: &mut Integration, _: usize| {
        // SAFETY: null or `times_length` numbers, as the preamble demands.
        let times = unsafe { numbers(times, times_length, times_length, "times") }?;
        let observer = observer.ok_or(CallError::Null { what: "observer" })?;
        let output = |t: f64, y: &[f64]| {
            // SAFETY: the observer is a function of that type, as the preamble demands.
            match unsafe { observer(t, y.as_ptr(), y.len(), user) } {
                0 => ControlFlow::Continue(()),
                _ => ControlFlow::Break(()),
            }
        };
        let ending = integration.run(times, output)?;
        integration.ended(ending)
    };
    // SAFETY: as the preamble demands.
    unsafe { integrate(solver, error, run) }
}

/// Writes the current time of the integration.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_solver_time(
    solver: *const pc_solver,
    t: *mut f64,
    error: *mut *mut pc_error,
) -> pc_status {
    // SAFETY: as the preamble demands.
    unsafe { integrate(solver, error, |integration, _| write(t, integration.time(), "t")) }
}

/// Writes the current state of the integration.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_solver_state(
    solver: *const pc_solver,
    y: *mut f64,
    y_length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let state = |integration: &mut Integration, dim: usize| {
        // SAFETY: null or room for `y_length` numbers, as the preamble demands.
        unsafe { room(y, y_length, dim, "y") }?.copy_from_slice(integration.state());
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { integrate(solver, error, state) }
}

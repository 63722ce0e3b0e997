//! The events that a solver follows: their occurrences, and events defined by the program.

use std::ffi::{CString, c_char, c_int, c_void};
use std::sync::{MutexGuard, PoisonError};

use pc_expr::Event;

use crate::api::events::direction;
use crate::api::solver::{integrate, pc_solver};
use crate::ffi::call_error::CallError;
use crate::ffi::error::pc_error;
use crate::ffi::pointer::{apart, handle, room, text, write};
use crate::ffi::status::pc_status;
use crate::ffi::strings::{c_string, nth};
use crate::ffi::user_data::{User, pc_destroy};
use crate::machinery::engine::Integration;
use crate::machinery::event_set::Own;
use crate::machinery::watch::Observer;

/// Receives each event where it occurs, by its number among the events of the solver, with the
/// states before and after it, which are valid during the call. Each of several simultaneous events
/// is given with the state that it found and the state that it left. Returns 0 to continue;
/// anything else ends the call with PC_STOPPED, or with PC_EVENT where the event is terminal.
/// Otherwise it is like pc_observer.
pub type pc_event_observer = Option<
    unsafe extern "C" fn(
        event: usize,
        t: f64,
        before: *const f64,
        after: *const f64,
        y_length: usize,
        user: *mut c_void,
    ) -> c_int,
>;

/// Writes g(t, y), which passes through zero where the event occurs. Returns 0; anything else
/// ends the integration with PC_INTEGRATION, as does a value that is not finite or not
/// written. It should depend only on its arguments and be smooth. It must return normally: no
/// exceptions, no longjmp.
pub type pc_event_function = Option<
    unsafe extern "C" fn(t: f64, y: *const f64, y_length: usize, value: *mut f64, user: *mut c_void) -> c_int,
>;

/// Turns the state y before the event into the state after it. Otherwise it is like
/// pc_event_function.
pub type pc_event_reset =
    Option<unsafe extern "C" fn(t: f64, y: *mut f64, y_length: usize, user: *mut c_void) -> c_int>;

/// Sets the observer that is called for each event from now on, in place of the previous one; NULL
/// for none. `user` must stay valid until another observer is set or the solver is freed. The
/// observer is called during the calls that integrate, on their thread.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_solver_observe_events(
    solver: *mut pc_solver,
    observer: pc_event_observer,
    user: *mut c_void,
    error: *mut *mut pc_error,
) -> pc_status {
    // SAFETY: as the preamble demands.
    unsafe { observe(solver, observer, User { data: user, destroy: None }, error) }
}

/// The same as pc_solver_observe_events, with a `user` that the solver owns. `destroy`, unless
/// NULL, is called with `user` exactly once: by this call if it fails or `observer` is NULL, else
/// when another observer takes its place or the solver is freed. `destroy` must not use the solver
/// while the solver is being freed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_solver_set_event_observer(
    solver: *mut pc_solver,
    observer: pc_event_observer,
    user: *mut c_void,
    destroy: pc_destroy,
    error: *mut *mut pc_error,
) -> pc_status {
    // SAFETY: as the preamble demands.
    unsafe { observe(solver, observer, User { data: user, destroy }, error) }
}

/// # Safety
/// As the preamble demands.
unsafe fn observe(
    solver: *mut pc_solver,
    observer: pc_event_observer,
    user: User,
    error: *mut *mut pc_error,
) -> pc_status {
    let mut unused = observer.map(|function| Observer { function, user });
    let exchange = |integration: &mut Integration, _: usize| {
        std::mem::swap(&mut integration.record.observer, &mut unused);
        Ok(())
    };
    // SAFETY: as promised.
    let status = unsafe { integrate(solver, error, exchange) };
    // Dropped once the solver is no longer in use: `destroy` may call functions on it.
    drop(unused);
    status
}

/// Follows an event of your program, numbered after those of the model and those added before: it
/// occurs where `function` passes through zero in the given direction, a pc_direction. There
/// `reset`, unless NULL, changes the state, which is then projected onto the constraints; if
/// `terminal` is not 0 the event ends the call with PC_EVENT. The call must be made before the
/// first step. `name` is for messages.
///
/// `destroy`, unless NULL, is called with `user` exactly once: by this call if it fails, else by
/// pc_solver_free. `destroy` must not use the solver.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_solver_add_event(
    solver: *mut pc_solver,
    name: *const c_char,
    direction: c_int,
    terminal: c_int,
    function: pc_event_function,
    reset: pc_event_reset,
    user: *mut c_void,
    destroy: pc_destroy,
    error: *mut *mut pc_error,
) -> pc_status {
    let user = User { data: user, destroy };
    let add = |integration: &mut Integration, _: usize| {
        // SAFETY: null or text, as the preamble demands.
        let name = unsafe { text(name, "name") }?;
        let (direction, _) = self::direction(direction)?;
        let function = function.ok_or(CallError::Null { what: "function" })?;
        let event = Event::new(name).direction(direction).terminal(terminal != 0).resetting(reset.is_some());
        integration.add(event, Own { name: name.to_owned(), function, reset, user })?;
        // SAFETY: a live handle: it has given the integration.
        names(unsafe { handle(solver, "solver") }?).push(c_string(name));
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { integrate(solver, error, add) }
}

fn names(solver: &pc_solver) -> MutexGuard<'_, Vec<CString>> {
    // Nothing fails while it is locked.
    solver.event_names.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The number of events that a solver follows: those of the model, then those added; 0 for NULL.
#[unsafe(no_mangle)]
pub extern "C" fn pc_solver_event_count(solver: Option<&pc_solver>) -> usize {
    solver.map_or(0, |solver| names(solver).len())
}

/// The name of an event, counted from 0; NULL beyond the last.
#[unsafe(no_mangle)]
pub extern "C" fn pc_solver_event_name(solver: Option<&pc_solver>, index: usize) -> *const c_char {
    solver.map_or(std::ptr::null(), |solver| nth(&names(solver), index))
}

/// Writes the number of times an event has occurred since the solver was made.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_solver_event_occurrences(
    solver: *const pc_solver,
    event: usize,
    occurrences: *mut u64,
    error: *mut *mut pc_error,
) -> pc_status {
    let read = |integration: &mut Integration, _: usize| {
        let counts = &integration.record.counts;
        let Some(&number) = counts.get(event) else { return Err(no_such(event, counts.len())) };
        // SAFETY: null or memory for a number, as the preamble demands.
        unsafe { write(occurrences, number, "occurrences") }
    };
    // SAFETY: as the preamble demands.
    unsafe { integrate(solver, error, read) }
}

fn no_such(event: usize, count: usize) -> CallError {
    CallError::Index { what: "the events", index: event, count }
}

/// Writes when an event last occurred, and the states before and after. Returns PC_NOT_FOUND if it
/// has not occurred. Only the last occurrence is recorded; an observer sees all of them. `before`
/// and `after` may be NULL, of length 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_solver_last_occurrence(
    solver: *const pc_solver,
    event: usize,
    t: *mut f64,
    before: *mut f64,
    before_length: usize,
    after: *mut f64,
    after_length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let read = |integration: &mut Integration, dim: usize| {
        let last = &integration.record.last;
        let Some(last) = last.get(event) else { return Err(no_such(event, last.len())) };
        if before_length == dim && after_length == dim {
            apart((before, dim, "before"), (after, dim, "after"))?;
        }
        let skipped = |state: *mut f64, length: usize| state.is_null() && length == 0;
        let place = |state: *mut f64, length: usize, what| {
            let dim = if skipped(state, length) { 0 } else { dim };
            // SAFETY: null or room for `length` numbers, as the preamble demands; the two share no memory.
            unsafe { room(state, length, dim, what) }
        };
        let (before, after) = (place(before, before_length, "before")?, place(after, after_length, "after")?);
        let Some(last) = last else {
            // SAFETY: a live handle: it has given the integration.
            let name = nth(&names(unsafe { handle(solver, "solver") }?), event);
            // SAFETY: the name of an existing event.
            return Err(CallError::NotOccurred { name: unsafe { text(name, "name") }?.to_owned() });
        };
        before.copy_from_slice(&last.state_before[..before.len()]);
        after.copy_from_slice(&last.state_after[..after.len()]);
        // SAFETY: null or memory for a number, as the preamble demands.
        unsafe { write(t, last.time, "t") }
    };
    // SAFETY: as the preamble demands.
    unsafe { integrate(solver, error, read) }
}

/// Writes the number of the terminal event that ended the last call that integrated; returns
/// PC_NOT_FOUND if none did.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_solver_terminal_event(
    solver: *const pc_solver,
    event: *mut usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let read = |integration: &mut Integration, _: usize| {
        let number = integration.record.terminal.ok_or(CallError::NotEnded)?;
        // SAFETY: null or memory for a number, as the preamble demands.
        unsafe { write(event, number, "event") }
    };
    // SAFETY: as the preamble demands.
    unsafe { integrate(solver, error, read) }
}

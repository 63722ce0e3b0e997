//! Events of a model: how they are declared call by call, and evaluated for an integrator of the
//! program.

use std::ffi::{c_char, c_int};

use pc_expr::{Direction, Event, Events};

use crate::api::builder::draft;
use crate::api::model::pc_model;
use crate::api::rates::{State, Target, slices};
use crate::ffi::call_error::CallError;
use crate::ffi::error::pc_error;
use crate::ffi::pointer::{numbers, room, text};
use crate::ffi::status::pc_status;
use crate::machinery::draft::{Draft, Section, quoted};
use crate::machinery::system::{Inner, Inventory, Room, count, inside, name, pc_system};

/// The direction in which the function of an event passes through zero, along the integration.
#[repr(C)]
pub enum pc_direction {
    /// From above.
    PC_FALLING = -1,
    /// Either way.
    PC_BOTH = 0,
    /// From below.
    PC_RISING = 1,
}

/// The direction that a number denotes, and its name in the text.
pub(crate) fn direction(value: c_int) -> Result<(Direction, &'static str), CallError> {
    match value {
        -1 => Ok((Direction::Falling, "falling")),
        0 => Ok((Direction::Both, "both")),
        1 => Ok((Direction::Rising, "rising")),
        value => Err(CallError::Choice { what: "pc_direction", value: value.into() }),
    }
}

/// Adds an event, which occurs where the expression `when` passes through zero in the given
/// direction, a pc_direction. If `terminal` is not 0, the event ends an integration with PC_EVENT.
/// Simultaneous events are handled in the order in which they were added.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_add_event(
    model: *mut pc_model,
    name: *const c_char,
    when: *const c_char,
    direction: c_int,
    terminal: c_int,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, as the preamble demands.
        let (name, when) = unsafe { (text(name, "name")?, text(when, "when")?) };
        let (_, direction) = self::direction(direction)?;
        draft.add(Section::Events, &[name, "when"], quoted(when));
        draft.add(Section::Events, &[name, "direction"], quoted(direction));
        draft.add(Section::Events, &[name, "terminal"], (terminal != 0).to_string());
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_add_event", write) }
}

/// Adds a reset to an event: where the event occurs, the coordinate, quasi-velocity or
/// velocity `x'` called `variable` takes the value of the expression. All resets of an event take
/// effect together and use the state before the event.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_add_event_reset(
    model: *mut pc_model,
    event: *const c_char,
    variable: *const c_char,
    expression: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, as the preamble demands.
        let (event, variable, expression) =
            unsafe { (text(event, "event")?, text(variable, "variable")?, text(expression, "expression")?) };
        draft.add_reset(event, variable, quoted(expression))
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_add_event_reset", write) }
}

/// The number of events of the model; 0 for NULL.
#[unsafe(no_mangle)]
pub extern "C" fn pc_system_event_count(system: Option<&pc_system>) -> usize {
    count(system, |inventory| inventory.events.len())
}

/// The name of an event, counted from 0; NULL beyond the last.
#[unsafe(no_mangle)]
pub extern "C" fn pc_system_event_name(system: Option<&pc_system>, index: usize) -> *const c_char {
    name(system, index, |inventory| &inventory.event_names)
}

/// The direction of an event, a pc_direction; PC_BOTH beyond the last. These are the numbers that
/// CVODE's CVodeSetRootDirection takes.
#[unsafe(no_mangle)]
pub extern "C" fn pc_system_event_direction(system: Option<&pc_system>, index: usize) -> c_int {
    of_event(system, index, |event| match event.crosses() {
        Direction::Falling => -1,
        Direction::Both => 0,
        Direction::Rising => 1,
    })
}

/// Returns 1 if an event ends the integration, else 0.
#[unsafe(no_mangle)]
pub extern "C" fn pc_system_event_is_terminal(system: Option<&pc_system>, index: usize) -> c_int {
    of_event(system, index, |event| event.is_terminal().into())
}

/// Returns 1 if an event resets the state, else 0.
#[unsafe(no_mangle)]
pub extern "C" fn pc_system_event_resets(system: Option<&pc_system>, index: usize) -> c_int {
    of_event(system, index, |event| event.resets().into())
}

/// A property of an event; 0 for a null system, and beyond the last event.
fn of_event(system: Option<&pc_system>, index: usize, known: impl FnOnce(&Event) -> c_int) -> c_int {
    system.and_then(|system| system.inventory.events.get(index)).map_or(0, known)
}

/// Writes the functions of the events at (t, y), as many as pc_system_event_count: an event
/// occurs where its function passes through zero. Where a function has no value, its entry is not a
/// finite number.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_events(
    system: *const pc_system,
    t: f64,
    y: *const f64,
    y_length: usize,
    values: *mut f64,
    length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let evaluate = |inventory: &Inventory, inner: &mut Inner| {
        let (state, expected) = (State { y, length: y_length }, inventory.events.len());
        let target = Target { data: values, length, expected, what: "values" };
        // SAFETY: as the preamble demands.
        let (y, values) = unsafe { slices(state, inventory.dim(), target) }?;
        Ok(inner.events.evaluate(t, y, values)?)
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, evaluate) }
}

/// Turns the state y before an event, number `event` counted from 0, into the state after it. An
/// event without resets leaves y unchanged.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_event_reset(
    system: *const pc_system,
    event: usize,
    t: f64,
    y: *mut f64,
    y_length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let reset = |inventory: &Inventory, inner: &mut Inner| {
        let count = inventory.events.len();
        let Some(known) = inventory.events.get(event) else {
            return Err(CallError::Index { what: "the events", index: event, count });
        };
        // SAFETY: as the preamble demands.
        let given = unsafe { numbers(y, y_length, inventory.dim(), "y") }?;
        let Inner { events, room: Room { state, .. }, .. } = inner;
        state.copy_from_slice(given);
        if known.resets() {
            events.reset(event, t, state)?;
        }
        // SAFETY: as the preamble demands.
        unsafe { room(y, y_length, inventory.dim(), "y") }?.copy_from_slice(state);
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, reset) }
}

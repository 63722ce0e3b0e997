//! Equations of motion: their state, names and parameters.

use std::ffi::c_char;

use ::pc_model::absolute_tolerances;

use crate::api::code::derived;
use crate::api::model::pc_model;
use crate::api::options::pc_system_options;
use crate::ffi::boundary::entry;
use crate::ffi::call_error::CallError;
use crate::ffi::error::pc_error;
use crate::ffi::pointer::{clear, finite, free, handle, numbers, room, write};
use crate::ffi::status::pc_status;
use crate::machinery::system::{Inner, Inventory, count, holding, inside, name, pc_system};

/// Derives and compiles the equations of a model. `options` may be NULL. This takes from
/// milliseconds to seconds (the latter for a hundred bodies); other functions are fast unless they
/// say that they derive.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_new(
    model: *const pc_model,
    options: *const pc_system_options,
    system: *mut *mut pc_system,
    error: *mut *mut pc_error,
) -> pc_status {
    let new = || {
        // SAFETY: the pointers are as the preamble demands.
        unsafe { clear(system, "system") }?;
        // SAFETY: as the preamble demands.
        let derived = unsafe { derived(model, options) }?.system()?;
        // SAFETY: as the preamble demands.
        unsafe { write(system, Box::into_raw(Box::new(derived)), "system") }
    };
    // SAFETY: `error` is null or memory for a pointer.
    unsafe { entry(error, new) }
}

/// Makes a copy for another thread, with the current parameters. It shares the machine code that
/// exists: that of f, and that of each derivative that the original has evaluated before (the first
/// evaluation of a derivative compiles it).
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_clone(
    system: *const pc_system,
    copy: *mut *mut pc_system,
    error: *mut *mut pc_error,
) -> pc_status {
    let clone = || {
        // SAFETY: the pointers are as the preamble demands.
        unsafe { clear(copy, "copy") }?;
        // SAFETY: as the preamble demands.
        let system = unsafe { handle(system, "system") }?;
        let cloned = system.copy()?;
        // SAFETY: as the preamble demands.
        unsafe { write(copy, Box::into_raw(Box::new(cloned)), "copy") }
    };
    // SAFETY: `error` is null or memory for a pointer.
    unsafe { entry(error, clone) }
}

/// Frees a system. NULL is allowed. It does nothing when called from a function of your program
/// that a call on this system runs.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_free(system: *mut pc_system) {
    // SAFETY: null or a live handle, as the preamble demands.
    if unsafe { system.as_ref() }.is_none_or(|system| system.inner.close()) {
        // SAFETY: null or a handle of ours that nobody uses any more.
        unsafe { free(system) };
    }
}

/// The length of the state y: coordinates, quasi-velocities or momenta, first-order states; 0
/// for NULL.
#[unsafe(no_mangle)]
pub extern "C" fn pc_system_dim(system: Option<&pc_system>) -> usize {
    count(system, Inventory::dim)
}

/// The number of coordinates, which come first in the state; 0 for NULL.
#[unsafe(no_mangle)]
pub extern "C" fn pc_system_coordinate_count(system: Option<&pc_system>) -> usize {
    count(system, |inventory| inventory.coordinates)
}

/// The number of first-order states, which come last in the state; 0 for NULL.
#[unsafe(no_mangle)]
pub extern "C" fn pc_system_state_count(system: Option<&pc_system>) -> usize {
    count(system, |inventory| inventory.states)
}

/// The number of parameters; 0 for NULL.
#[unsafe(no_mangle)]
pub extern "C" fn pc_system_parameter_count(system: Option<&pc_system>) -> usize {
    count(system, |inventory| inventory.parameters.len())
}

/// The number of observables: the integrals, "energy", the outputs; 0 for NULL.
#[unsafe(no_mangle)]
pub extern "C" fn pc_system_observable_count(system: Option<&pc_system>) -> usize {
    count(system, |inventory| inventory.observables.len())
}

/// The number of observables that should stay constant: the integrals and the energy, which come
/// first; 0 for NULL.
#[unsafe(no_mangle)]
pub extern "C" fn pc_system_conserved_count(system: Option<&pc_system>) -> usize {
    count(system, |inventory| inventory.conserved)
}

/// The number of constraints that projection maintains; 0 for NULL.
#[unsafe(no_mangle)]
pub extern "C" fn pc_system_constraint_count(system: Option<&pc_system>) -> usize {
    count(system, |inventory| inventory.constraints.len())
}

/// The number of reactions; 0 without pc_model_observe_reactions, and for NULL.
#[unsafe(no_mangle)]
pub extern "C" fn pc_system_reaction_count(system: Option<&pc_system>) -> usize {
    count(system, |inventory| inventory.reactions.len())
}

/// The name of a component of the state, counted from 0; NULL beyond the last.
#[unsafe(no_mangle)]
pub extern "C" fn pc_system_name(system: Option<&pc_system>, index: usize) -> *const c_char {
    name(system, index, |inventory| &inventory.names)
}

/// The name of a parameter, counted from 0; NULL beyond the last.
#[unsafe(no_mangle)]
pub extern "C" fn pc_system_parameter_name(system: Option<&pc_system>, index: usize) -> *const c_char {
    name(system, index, |inventory| &inventory.parameters)
}

/// The name of an observable, counted from 0; NULL beyond the last.
#[unsafe(no_mangle)]
pub extern "C" fn pc_system_observable_name(system: Option<&pc_system>, index: usize) -> *const c_char {
    name(system, index, |inventory| &inventory.observables)
}

/// The name of a constraint that projection maintains, counted from 0; NULL beyond the last.
#[unsafe(no_mangle)]
pub extern "C" fn pc_system_constraint_name(system: Option<&pc_system>, index: usize) -> *const c_char {
    name(system, index, |inventory| &inventory.constraints)
}

/// The name of a reaction, `λ_` followed by the name of its constraint, counted from 0; NULL beyond
/// the last.
#[unsafe(no_mangle)]
pub extern "C" fn pc_system_reaction_name(system: Option<&pc_system>, index: usize) -> *const c_char {
    let place = system.and_then(|system| system.inventory.reactions.get(index).copied());
    name(system, place.unwrap_or(usize::MAX), |inventory| &inventory.observables)
}

/// Writes the time and state from which the model starts. `t` may be NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_start(
    system: *const pc_system,
    t: *mut f64,
    y: *mut f64,
    y_length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let start = || {
        // SAFETY: the pointers are as the preamble demands.
        let inventory = &unsafe { handle(system, "system") }?.inventory;
        // SAFETY: as the preamble demands.
        unsafe { room(y, y_length, inventory.dim(), "y") }?.copy_from_slice(&inventory.start);
        // SAFETY: as the preamble demands.
        if t.is_null() { Ok(()) } else { unsafe { write(t, inventory.facts.t_start, "t") } }
    };
    // SAFETY: `error` is null or memory for a pointer.
    unsafe { entry(error, start) }
}

/// Writes the absolute tolerance of each component of the state with which the program `pc` would
/// run the system from its start to t_end: the tolerance in the text if it gives one, else
/// min(1e-12, relative·s) for a component of scale s at the start, where f is evaluated once, but
/// no less than the rounding error of the largest component. pc_solver_options takes them as
/// absolute_tolerances.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_absolute_tolerances(
    system: *const pc_system,
    relative: f64,
    t_end: f64,
    values: *mut f64,
    length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let scale = |inventory: &Inventory, inner: &mut Inner| {
        finite(relative, "relative")?;
        finite(t_end, "t_end")?;
        // SAFETY: null or room for `length` numbers, as the preamble demands.
        let values = unsafe { room(values, length, inventory.dim(), "values") }?;
        let (t_start, start) = inventory.start();
        let usual = absolute_tolerances(&mut inner.field, start, (t_start, t_end), relative);
        let written = inventory.model.document().simulation.atol.as_ref();
        let names: Vec<String> =
            inventory.names.iter().map(|name| name.to_string_lossy().into_owned()).collect();
        let all = written.map_or(usual.clone(), |written| written.value.over(&names, &usual));
        values.copy_from_slice(&all);
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, scale) }
}

/// Writes the values of all parameters. Where a parameter that is an expression in others has no
/// value, its entry is not a finite number.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_parameters(
    system: *const pc_system,
    values: *mut f64,
    length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let get = |inventory: &Inventory, inner: &mut Inner| {
        // SAFETY: null or room for `length` numbers, as the preamble demands.
        let values = unsafe { room(values, length, inventory.parameters.len(), "values") }?;
        values.copy_from_slice(inner.field.parameters());
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, get) }
}

/// Sets all parameters, which is cheap, since nothing is derived again. The start stays the same,
/// and solvers and kernels made before keep the values they have. Inputs come after the parameters;
/// an input with a table follows its table whatever it is set to.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_set_parameters(
    system: *mut pc_system,
    values: *const f64,
    length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let set = |system: &pc_system, inner: &mut Inner| {
        // SAFETY: null or `length` numbers, as the preamble demands.
        let values = unsafe { numbers(values, length, system.inventory.parameters.len(), "values") }?;
        for &value in values {
            finite(value, "a parameter")?;
        }
        inner.values.set_all(values);
        system.take_values(inner);
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { holding(system, error, set) }
}

/// Sets one parameter, by its index; parameters that are expressions in it change with it, unless
/// they have themselves been set. Otherwise this is like pc_system_set_parameters.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_set_parameter(
    system: *mut pc_system,
    index: usize,
    value: f64,
    error: *mut *mut pc_error,
) -> pc_status {
    let set = |system: &pc_system, inner: &mut Inner| {
        let count = system.inventory.parameters.len();
        if index >= count {
            return Err(CallError::Index { what: "the parameters", index, count });
        }
        let value = finite(value, "value")?;
        if inner.values.is_table(index) {
            return Err(CallError::Unsupported {
                what: "setting this input",
                why: "it is read from a table",
            });
        }
        inner.values.set(index, value);
        system.take_values(inner);
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { holding(system, error, set) }
}

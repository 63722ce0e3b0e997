//! Observables, reactions and constraint residuals along a motion.

use crate::api::rates::{State, Target, all_finite, slices};
use crate::ffi::call_error::CallError;
use crate::ffi::error::pc_error;
use crate::ffi::status::pc_status;
use crate::machinery::system::{Inner, Inventory, inside, pc_system};

/// Writes the observables at (t, y), as many as pc_system_observable_count: the integrals, the
/// energy, the outputs.
///
/// Where an observable has no value, its entry is not a finite number; the same holds for an
/// observable that contains accelerations where external forces cannot be computed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_observe(
    system: *const pc_system,
    t: f64,
    y: *const f64,
    y_length: usize,
    values: *mut f64,
    length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let observe = |inventory: &Inventory, inner: &mut Inner| {
        let (state, expected) = (State { y, length: y_length }, inventory.observables.len());
        let target = Target { data: values, length, expected, what: "values" };
        // SAFETY: as the preamble demands.
        let (y, values) = unsafe { slices(state, inventory.dim(), target) }?;
        inner.field.observe(t, y, values);
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, observe) }
}

/// Writes the integrals and the energy at (t, y), as many as pc_system_conserved_count: these are
/// the first of the observables, and should stay constant.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_integrals(
    system: *const pc_system,
    t: f64,
    y: *const f64,
    y_length: usize,
    values: *mut f64,
    length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let observe = |inventory: &Inventory, inner: &mut Inner| {
        let (state, expected) = (State { y, length: y_length }, inventory.conserved);
        let target = Target { data: values, length, expected, what: "values" };
        // SAFETY: as the preamble demands.
        let (y, values) = unsafe { slices(state, inventory.dim(), target) }?;
        let all = inner.room.numbers(inventory.observables.len());
        inner.field.observe_unforced(t, y, all);
        values.copy_from_slice(&all[..expected]);
        all_finite("an integral", values)
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, observe) }
}

/// Writes the energy y_s η_s − L at (t, y). No function that computes external forces is called.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_energy(
    system: *const pc_system,
    t: f64,
    y: *const f64,
    y_length: usize,
    energy: *mut f64,
    error: *mut *mut pc_error,
) -> pc_status {
    let observe = |inventory: &Inventory, inner: &mut Inner| {
        let target = Target { data: energy, length: 1, expected: 1, what: "energy" };
        // SAFETY: as the preamble demands.
        let (y, energy) = unsafe { slices(State { y, length: y_length }, inventory.dim(), target) }?;
        let all = inner.room.numbers(inventory.observables.len());
        inner.field.observe_unforced(t, y, all);
        // The energy is the last of the conserved observables.
        energy[0] = all[inventory.conserved - 1];
        all_finite("the energy", energy)
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, observe) }
}

/// Writes the reactions of the constraints at (t, y), as many as pc_system_reaction_count: each
/// adds its value times the derivative of its constraint with respect to η_s to the force Q_s.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_reactions(
    system: *const pc_system,
    t: f64,
    y: *const f64,
    y_length: usize,
    values: *mut f64,
    length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let observe = |inventory: &Inventory, inner: &mut Inner| {
        let reactions = &inventory.reactions;
        if reactions.is_empty() {
            let why = "there are none, or pc_model_observe_reactions was not called";
            return Err(CallError::Unsupported { what: "the reactions", why });
        }
        let target = Target { data: values, length, expected: reactions.len(), what: "values" };
        // SAFETY: as the preamble demands.
        let (y, values) = unsafe { slices(State { y, length: y_length }, inventory.dim(), target) }?;
        inner.field.inputs(t, y)?;
        let all = inner.room.numbers(inventory.observables.len());
        inner.field.observe(t, y, all);
        for (value, &place) in values.iter_mut().zip(reactions) {
            *value = all[place];
        }
        all_finite("a reaction", values)
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, observe) }
}

/// Writes the residual of each constraint that projection maintains, as many as
/// pc_system_constraint_count.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_constraint_residuals(
    system: *const pc_system,
    t: f64,
    y: *const f64,
    y_length: usize,
    values: *mut f64,
    length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let observe = |inventory: &Inventory, inner: &mut Inner| {
        let expected = inner.field.constraint_names().len();
        let target = Target { data: values, length, expected, what: "values" };
        // SAFETY: as the preamble demands.
        let (y, values) = unsafe { slices(State { y, length: y_length }, inventory.dim(), target) }?;
        inner.field.constraint_residuals(t, y, values);
        all_finite("a constraint", values)
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, observe) }
}

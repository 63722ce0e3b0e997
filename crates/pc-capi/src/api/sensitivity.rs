//! Derivatives of motions with respect to parameters.

use ::pc_model::Flow;

use crate::api::solver::{integrate, pc_solver};
use crate::ffi::call_error::CallError;
use crate::ffi::error::pc_error;
use crate::ffi::pointer::{numbers, room};
use crate::ffi::status::pc_status;
use crate::machinery::engine::Integration;
use crate::machinery::system::{Inner, Inventory, inside, pc_system};

/// Writes the derivative of the start of the model with respect to parameter number `parameter`,
/// counted from 0: start values may be expressions in parameters. The call derives the equations.
/// Returns PC_INCONSISTENT_MODEL where there is no start for nearby values of the parameter, for an
/// input with a table, and for a parameter that is an expression in others.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_start_by_parameter(
    system: *const pc_system,
    parameter: usize,
    column: *mut f64,
    column_length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let derive = |inventory: &Inventory, inner: &mut Inner| {
        // SAFETY: null or room for `column_length` numbers, as the preamble demands.
        let column = unsafe { room(column, column_length, inventory.dim(), "column") }?;
        let values = inner.field.parameters();
        if parameter >= values.len() {
            return Err(CallError::Index { what: "parameter", index: parameter, count: values.len() });
        }
        let derived = inventory.derive(|mut model| {
            // A parameter that is an expression in others already has its value when its turn
            // comes.
            for (place, &value) in values.iter().enumerate() {
                let known = model.parameters().nth(place).map(|(name, known)| (name.to_owned(), known));
                let is_table = model.parameter_values().is_table(place);
                match known {
                    Some((name, known)) if known != value && !is_table => model.set(&name, value)?,
                    _ => {}
                }
            }
            model.derived(|assembly| {
                let flow = Flow::new(&model, assembly, inventory.facts.variables)?;
                Ok(flow.start_by_parameter(&model, assembly, parameter)?)
            })
        })?;
        column.copy_from_slice(&derived);
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, derive) }
}

/// Adds, before the first step, a sensitivity that a solver integrates with the motion: the
/// derivative of the state with respect to parameter number `parameter`, counted from 0. `start` is
/// the derivative of the start, which pc_system_start_by_parameter gives for the start of the
/// model; NULL, of length 0, for a start that does not depend on the parameter. Requires that
/// pc_model_differentiate was called. Sensitivities jump where an event of the model resets the
/// state; with an event of the program that does so, the call returns PC_INVALID_ARGUMENT. For an
/// input with a table, the sensitivity is the derivative with respect to a shift of all values of
/// the table.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_solver_add_sensitivity(
    solver: *mut pc_solver,
    parameter: usize,
    start: *const f64,
    start_length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let add = |integration: &mut Integration, dim: usize| {
        if start.is_null() && start_length == 0 {
            return integration.differentiate(parameter, &vec![0.0; dim]);
        }
        // SAFETY: `start_length` numbers, as the preamble demands.
        let start = unsafe { numbers(start, start_length, dim, "start") }?;
        integration.differentiate(parameter, start)
    };
    // SAFETY: as the preamble demands.
    unsafe { integrate(solver, error, add) }
}

/// Writes sensitivity number `number`, counted from 0 in the order in which sensitivities were
/// added, at the time of the solver; it has the length of the state.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_solver_sensitivity(
    solver: *const pc_solver,
    number: usize,
    column: *mut f64,
    column_length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let read = |integration: &mut Integration, dim: usize| {
        // SAFETY: null or room for `column_length` numbers, as the preamble demands.
        let column = unsafe { room(column, column_length, dim, "column") }?;
        let (matrix, count) = integration.sensitivities()?;
        if number >= count {
            return Err(CallError::Index { what: "sensitivity", index: number, count });
        }
        column.copy_from_slice(&matrix[number * dim..(number + 1) * dim]);
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { integrate(solver, error, read) }
}

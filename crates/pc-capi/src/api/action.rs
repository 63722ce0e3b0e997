//! A solution of Hamilton–Jacobi's equation, specified call by call.

use std::ffi::c_char;

use crate::api::builder::draft;
use crate::api::model::pc_model;
use crate::ffi::error::pc_error;
use crate::ffi::pointer::{finite, text};
use crate::ffi::status::pc_status;
use crate::machinery::draft::{Draft, Section, number, quoted};

/// Sets a function S of time, coordinates and constants that is claimed to solve
/// Hamilton–Jacobi's equation; pc_system_theory examines the claim, and compares the motion from
/// the start with the one that Jacobi's theorem gives. Motions do not depend on this function.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_action(
    model: *mut pc_model,
    expression: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, as the preamble demands.
        let expression = unsafe { text(expression, "expression") }?;
        draft.put(Section::HamiltonJacobi, &["action"], quoted(expression));
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_set_action", write) }
}

/// Adds a constant of the action, with a value near which the action is defined: if no proof is
/// found that the action solves the equation, the claim is tested numerically near these values.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_add_action_constant(
    model: *mut pc_model,
    name: *const c_char,
    value: f64,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, as the preamble demands.
        let name = unsafe { text(name, "name") }?;
        draft.add(Section::HamiltonJacobi, &["constants", name], number(finite(value, "value")?));
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_add_action_constant", write) }
}

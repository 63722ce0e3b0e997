//! Velocities that are chosen in addition to those of a model.

use std::ffi::c_char;

use crate::api::model::{Contents, change, pc_model};
use crate::ffi::error::pc_error;
use crate::ffi::pointer::text;
use crate::ffi::status::pc_status;

/// Adds a quasi-velocity to those of the model, for systems of the form PC_HAMEL: a linear
/// form in the velocities x' or the quasi-velocities of the model, such as "r*f'". Where fewer are
/// given than there are independent quasi-velocities, the missing ones are taken from those of the
/// model. Each added quasi-velocity is also an output. Errors in its definition are reported by
/// pc_model_check and pc_system_new.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_give_quasi_velocity(
    model: *mut pc_model,
    name: *const c_char,
    definition: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let give = |contents: &mut Contents| {
        // SAFETY: null or text, as the preamble demands.
        let (name, definition) = unsafe { (text(name, "name")?, text(definition, "definition")?) };
        contents.given.push((name.to_owned(), definition.to_owned()));
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { change(model, error, give) }
}

/// Chooses a velocity as independent; there must be as many choices as there are velocities that
/// the constraints leave free. Systems whose equations would otherwise contain multipliers then
/// have equations without them. The name is that of a quasi-velocity, or x' where there are none.
/// Without such choices, printed equations and source use the velocities that make them shortest. A
/// wrong choice is reported by pc_system_new.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_add_independent(
    model: *mut pc_model,
    name: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let ask = |contents: &mut Contents| {
        // SAFETY: null or text, as the preamble demands.
        contents.independent.push(unsafe { text(name, "name") }?.to_owned());
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { change(model, error, ask) }
}

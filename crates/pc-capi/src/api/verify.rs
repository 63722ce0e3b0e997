//! Comparison of the equations with a second derivation.

use std::ffi::c_char;
use std::ptr;

use ::pc_model::{Flow, Model, Variables};
use pc_verify::{Agreement, Options, Second, VerifyError, verify};

use crate::ffi::call_error::CallError;
use crate::ffi::error::pc_error;
use crate::ffi::pointer::{numbers, write};
use crate::ffi::status::pc_status;
use crate::ffi::strings::give;
use crate::machinery::system::{Inner, Inventory, inside, pc_system};

/// Derives the equations of the model a second time, by a route that shares only the text of the
/// model with the first, and compares both at `states` random states on the constraints, for the
/// current parameters: velocities, accelerations or rates of momenta, reactions, the energy and its
/// rate of change, integrals and outputs. A value of 0 stands for 100 states. `text` says how
/// closely they agree and what was not compared, on separate lines; it may be NULL, and is freed
/// with pc_string_free. External forces are taken to be 0. Returns PC_DISAGREEMENT, with the
/// quantity and both its values, if the two derivations differ, which is a defect of the library;
/// PC_UNSUPPORTED if there is no second derivation for this model. The call takes as long as
/// pc_system_new.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_verify(
    system: *const pc_system,
    states: usize,
    text: *mut *mut c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    // SAFETY: as the preamble demands.
    unsafe { begin(text) };
    let compare = |inventory: &Inventory, inner: &mut Inner| {
        let report = inventory.derive(|model| report(model, inner.field.parameters(), states))?;
        // SAFETY: as the preamble demands.
        if text.is_null() { Ok(()) } else { unsafe { write(text, give(&report), "text") } }
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, compare) }
}

/// As pc_system_verify, but at one state of the system, such as that of a solver: its time, and the
/// state that pc_solver_advance has written.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_verify_at(
    system: *const pc_system,
    t: f64,
    y: *const f64,
    y_length: usize,
    text: *mut *mut c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    // SAFETY: as the preamble demands.
    unsafe { begin(text) };
    let compare = |inventory: &Inventory, inner: &mut Inner| {
        // SAFETY: null or `y_length` numbers, as the preamble demands.
        let y = unsafe { numbers(y, y_length, inventory.dim(), "y") }?;
        let (variables, parameters) = (inventory.facts.variables, inner.field.parameters());
        let report = inventory.derive(|model| report_at(model, variables, parameters, (t, y)))?;
        // SAFETY: as the preamble demands.
        if text.is_null() { Ok(()) } else { unsafe { write(text, give(&report), "text") } }
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, compare) }
}

/// Writes NULL to the place of a text, in case the call fails.
///
/// # Safety
/// Null, or a pointer to memory for a pointer.
unsafe fn begin(text: *mut *mut c_char) {
    if !text.is_null() {
        // SAFETY: not null, and then as promised.
        unsafe { text.write(ptr::null_mut()) };
    }
}

fn report(mut model: Model, parameters: &[f64], states: usize) -> Result<String, CallError> {
    set(&mut model, parameters)?;
    let usual = Options::default();
    let options = Options { states: if states == 0 { usual.states } else { states }, ..usual };
    in_words(model.derived(|assembly| verify(&model, assembly, &options)))
}

fn report_at(
    mut model: Model,
    variables: Variables,
    parameters: &[f64],
    (t, y): (f64, &[f64]),
) -> Result<String, CallError> {
    set(&mut model, parameters)?;
    in_words(model.derived(|assembly| {
        let flow = Flow::new(&model, assembly, variables)?;
        Second::new(&model, assembly)?.agrees(variables.name(), &flow, assembly, t, y)
    }))
}

/// Gives a model the parameters of a system; its start may then be off the constraints, which does not matter here.
fn set(model: &mut Model, parameters: &[f64]) -> Result<(), CallError> {
    let names: Vec<String> = model.parameters().map(|(name, _)| name.to_owned()).collect();
    for (place, (name, &value)) in names.iter().zip(parameters).enumerate() {
        if !model.parameter_values().is_table(place) {
            model.set(name, value)?;
        }
    }
    model.project_start(true);
    Ok(())
}

fn in_words(compared: Result<Agreement, VerifyError>) -> Result<String, CallError> {
    let agreement = compared.map_err(|error| match error {
        VerifyError::Model(error) => CallError::Model(error),
        other => CallError::Verify(other),
    })?;
    let more = agreement.not_compared.iter().map(|what| format!("not compared: {what}\n"));
    Ok(format!("{agreement}\n{}", more.collect::<String>()))
}

//! The settings of a model besides its mechanics: its description, its start, the kinds of its
//! constraints, and how it is run.

use std::ffi::c_char;

use crate::api::builder::draft;
use crate::api::model::{Contents, Origin, change, pc_model};
use crate::ffi::call_error::CallError;
use crate::ffi::error::pc_error;
use crate::ffi::pointer::{finite, text};
use crate::ffi::status::pc_status;
use crate::machinery::draft::{Draft, Section, number, quoted};

/// Sets the description of the model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_description(
    model: *mut pc_model,
    description: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    // SAFETY: as the preamble demands.
    unsafe { put(model, error, "pc_model_set_description", (Section::Heading, "description"), description) }
}

/// Sets the reference to the source of the model.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_reference(
    model: *mut pc_model,
    reference: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    // SAFETY: as the preamble demands.
    unsafe { put(model, error, "pc_model_set_reference", (Section::Heading, "reference"), reference) }
}

/// Changes the start value of a coordinate, of a quasi-velocity, or of a velocity `x'` where
/// there are no quasi-velocities, to a number.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_start(
    model: *mut pc_model,
    name: *const c_char,
    value: f64,
    error: *mut *mut pc_error,
) -> pc_status {
    let set = |contents: &mut Contents| {
        // SAFETY: null or text, as the preamble demands.
        let name = unsafe { text(name, "name") }?;
        let value = finite(value, "value")?;
        match &mut contents.origin {
            Origin::Text(model) => model.set_start(name, value)?,
            Origin::Calls(draft) => draft.set_start(name, number(value))?,
        }
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { change(model, error, set) }
}

/// Changes a start value to an expression in parameters; otherwise this is like pc_model_set_start.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_start_expression(
    model: *mut pc_model,
    name: *const c_char,
    expression: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, as the preamble demands.
        let (name, expression) = unsafe { (text(name, "name")?, text(expression, "expression")?) };
        Ok(draft.set_start(name, quoted(expression))?)
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_set_start_expression", write) }
}

/// Sets the kind of a constraint: "holonomic" or "nonholonomic", which is checked, or
/// "nonlinear" for one that is not affine in the velocities and obeys Chetaev's condition.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_constraint_kind(
    model: *mut pc_model,
    constraint: *const c_char,
    kind: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, as the preamble demands.
        let (constraint, kind) = unsafe { (text(constraint, "constraint")?, text(kind, "kind")?) };
        draft.put(Section::Constraints, &[constraint, "kind"], quoted(kind));
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_set_constraint_kind", write) }
}

/// Sets the time at the start; 0 unless set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_start_time(
    model: *mut pc_model,
    t: f64,
    error: *mut *mut pc_error,
) -> pc_status {
    // SAFETY: as the preamble demands.
    unsafe { set_number(model, error, "pc_model_set_start_time", &[("t_start", t)]) }
}

/// Sets the time until which the program `pc` runs the model. This time is written to the text, as
/// are the settings of the next five functions; solvers take pc_solver_options instead.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_end_time(
    model: *mut pc_model,
    t: f64,
    error: *mut *mut pc_error,
) -> pc_status {
    // SAFETY: as the preamble demands.
    unsafe { set_number(model, error, "pc_model_set_end_time", &[("t_end", t)]) }
}

/// Sets the number of rows, at least 2, that the program `pc` writes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_samples(
    model: *mut pc_model,
    samples: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        draft.put(Section::Simulation, &["samples"], samples.to_string());
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_set_samples", write) }
}

/// Sets the tolerances with which the program `pc` runs the model, both positive.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_tolerances(
    model: *mut pc_model,
    relative: f64,
    absolute: f64,
    error: *mut *mut pc_error,
) -> pc_status {
    let values = [("rtol", relative), ("atol", absolute)];
    // SAFETY: as the preamble demands.
    unsafe { set_number(model, error, "pc_model_set_tolerances", &values) }
}

/// Sets the largest length of a step, positive, with which the program `pc` runs the model: an
/// event whose function passes through zero and back within a step is missed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_max_step(
    model: *mut pc_model,
    length: f64,
    error: *mut *mut pc_error,
) -> pc_status {
    // SAFETY: as the preamble demands.
    unsafe { set_number(model, error, "pc_model_set_max_step", &[("max_step", length)]) }
}

/// Sets how the program `pc` looks for zeros of event functions: at `samples_per_step` points in
/// each step, at least 1; events whose intervals shrink until the time left is less than
/// `accumulation` of the first interval count as accumulated.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_event_search(
    model: *mut pc_model,
    samples_per_step: usize,
    accumulation: f64,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        finite(accumulation, "accumulation")?;
        draft.put(Section::Simulation, &["samples_per_step"], samples_per_step.to_string());
        draft.put(Section::Simulation, &["accumulation"], number(accumulation));
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_set_event_search", write) }
}

/// Sets the method by which the program `pc` runs the model: "auto", "adams", "bdf", "dop853" or
/// "taylor".
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_method(
    model: *mut pc_model,
    method: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    // SAFETY: as the preamble demands.
    unsafe { put(model, error, "pc_model_set_method", (Section::Simulation, "method"), method) }
}

/// Sets the form of the equations that the program `pc` integrates: "poincare", "canonical".
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_form(
    model: *mut pc_model,
    form: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    // SAFETY: as the preamble demands.
    unsafe { put(model, error, "pc_model_set_form", (Section::Simulation, "form"), form) }
}

/// Writes an entry whose value is text; errors refer to it by its key.
///
/// # Safety
/// As the preamble demands.
unsafe fn put(
    model: *mut pc_model,
    error: *mut *mut pc_error,
    what: &'static str,
    (section, key): (Section, &'static str),
    value: *const c_char,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, as promised.
        draft.put(section, &[key], quoted(unsafe { text(value, key) }?));
        Ok(())
    };
    // SAFETY: as promised.
    unsafe { draft(model, error, what, write) }
}

/// Writes numbers to the section `[simulation]`.
///
/// # Safety
/// As the preamble demands.
unsafe fn set_number(
    model: *mut pc_model,
    error: *mut *mut pc_error,
    what: &'static str,
    values: &[(&'static str, f64)],
) -> pc_status {
    let write = |draft: &mut Draft| -> Result<(), CallError> {
        for &(key, value) in values {
            finite(value, key)?;
        }
        for &(key, value) in values {
            draft.put(Section::Simulation, &[key], number(value));
        }
        Ok(())
    };
    // SAFETY: as promised.
    unsafe { draft(model, error, what, write) }
}

//! Models that are built call by call, with expressions given as strings.

use std::ffi::c_char;

use crate::api::model::{Contents, Origin, boxed, change, pc_model};
use crate::ffi::boundary::entry;
use crate::ffi::call_error::CallError;
use crate::ffi::error::pc_error;
use crate::ffi::pointer::{clear, finite, text, write};
use crate::ffi::status::pc_status;
use crate::machinery::draft::{Draft, Section, list, number, quoted};

/// Makes an empty model, to be built by the calls below. Entries of different kinds may be added in
/// any order; coordinates, quasi-velocities, parameters and so on each keep the order of their
/// calls. Expressions are written as in the text of a model: `x'` is the velocity of the coordinate
/// x, and `t` is the time. The model is read as a whole by pc_model_check and pc_system_new, whose
/// errors name the entry and show its expression.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_new(
    name: *const c_char,
    model: *mut *mut pc_model,
    error: *mut *mut pc_error,
) -> pc_status {
    let new = || {
        // SAFETY: the pointers are as the preamble demands.
        unsafe { clear(model, "model") }?;
        // SAFETY: as the preamble demands.
        let name = unsafe { text(name, "name") }?;
        // SAFETY: as the preamble demands.
        unsafe { write(model, boxed(Origin::Calls(Draft::new(name))), "model") }
    };
    // SAFETY: `error` is null or memory for a pointer.
    unsafe { entry(error, new) }
}

/// Reads the model as a whole: returns PC_OK if all names are known, all expressions are well
/// formed, and the frame and the start are valid. Only pc_system_new shows whether equations can be
/// derived.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_check(model: *const pc_model, error: *mut *mut pc_error) -> pc_status {
    let check = |contents: &mut Contents| {
        let model = contents.model()?;
        model.derived(|_| Ok(()))
    };
    // SAFETY: as the preamble demands; the contents are not changed.
    unsafe { change(model.cast_mut(), error, check) }
}

/// Calls `write` with the draft of a model that was begun with `pc_model_new`.
///
/// # Safety
/// `model` is null or a live handle, and `error` is null or points to memory for a pointer.
pub(crate) unsafe fn draft(
    model: *mut pc_model,
    error: *mut *mut pc_error,
    what: &'static str,
    write: impl FnOnce(&mut Draft) -> Result<(), CallError>,
) -> pc_status {
    let change_draft = |contents: &mut Contents| match &mut contents.origin {
        Origin::Calls(draft) => write(draft),
        Origin::Text(_) => Err(CallError::NotADraft { what }),
    };
    // SAFETY: as promised.
    unsafe { change(model, error, change_draft) }
}

/// Adds a parameter with its value, which pc_model_set and pc_system_set_parameter can change.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_add_parameter(
    model: *mut pc_model,
    name: *const c_char,
    value: f64,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, as the preamble demands.
        let name = unsafe { text(name, "name") }?;
        draft.add(Section::Parameters, &[name], number(finite(value, "value")?));
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_add_parameter", write) }
}

/// Adds a parameter that is an expression in the parameters before it. The new parameter changes
/// with them until it is itself set.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_add_parameter_expression(
    model: *mut pc_model,
    name: *const c_char,
    expression: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, as the preamble demands.
        let (name, expression) = unsafe { (text(name, "name")?, text(expression, "expression")?) };
        draft.add(Section::Parameters, &[name], quoted(expression));
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_add_parameter_expression", write) }
}

/// Adds a first-order state with its value at the start and its rate, which is an expression in
/// time, coordinates, velocities and states. The first-order state is integrated with the motion
/// and comes after the velocities in the state; it is not part of the frame.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_add_state(
    model: *mut pc_model,
    name: *const c_char,
    rate: *const c_char,
    start: f64,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, as the preamble demands.
        let (name, rate) = unsafe { (text(name, "name")?, text(rate, "rate")?) };
        draft.add(Section::States, &[name, "rate"], quoted(rate));
        draft.add(Section::States, &[name, "start"], number(finite(start, "start")?));
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_add_state", write) }
}

/// Sets the components of the acceleration of gravity, along the axes in which the positions of
/// bodies are given, as expressions in the parameters and t. Gravity acts on the mass centres of
/// all bodies and is included in the energy.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_gravity(
    model: *mut pc_model,
    x: *const c_char,
    y: *const c_char,
    z: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, as the preamble demands.
        let acceleration = unsafe { [text(x, "x")?, text(y, "y")?, text(z, "z")?] };
        draft.put(Section::Gravity, &["acceleration"], list(&acceleration));
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_set_gravity", write) }
}

/// Adds a name for an expression.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_add_definition(
    model: *mut pc_model,
    name: *const c_char,
    expression: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, as the preamble demands.
        let (name, expression) = unsafe { (text(name, "name")?, text(expression, "expression")?) };
        draft.add(Section::Definitions, &[name], quoted(expression));
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_add_definition", write) }
}

/// Adds a coordinate with its value at the start.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_add_coordinate(
    model: *mut pc_model,
    name: *const c_char,
    start: f64,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, as the preamble demands.
        let name = unsafe { text(name, "name") }?;
        draft.add(Section::Coordinates, &[name], number(finite(start, "start")?));
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_add_coordinate", write) }
}

/// Adds a quasi-velocity with its value at the start. Its `definition` is an expression affine in
/// the velocities x', or NULL where pc_model_set_kinematics gives the velocities in terms of
/// quasi-velocities. A model without quasi-velocities uses the velocities themselves; `name` may
/// then be `x'`, which sets the start value of this velocity.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_add_quasi_velocity(
    model: *mut pc_model,
    name: *const c_char,
    definition: *const c_char,
    start: f64,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, as the preamble demands.
        let name = unsafe { text(name, "name") }?;
        let start = number(finite(start, "start")?);
        if definition.is_null() {
            draft.add(Section::QuasiVelocities, &[name], start);
        } else {
            // SAFETY: text, as the preamble demands.
            let definition = unsafe { text(definition, "definition") }?;
            draft.add(Section::QuasiVelocities, &[name, "is"], quoted(definition));
            draft.add(Section::QuasiVelocities, &[name, "start"], start);
        }
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_add_quasi_velocity", write) }
}

/// Sets the velocity of a coordinate as an expression affine in the quasi-velocities, (3). Call
/// this function for every coordinate, or for none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_kinematics(
    model: *mut pc_model,
    coordinate: *const c_char,
    velocity: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, as the preamble demands.
        let (coordinate, velocity) =
            unsafe { (text(coordinate, "coordinate")?, text(velocity, "velocity")?) };
        draft.put(Section::Kinematics, &[coordinate], quoted(velocity));
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_set_kinematics", write) }
}

/// Sets the brackets of the frame to those of the algebra with this name, such as "so3"; needed
/// only where the frame does not determine them.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_algebra(
    model: *mut pc_model,
    name: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, as the preamble demands.
        let name = unsafe { text(name, "name") }?;
        draft.put(Section::Algebra, &["name"], quoted(name));
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_set_algebra", write) }
}

/// Sets the bracket [X_left, X_right], (5), as a linear combination of quasi-velocities, such as
/// "w3"; brackets that are not set are zero. `left` may be "t", for X_0. This is an alternative to
/// pc_model_set_algebra.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_bracket(
    model: *mut pc_model,
    left: *const c_char,
    right: *const c_char,
    value: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, as the preamble demands.
        let (left, right, value) =
            unsafe { (text(left, "left")?, text(right, "right")?, text(value, "value")?) };
        draft.put(Section::Brackets, &[&format!("{left},{right}")], quoted(value));
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_set_bracket", write) }
}

/// Adds a constraint: the expression, in coordinates or in velocities, must vanish. If it is not
/// affine in the velocities, declare this with pc_model_set_constraint_kind.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_add_constraint(
    model: *mut pc_model,
    name: *const c_char,
    expression: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, as the preamble demands.
        let (name, expression) = unsafe { (text(name, "name")?, text(expression, "expression")?) };
        draft.add(Section::Constraints, &[name, "expr"], quoted(expression));
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_add_constraint", write) }
}

/// Sets the Lagrangian L(t, x, η), which may contain x' too. It cannot be combined with a kinetic
/// or potential energy.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_lagrangian(
    model: *mut pc_model,
    expression: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, as the preamble demands.
        let expression = unsafe { text(expression, "expression") }?;
        draft.put(Section::Lagrangian, &["lagrangian"], quoted(expression));
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_set_lagrangian", write) }
}

/// Sets the kinetic energy.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_kinetic(
    model: *mut pc_model,
    expression: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, as the preamble demands.
        let expression = unsafe { text(expression, "expression") }?;
        draft.put(Section::Lagrangian, &["kinetic"], quoted(expression));
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_set_kinetic", write) }
}

/// Sets the potential energy.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_potential(
    model: *mut pc_model,
    expression: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, as the preamble demands.
        let expression = unsafe { text(expression, "expression") }?;
        draft.put(Section::Lagrangian, &["potential"], quoted(expression));
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_set_potential", write) }
}

/// Sets a dissipation function R, which gives the forces Q_s = −∂R/∂η_s.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_dissipation(
    model: *mut pc_model,
    expression: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, as the preamble demands.
        let expression = unsafe { text(expression, "expression") }?;
        draft.put(Section::Lagrangian, &["dissipation"], quoted(expression));
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_set_dissipation", write) }
}

/// Adds a force that is conjugate to a quasi-velocity or to a coordinate.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_add_force(
    model: *mut pc_model,
    on: *const c_char,
    expression: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, as the preamble demands.
        let (on, expression) = unsafe { (text(on, "on")?, text(expression, "expression")?) };
        draft.add(Section::Forces, &[on], quoted(expression));
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_add_force", write) }
}

/// Adds an integral: an expression that should stay constant, observed along the motion.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_add_integral(
    model: *mut pc_model,
    name: *const c_char,
    expression: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, as the preamble demands.
        let (name, expression) = unsafe { (text(name, "name")?, text(expression, "expression")?) };
        draft.add(Section::Integrals, &[name], quoted(expression));
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_add_integral", write) }
}

/// Adds an output: an expression observed along the motion.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_add_output(
    model: *mut pc_model,
    name: *const c_char,
    expression: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, as the preamble demands.
        let (name, expression) = unsafe { (text(name, "name")?, text(expression, "expression")?) };
        draft.add(Section::Outputs, &[name], quoted(expression));
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_add_output", write) }
}

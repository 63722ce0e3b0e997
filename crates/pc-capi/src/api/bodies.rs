//! Rigid bodies and particles, specified call by call.

use std::ffi::c_char;

use crate::api::builder::draft;
use crate::api::entry::{put, vector};
use crate::api::model::pc_model;
use crate::ffi::error::pc_error;
use crate::ffi::pointer::{text, texts};
use crate::ffi::status::pc_status;
use crate::machinery::draft::{Draft, Section, list, quoted};

/// Adds a particle, or a rigid body if it is given an inertia. The mass, and the position of the
/// mass centre or of a point of the body that is at rest, are expressions in the coordinates.
/// Energy and forces follow from the bodies, so the model needs no Lagrangian.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_add_body(
    model: *mut pc_model,
    name: *const c_char,
    mass: *const c_char,
    x: *const c_char,
    y: *const c_char,
    z: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, as the preamble demands.
        let (name, mass) = unsafe { (text(name, "name")?, text(mass, "mass")?) };
        // SAFETY: as the preamble demands.
        let position = unsafe { [text(x, "x")?, text(y, "y")?, text(z, "z")?] };
        draft.add(Section::Bodies, &[name, "mass"], quoted(mass));
        draft.add(Section::Bodies, &[name, "position"], list(&position));
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_add_body", write) }
}

/// Sets the force on a body, which acts at the position of the body, in axes fixed in space.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_body_force(
    model: *mut pc_model,
    body: *const c_char,
    x: *const c_char,
    y: *const c_char,
    z: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let what = ("force", "pc_model_set_body_force");
    // SAFETY: as the preamble demands.
    unsafe {
        draft(model, error, what.1, |draft| {
            put(draft, (body, "body"), Section::Bodies, &[what.0], || vector([x, y, z]))
        })
    }
}

/// Sets the torque on a rigid body, in the axes in which its angular velocity is given.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_body_torque(
    model: *mut pc_model,
    body: *const c_char,
    x: *const c_char,
    y: *const c_char,
    z: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let what = ("torque", "pc_model_set_body_torque");
    // SAFETY: as the preamble demands.
    unsafe {
        draft(model, error, what.1, |draft| {
            put(draft, (body, "body"), Section::Bodies, &[what.0], || vector([x, y, z]))
        })
    }
}

/// Sets the angular velocity of a rigid body, in axes of the body. It cannot be combined with
/// pc_model_set_body_rotation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_body_angular_velocity(
    model: *mut pc_model,
    body: *const c_char,
    x: *const c_char,
    y: *const c_char,
    z: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let what = ("angular_velocity", "pc_model_set_body_angular_velocity");
    // SAFETY: as the preamble demands.
    unsafe {
        draft(model, error, what.1, |draft| {
            put(draft, (body, "body"), Section::Bodies, &[what.0], || vector([x, y, z]))
        })
    }
}

/// Sets the inertia of a rigid body about its position, in axes of the body: 3 expressions
/// Ixx, Iyy, Izz, or 6, which continue with Ixy, Iyz, Ixz.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_body_inertia(
    model: *mut pc_model,
    body: *const c_char,
    entries: *const *const c_char,
    length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    // SAFETY: null or texts, as the preamble demands.
    let entries = || Ok(list(&unsafe { texts(entries, length, "entries") }?));
    let write = |draft: &mut Draft| put(draft, (body, "body"), Section::Bodies, &["inertia"], entries);
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_set_body_inertia", write) }
}

/// Sets the rotation of a rigid body: the 9 entries of the matrix R from axes of the body to
/// axes fixed in space, row by row.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_body_rotation(
    model: *mut pc_model,
    body: *const c_char,
    entries: *const *const c_char,
    length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    // SAFETY: null or texts, as the preamble demands.
    let entries = || Ok(list(&unsafe { texts(entries, length, "entries") }?));
    let write = |draft: &mut Draft| put(draft, (body, "body"), Section::Bodies, &["rotation"], entries);
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_set_body_rotation", write) }
}

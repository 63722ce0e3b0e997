//! Bodies that are attached to others by joints, points of such bodies, loops, and contacts,
//! specified call by call.

use std::ffi::c_char;

use crate::api::builder::draft;
use crate::api::entry::{direction, put, vector};
use crate::api::model::pc_model;
use crate::ffi::call_error::CallError;
use crate::ffi::error::pc_error;
use crate::ffi::pointer::{text, texts};
use crate::ffi::status::pc_status;
use crate::machinery::draft::{Draft, Section, list, number, quoted};

/// Adds a body that is attached to another, or to the world if `parent` is null, by a joint of this
/// kind: fixed, revolute, prismatic, screw, cylindrical, universal, planar, spherical, free. The
/// origin of the body is the point of the joint. Inertia, force and torque are set as for other
/// bodies, start values by pc_model_add_coordinate and pc_model_add_quasi_velocity with the names
/// that the joint gives, such as `NAME` and `NAME'` for a revolute one.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_add_jointed_body(
    model: *mut pc_model,
    name: *const c_char,
    parent: *const c_char,
    kind: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, as the preamble demands.
        let (name, kind) = unsafe { (text(name, "name")?, text(kind, "kind")?) };
        draft.add(Section::Bodies, &[name, "joint", "kind"], quoted(kind));
        if !parent.is_null() {
            // SAFETY: text, as the preamble demands.
            let parent = unsafe { text(parent, "parent") }?;
            draft.add(Section::Bodies, &[name, "parent"], quoted(parent));
        }
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_add_jointed_body", write) }
}

/// Sets the mass of a body that is attached by a joint.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_body_mass(
    model: *mut pc_model,
    body: *const c_char,
    mass: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    // SAFETY: null or text, as the preamble demands.
    let mass = || Ok(quoted(unsafe { text(mass, "mass") }?));
    let write = |draft: &mut Draft| put(draft, (body, "body"), Section::Bodies, &["mass"], mass);
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_set_body_mass", write) }
}

/// Sets the mass centre of a body that is attached by a joint, in axes of the body and relative to
/// its origin.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_body_center(
    model: *mut pc_model,
    body: *const c_char,
    x: *const c_char,
    y: *const c_char,
    z: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let center = || vector([x, y, z]);
    let write = |draft: &mut Draft| put(draft, (body, "body"), Section::Bodies, &["center"], center);
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_set_body_center", write) }
}

/// Sets the point of a joint, in axes of the parent and relative to its origin.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_joint_place(
    model: *mut pc_model,
    body: *const c_char,
    x: *const c_char,
    y: *const c_char,
    z: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let at = || vector([x, y, z]);
    let write = |draft: &mut Draft| put(draft, (body, "body"), Section::Bodies, &["joint", "at"], at);
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_set_joint_place", write) }
}

/// Sets the axis of a joint, in axes of the joint; `axis` has 3 numbers, of any length but 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_joint_axis(
    model: *mut pc_model,
    body: *const c_char,
    axis: *const f64,
    error: *mut *mut pc_error,
) -> pc_status {
    let axis = || direction(axis, "axis");
    let write = |draft: &mut Draft| put(draft, (body, "body"), Section::Bodies, &["joint", "axis"], axis);
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_set_joint_axis", write) }
}

/// Sets the two axes of a universal joint, of 3 numbers each: the first is fixed in the parent,
/// the second in the body.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_joint_axes(
    model: *mut pc_model,
    body: *const c_char,
    first: *const f64,
    second: *const f64,
    error: *mut *mut pc_error,
) -> pc_status {
    let axes = || Ok(format!("[{}, {}]", direction(first, "first")?, direction(second, "second")?));
    let write = |draft: &mut Draft| put(draft, (body, "body"), Section::Bodies, &["joint", "axes"], axes);
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_set_joint_axes", write) }
}

/// Sets the pitch of a screw joint, a length per radian.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_joint_pitch(
    model: *mut pc_model,
    body: *const c_char,
    pitch: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    // SAFETY: null or text, as the preamble demands.
    let pitch = || Ok(quoted(unsafe { text(pitch, "pitch") }?));
    let write = |draft: &mut Draft| put(draft, (body, "body"), Section::Bodies, &["joint", "pitch"], pitch);
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_set_joint_pitch", write) }
}

/// Gears a joint with one coordinate to that of the body `followed`: its coordinate is `ratio`
/// times the other's plus `offset`; null stands for 1 and for 0. It has no quasi-velocity of its
/// own; the name of its coordinate is that of a definition and of an output.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_joint_gear(
    model: *mut pc_model,
    body: *const c_char,
    followed: *const c_char,
    ratio: *const c_char,
    offset: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, as the preamble demands.
        let followed = || Ok(quoted(unsafe { text(followed, "followed") }?));
        put(draft, (body, "body"), Section::Bodies, &["joint", "follows"], followed)?;
        for (key, value) in [("ratio", ratio), ("offset", offset)] {
            if !value.is_null() {
                // SAFETY: text, as the preamble demands.
                let value = || Ok(quoted(unsafe { text(value, key) }?));
                put(draft, (body, "body"), Section::Bodies, &["joint", key], value)?;
            }
        }
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_set_joint_gear", write) }
}

/// Sets the armature J of a joint with one coordinate x, which adds J x'^2/2 to the kinetic energy:
/// the inertia of a rotor times the square of the gear's ratio.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_joint_armature(
    model: *mut pc_model,
    body: *const c_char,
    armature: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    // SAFETY: null or text, as the preamble demands.
    let armature = || Ok(quoted(unsafe { text(armature, "armature") }?));
    let write =
        |draft: &mut Draft| put(draft, (body, "body"), Section::Bodies, &["joint", "armature"], armature);
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_set_joint_armature", write) }
}

/// Adds a spring to a joint with one coordinate x, with the potential energy
/// stiffness (x - rest)^2/2; a null `rest` stands for 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_joint_spring(
    model: *mut pc_model,
    body: *const c_char,
    stiffness: *const c_char,
    rest: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, as the preamble demands.
        let stiffness = || Ok(quoted(unsafe { text(stiffness, "stiffness") }?));
        put(draft, (body, "body"), Section::Bodies, &["joint", "stiffness"], stiffness)?;
        if rest.is_null() {
            return Ok(());
        }
        // SAFETY: text, as the preamble demands.
        let rest = || Ok(quoted(unsafe { text(rest, "rest") }?));
        put(draft, (body, "body"), Section::Bodies, &["joint", "rest"], rest)
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_set_joint_spring", write) }
}

/// Sets the damping d of a joint with one coordinate x: the force -d x'.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_joint_damping(
    model: *mut pc_model,
    body: *const c_char,
    damping: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    // SAFETY: null or text, as the preamble demands.
    let damping = || Ok(quoted(unsafe { text(damping, "damping") }?));
    let write =
        |draft: &mut Draft| put(draft, (body, "body"), Section::Bodies, &["joint", "damping"], damping);
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_set_joint_damping", write) }
}

/// Sets the dry friction F of a joint with one coordinate x: the force -F sign(x'), and any force
/// up to F where the joint is at rest.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_joint_friction(
    model: *mut pc_model,
    body: *const c_char,
    friction: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    // SAFETY: null or text, as the preamble demands.
    let friction = || Ok(quoted(unsafe { text(friction, "friction") }?));
    let write =
        |draft: &mut Draft| put(draft, (body, "body"), Section::Bodies, &["joint", "friction"], friction);
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_set_joint_friction", write) }
}

/// Sets stops at the ends of the way of a joint with one coordinate: beyond an end by s, they push
/// back with stiffness s + damping s'; a null `damping` stands for 0.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_joint_limits(
    model: *mut pc_model,
    body: *const c_char,
    lower: *const c_char,
    upper: *const c_char,
    stiffness: *const c_char,
    damping: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or texts, as the preamble demands.
        let ends = || Ok(list(&unsafe { [text(lower, "lower")?, text(upper, "upper")?] }));
        put(draft, (body, "body"), Section::Bodies, &["joint", "limits"], ends)?;
        // SAFETY: null or text, as the preamble demands.
        let stiffness = || Ok(quoted(unsafe { text(stiffness, "stiffness") }?));
        put(draft, (body, "body"), Section::Bodies, &["joint", "stop_stiffness"], stiffness)?;
        if damping.is_null() {
            return Ok(());
        }
        // SAFETY: text, as the preamble demands.
        let damping = || Ok(quoted(unsafe { text(damping, "damping") }?));
        put(draft, (body, "body"), Section::Bodies, &["joint", "stop_damping"], damping)
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_set_joint_limits", write) }
}

/// Sets rigid stops at the ends of the way of a joint with one coordinate x: there x' becomes
/// -restitution x', and all velocities change by the impulse along the joint. A joint that is
/// pushed against a stop comes to rest there. It cannot be combined with
/// pc_model_set_joint_limits.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_joint_restitution(
    model: *mut pc_model,
    body: *const c_char,
    lower: *const c_char,
    upper: *const c_char,
    restitution: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or texts, as the preamble demands.
        let ends = || Ok(list(&unsafe { [text(lower, "lower")?, text(upper, "upper")?] }));
        put(draft, (body, "body"), Section::Bodies, &["joint", "limits"], ends)?;
        // SAFETY: null or text, as the preamble demands.
        let restitution = || Ok(quoted(unsafe { text(restitution, "restitution") }?));
        put(draft, (body, "body"), Section::Bodies, &["joint", "restitution"], restitution)
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_set_joint_restitution", write) }
}

/// Sets the stiction of a joint with friction: at rest, friction holds it up to this force, which
/// is at least that of pc_model_set_joint_friction.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_joint_stiction(
    model: *mut pc_model,
    body: *const c_char,
    stiction: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, as the preamble demands.
        let value = || Ok(quoted(unsafe { text(stiction, "stiction") }?));
        put(draft, (body, "body"), Section::Bodies, &["joint", "stiction"], value)
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_set_joint_stiction", write) }
}

/// Sets the rotation from the axes of a joint to those of the parent: the 9 entries of its
/// matrix, row by row. It cannot be combined with pc_model_set_joint_turns.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_joint_rotation(
    model: *mut pc_model,
    body: *const c_char,
    entries: *const *const c_char,
    length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    // SAFETY: null or texts, as the preamble demands.
    let entries = || Ok(list(&unsafe { texts(entries, length, "entries") }?));
    let write =
        |draft: &mut Draft| put(draft, (body, "body"), Section::Bodies, &["joint", "rotation"], entries);
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_set_joint_rotation", write) }
}

/// Sets the rotation of pc_model_set_joint_rotation as a sequence of turns about axes: `axes` has a
/// letter x, y or z for each of the `length` angles; each turn is about an axis as moved by the
/// turns before it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_joint_turns(
    model: *mut pc_model,
    body: *const c_char,
    axes: *const c_char,
    angles: *const *const c_char,
    length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let turns = || {
        // SAFETY: null or text, and null or texts, as the preamble demands.
        let (axes, angles) = unsafe { (text(axes, "axes")?, texts(angles, length, "angles")?) };
        if axes.chars().count() != length {
            return Err(CallError::TurnsOfAxes { axes: axes.chars().count(), angles: length });
        }
        let turn = |(axis, angle): (char, &&str)| list(&[&axis.to_string(), angle]);
        Ok(format!("[{}]", axes.chars().zip(&angles).map(turn).collect::<Vec<_>>().join(", ")))
    };
    let write = |draft: &mut Draft| put(draft, (body, "body"), Section::Bodies, &["joint", "turns"], turns);
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_set_joint_turns", write) }
}

/// Sets names for the coordinates of a joint, in place of the default names of its kind.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_name_joint_coordinates(
    model: *mut pc_model,
    body: *const c_char,
    names: *const *const c_char,
    length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    // SAFETY: null or texts, as the preamble demands.
    let names = || Ok(list(&unsafe { texts(names, length, "names") }?));
    let write =
        |draft: &mut Draft| put(draft, (body, "body"), Section::Bodies, &["joint", "coordinates"], names);
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_name_joint_coordinates", write) }
}

/// Sets names for the quasi-velocities of a joint, in place of the default names of its kind.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_name_joint_quasi_velocities(
    model: *mut pc_model,
    body: *const c_char,
    names: *const *const c_char,
    length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    // SAFETY: null or texts, as the preamble demands.
    let names = || Ok(list(&unsafe { texts(names, length, "names") }?));
    let write = |draft: &mut Draft| {
        put(draft, (body, "body"), Section::Bodies, &["joint", "quasi_velocities"], names)
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_name_joint_quasi_velocities", write) }
}

/// Adds a point of a body that is attached by a joint, in axes of the body and relative to its
/// origin. In expressions its coordinates are `NAME_x`, `NAME_y`, `NAME_z`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_add_point(
    model: *mut pc_model,
    name: *const c_char,
    body: *const c_char,
    x: *const c_char,
    y: *const c_char,
    z: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, as the preamble demands.
        let (name, body) = unsafe { (text(name, "name")?, text(body, "body")?) };
        draft.add(Section::Points, &[name, "body"], quoted(body));
        draft.add(Section::Points, &[name, "at"], vector([x, y, z])?);
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_add_point", write) }
}

/// Closes a loop by joining two bodies that are attached by joints; the kind is point, revolute or
/// rod. `places` has 6 expressions: the point of the first body in its axes, then that of the
/// second.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_add_loop(
    model: *mut pc_model,
    name: *const c_char,
    kind: *const c_char,
    first: *const c_char,
    second: *const c_char,
    places: *const *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, as the preamble demands.
        let (name, kind) = unsafe { (text(name, "name")?, text(kind, "kind")?) };
        // SAFETY: as the preamble demands.
        let bodies = unsafe { [text(first, "first")?, text(second, "second")?] };
        // SAFETY: null or six texts, as the preamble demands.
        let places = unsafe { texts(places, 6, "places") }?;
        draft.add(Section::Loops, &[name, "kind"], quoted(kind));
        draft.add(Section::Loops, &[name, "bodies"], list(&bodies));
        let at = format!("[{}, {}]", list(&places[..3]), list(&places[3..]));
        draft.add(Section::Loops, &[name, "at"], at);
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_add_loop", write) }
}

/// Sets the axis of a revolute loop, in axes of the first body and in those of the second, with 3
/// numbers each.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_loop_axes(
    model: *mut pc_model,
    name: *const c_char,
    first: *const f64,
    second: *const f64,
    error: *mut *mut pc_error,
) -> pc_status {
    let axes = || Ok(format!("[{}, {}]", direction(first, "first")?, direction(second, "second")?));
    let write = |draft: &mut Draft| put(draft, (name, "name"), Section::Loops, &["axis"], axes);
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_set_loop_axes", write) }
}

/// Sets the distance between the two points of a rod.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_loop_length(
    model: *mut pc_model,
    name: *const c_char,
    length: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    // SAFETY: null or text, as the preamble demands.
    let length = || Ok(quoted(unsafe { text(length, "length") }?));
    let write = |draft: &mut Draft| put(draft, (name, "name"), Section::Loops, &["length"], length);
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_set_loop_length", write) }
}

/// Adds a contact of a body with a plane or uneven ground. The shape is disc, sphere or ellipsoid,
/// and the motion rolls or slides. pc_model_set_contact sets the size of the shape, and what else
/// the text may say.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_add_contact(
    model: *mut pc_model,
    name: *const c_char,
    body: *const c_char,
    shape: *const c_char,
    motion: *const c_char,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, as the preamble demands.
        let (name, body) = unsafe { (text(name, "name")?, text(body, "body")?) };
        // SAFETY: as the preamble demands.
        let (shape, motion) = unsafe { (text(shape, "shape")?, text(motion, "motion")?) };
        draft.add(Section::Contacts, &[name, "body"], quoted(body));
        draft.add(Section::Contacts, &[name, "shape"], quoted(shape));
        draft.add(Section::Contacts, &[name, "motion"], quoted(motion));
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_add_contact", write) }
}

/// Sets an entry of a contact: radius or height, with 1 value; axis, semi_axes, at, normal or
/// through, with 3; attitude, with 9; keeps, with the value true. The values are expressions,
/// those of an axis numbers.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_model_set_contact(
    model: *mut pc_model,
    name: *const c_char,
    entry: *const c_char,
    values: *const *const c_char,
    length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let write = |draft: &mut Draft| {
        // SAFETY: null or text, as the preamble demands.
        let entry = unsafe { text(entry, "entry") }?;
        // SAFETY: null or a list of texts, as the preamble demands.
        let values = unsafe { texts(values, length, "values") }?;
        let written = || Ok(entry_of_contact(entry, &values));
        put(draft, (name, "name"), Section::Contacts, &[entry], written)
    };
    // SAFETY: as the preamble demands.
    unsafe { draft(model, error, "pc_model_set_contact", write) }
}

/// The values of an entry as TOML: numbers and `true` as such, if they are expected, and all else
/// as texts.
fn entry_of_contact(entry: &str, values: &[&str]) -> String {
    let parsed = |text: &&str| text.trim().parse::<f64>().ok().filter(|value| value.is_finite());
    let numbers: Option<Vec<f64>> = values.iter().map(parsed).collect();
    match (entry, values, numbers) {
        ("keeps", [word @ ("true" | "false")], _) => (*word).to_owned(),
        ("axis", _, Some(axis)) => {
            format!("[{}]", axis.into_iter().map(number).collect::<Vec<_>>().join(", "))
        }
        ("radius" | "height" | "keeps", [value], _) => quoted(value),
        _ => list(values),
    }
}

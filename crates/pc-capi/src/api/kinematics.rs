//! The Coriolis matrix, and the Jacobians of bodies and of their momenta.

use std::ffi::c_char;

use pc_mech::VelocityMap;

use crate::api::rates::{State, Target, slices};
use crate::ffi::call_error::CallError;
use crate::ffi::error::pc_error;
use crate::ffi::pointer::{apart, numbers, text};
use crate::ffi::status::pc_status;
use crate::machinery::kinematics::{self, Kinematics};
use crate::machinery::mechanics::evaluate;
use crate::machinery::system::{Inner, Inventory, inside, pc_system};

/// Writes A column by column, a_0 and the rates for η̇ = 0.
fn columns(map: &mut VelocityMap, t: f64, state: &[f64], out: &mut [f64]) -> Result<(), CallError> {
    let (rows, k) = (map.functions(), map.quasi_velocities());
    let (matrix, others) = out.split_at_mut(rows * k);
    let (rest, rates) = others.split_at_mut(rows);
    map.map(t, state, matrix, rest)?;
    Ok(map.rates(t, state, rates)?)
}

/// Writes the Coriolis matrix C at (t, y), k × k and column-major, with k as in
/// pc_system_mass_matrix: C η are the terms of M η̇ + h = Q that are quadratic in η,
///
///   C_sm = ½ (X_r M_sm + X_m M_sr − X_s M_rm + c_rm^l M_ls − c_rs^l M_lm − c_ms^l M_lr) η_r,
///
/// with Christoffel's symbols where the c_rs^m vanish. dM/dt − 2C is skew-symmetric where neither
/// M nor the frame depends on t; otherwise C + Cᵀ is the part of dM/dt that is linear in η. The
/// first call derives C, as pc_system_new derives equations. Returns PC_INCONSISTENT_MODEL where M
/// depends on η.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_coriolis(
    system: *const pc_system,
    t: f64,
    y: *const f64,
    y_length: usize,
    matrix: *mut f64,
    length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let compute = |inventory: &Inventory, inner: &mut Inner| {
        let (dim, k) = (inventory.dim(), inner.field.quasi_velocities());
        let target = Target { data: matrix, length, expected: k * k, what: "matrix" };
        // SAFETY: as the preamble demands.
        let (y, matrix) = unsafe { slices(State { y, length: y_length }, dim, target) }?;
        inner.read_quasi_velocities(inventory, t, y)?;
        let Inner { kinematics: Kinematics { coriolis, .. }, field, room, .. } = inner;
        let derive = || inventory.derive(|model| kinematics::coriolis(&model, inventory.facts.variables));
        let coriolis = inventory.derivations.coriolis.own(coriolis, derive)?;
        coriolis.parameters_mut().copy_from_slice(field.inputs(t, y)?);
        Ok(coriolis.eval(t, &room.state, matrix)?)
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, compute) }
}

/// Writes the centroidal momentum matrix A at (t, y), column-major, with two more columns a and r:
/// 6 × (k + 2), with k as in pc_system_mass_matrix. The momentum P of all bodies and their angular
/// momentum L about their common mass centre, along fixed axes, are (P, L) = A η + a; a = 0 where
/// nothing depends on t. Their rates are A η̇ + r. The first call derives them, as pc_system_new
/// derives equations. Returns PC_UNSUPPORTED for a model without bodies, and PC_INVALID_MODEL for a
/// body whose angular velocity is given without a rotation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_centroidal(
    system: *const pc_system,
    t: f64,
    y: *const f64,
    y_length: usize,
    matrix: *mut f64,
    length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let compute = |inventory: &Inventory, inner: &mut Inner| {
        let (dim, k) = (inventory.dim(), inner.field.quasi_velocities());
        let target = Target { data: matrix, length, expected: 6 * (k + 2), what: "matrix" };
        // SAFETY: as the preamble demands.
        let (y, matrix) = unsafe { slices(State { y, length: y_length }, dim, target) }?;
        inner.read_quasi_velocities(inventory, t, y)?;
        let Inner { kinematics: Kinematics { centroidal, .. }, field, room, .. } = inner;
        let derive = || inventory.derive(|model| kinematics::centroidal(&model, inventory.facts.variables));
        let centroidal = inventory.derivations.centroidal.own(centroidal, derive)?;
        centroidal.parameters_mut().copy_from_slice(field.inputs(t, y)?);
        columns(centroidal, t, &room.state, matrix)
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, compute) }
}

/// Writes the common mass centre of all bodies at (t, y), 3 numbers along fixed axes. The first
/// call derives it, as pc_system_new derives equations. Returns PC_UNSUPPORTED for a model without
/// bodies.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_centre_of_mass(
    system: *const pc_system,
    t: f64,
    y: *const f64,
    y_length: usize,
    centre: *mut f64,
    length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let compute = |inventory: &Inventory, inner: &mut Inner| {
        let target = Target { data: centre, length, expected: 3, what: "centre" };
        // SAFETY: as the preamble demands.
        let (y, centre) = unsafe { slices(State { y, length: y_length }, inventory.dim(), target) }?;
        inner.read_quasi_velocities(inventory, t, y)?;
        let Inner { kinematics: Kinematics { centre: known, .. }, field, room, .. } = inner;
        let derive = || inventory.derive(|model| kinematics::centre(&model, inventory.facts.variables));
        let known = inventory.derivations.centre.own(known, derive)?;
        evaluate(&mut known.position, (t, &room.state, field.parameters()), centre)
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, compute) }
}

/// Writes the Jacobian J of the common mass centre of all bodies at (t, y), column-major, with two
/// more columns a and r: 3 × (k + 2), with k as in pc_system_mass_matrix. Its velocity along fixed
/// axes is J η + a, and its acceleration J η̇ + r. Otherwise like pc_system_centre_of_mass.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_centre_of_mass_jacobian(
    system: *const pc_system,
    t: f64,
    y: *const f64,
    y_length: usize,
    jacobian: *mut f64,
    length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let compute = |inventory: &Inventory, inner: &mut Inner| {
        let (dim, k) = (inventory.dim(), inner.field.quasi_velocities());
        let target = Target { data: jacobian, length, expected: 3 * (k + 2), what: "jacobian" };
        // SAFETY: as the preamble demands.
        let (y, jacobian) = unsafe { slices(State { y, length: y_length }, dim, target) }?;
        inner.read_quasi_velocities(inventory, t, y)?;
        let Inner { kinematics: Kinematics { centre, .. }, field, room, .. } = inner;
        let derive = || inventory.derive(|model| kinematics::centre(&model, inventory.facts.variables));
        let velocity = &mut inventory.derivations.centre.own(centre, derive)?.velocity;
        velocity.parameters_mut().copy_from_slice(field.inputs(t, y)?);
        columns(velocity, t, &room.state, jacobian)
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, compute) }
}

/// Writes the Jacobian J of a point of a body at (t, y), column-major, with two more columns a and
/// r: 6 × (k + 2), with k as in pc_system_mass_matrix. The velocity v of the point and the angular
/// velocity ω of the body, along fixed axes, are (v, ω) = J η + a; a = 0 where nothing depends on
/// t. Their rates are J η̇ + r. `body` is the name of a body, or of a point of `[points]`;
/// `point` has 3 numbers, its position along the axes of the body from there, or is null for that
/// place itself. The first call for a name derives J, as pc_system_new derives equations, for all
/// points. Returns PC_NOT_FOUND where there is no such body, and PC_INVALID_MODEL where its angular
/// velocity is given without a rotation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_body_jacobian(
    system: *const pc_system,
    t: f64,
    y: *const f64,
    y_length: usize,
    body: *const c_char,
    point: *const f64,
    point_length: usize,
    jacobian: *mut f64,
    length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let compute = |inventory: &Inventory, inner: &mut Inner| {
        let (dim, k) = (inventory.dim(), inner.field.quasi_velocities());
        let (given, expected) = (!point.is_null(), 6 * (k + 2));
        if given && point_length == 3 && length == expected {
            apart((point, 3, "point"), (jacobian, length, "jacobian"))?;
        }
        let point = match given {
            // SAFETY: as the preamble demands; the Jacobian shares no memory with it.
            true => unsafe { numbers(point, point_length, 3, "point") }?,
            false => &[0.0; 3],
        };
        // SAFETY: null or text, as the preamble demands.
        let body = unsafe { text(body, "body") }?;
        let target = Target { data: jacobian, length, expected, what: "jacobian" };
        // SAFETY: as the preamble demands.
        let (y, jacobian) = unsafe { slices(State { y, length: y_length }, dim, target) }?;
        let (map, state) = inner.of_body(inventory, (t, y), body, point)?;
        columns(map, t, state, jacobian)
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, compute) }
}

impl Inner {
    /// The velocities of a point of a body, derived on first use, and the state y, converted to (x, η).
    pub(crate) fn of_body(
        &mut self,
        inventory: &Inventory,
        (t, y): (f64, &[f64]),
        body: &str,
        point: &[f64],
    ) -> Result<(&mut VelocityMap, &[f64]), CallError> {
        self.read_quasi_velocities(inventory, t, y)?;
        let Inner { kinematics: Kinematics { bodies, .. }, field, room, .. } = self;
        let place = match bodies.iter().position(|(name, _)| name == body) {
            Some(place) => place,
            None => {
                let derive =
                    || inventory.derive(|model| kinematics::body(&model, inventory.facts.variables, body));
                bodies.push((body.to_owned(), inventory.derivations.bodies.get(body, derive)?));
                bodies.len() - 1
            }
        };
        let map = &mut bodies[place].1;
        // Velocities contain no external forces, so that no function is asked for them.
        let (parameters, forces) = map.parameters_mut().split_at_mut(field.parameters().len());
        field.parameters_at(t, parameters)?;
        forces.fill(0.0);
        map.arguments_mut().copy_from_slice(point);
        Ok((map, &room.state))
    }
}

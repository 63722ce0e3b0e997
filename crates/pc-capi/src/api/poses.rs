//! Where bodies are, and what their accelerations are besides J η̇; the forces that hold a system at rest.

use std::ffi::c_char;

use crate::api::rates::{State, Target, slices};
use crate::ffi::call_error::CallError;
use crate::ffi::error::pc_error;
use crate::ffi::pointer::{apart, numbers, text};
use crate::ffi::status::pc_status;
use crate::machinery::kinematics;
use crate::machinery::mechanics::evaluate;
use crate::machinery::system::{Inner, Inventory, inside, pc_system};

/// The state, the name of the body, the point, and the array to be written.
struct Read<'a> {
    y: &'a [f64],
    body: &'a str,
    point: &'a [f64],
    written: &'a mut [f64],
}

/// The point of a body from C, and where to write what is known of it.
struct OfPoint {
    body: *const c_char,
    point: *const f64,
    point_length: usize,
    target: Target,
}

impl OfPoint {
    /// What was given, checked.
    ///
    /// # Safety
    /// All pointers are as the preamble demands.
    unsafe fn read<'a>(&self, state: State, dim: usize) -> Result<Read<'a>, CallError> {
        let Target { data, length, expected, what } = self.target;
        let given = !(self.point.is_null() && self.point_length == 0);
        if given && self.point_length == 3 && length == expected {
            apart((self.point, 3, "point"), (data, length, what))?;
        }
        let point: &[f64] = match given {
            // SAFETY: as promised; the array that is written shares no memory with it.
            true => unsafe { numbers(self.point, self.point_length, 3, "point") }?,
            false => &[0.0; 3],
        };
        // SAFETY: null or text, as promised.
        let body = unsafe { text(self.body, "body") }?;
        // SAFETY: as promised.
        let (y, written) = unsafe { slices(state, dim, self.target) }?;
        Ok(Read { y, body, point, written })
    }
}

/// Writes the pose of a body at (t, y): the position r of one of its points along fixed axes, 3
/// numbers, followed by its rotation R, 3 × 3 and column-major, so `length` is 12. R takes
/// components along the axes of the body to those along fixed axes, so that its columns are the
/// axes of the body; a particle, and a point of the world, have the unit matrix. `body` and
/// `point` are as in pc_system_body_jacobian, whose J η + a is the rate of r. The first call for
/// a name derives the pose, as pc_system_new derives equations, for all points. Returns
/// PC_NOT_FOUND where there is no such body, and PC_INVALID_MODEL where its angular velocity is
/// given without a rotation.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_body_pose(
    system: *const pc_system,
    t: f64,
    y: *const f64,
    y_length: usize,
    body: *const c_char,
    point: *const f64,
    point_length: usize,
    pose: *mut f64,
    length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let compute = |inventory: &Inventory, inner: &mut Inner| {
        let target = Target { data: pose, length, expected: 12, what: "pose" };
        let given = OfPoint { body, point, point_length, target };
        // SAFETY: as the preamble demands.
        let Read { y, body, point, written: pose } =
            unsafe { given.read(State { y, length: y_length }, inventory.dim()) }?;
        inner.read_quasi_velocities(inventory, t, y)?;
        let Inner { poses, field, room, .. } = inner;
        let place = match poses.iter().position(|(name, _)| name == body) {
            Some(place) => place,
            None => {
                let derive =
                    || inventory.derive(|model| kinematics::pose(&model, inventory.facts.variables, body));
                poses.push((body.to_owned(), inventory.derivations.poses.get(body, derive)?));
                poses.len() - 1
            }
        };
        let parameters = field.parameters().len();
        let (all, state) = room.split(parameters + 3);
        field.parameters_at(t, &mut all[..parameters])?;
        all[parameters..].copy_from_slice(point);
        evaluate(&mut poses[place].1, (t, state, all), pose)
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, compute) }
}

/// Writes the acceleration that a point of a body has at (t, y) besides J η̇, and the same part
/// of the angular acceleration of the body, along fixed axes: 6 numbers, (v̇, ω̇) − J η̇, which
/// is J̇ η where nothing depends on t. It is the last column of pc_system_body_jacobian, without
/// the others. With it η̇ = J⁺ (a − bias) gives the point the acceleration a. Otherwise like
/// pc_system_body_jacobian.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_body_bias(
    system: *const pc_system,
    t: f64,
    y: *const f64,
    y_length: usize,
    body: *const c_char,
    point: *const f64,
    point_length: usize,
    bias: *mut f64,
    length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let compute = |inventory: &Inventory, inner: &mut Inner| {
        let target = Target { data: bias, length, expected: 6, what: "bias" };
        let given = OfPoint { body, point, point_length, target };
        // SAFETY: as the preamble demands.
        let Read { y, body, point, written: bias } =
            unsafe { given.read(State { y, length: y_length }, inventory.dim()) }?;
        let (map, state) = inner.of_body(inventory, (t, y), body, point)?;
        Ok(map.rates(t, state, bias)?)
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, compute) }
}

/// Writes the generalised forces g, k numbers with k as in pc_system_mass_matrix, that hold the
/// system at rest in the position of (t, y): tau of pc_system_inverse_dynamics for η = 0 and η̇ =
/// 0, whatever the velocities of y are. They balance weight and springs, −X_s L at rest, and
/// those forces of the model that act at rest; external forces of the program, which are not
/// called, count as 0. The first call derives equations, as pc_system_new does.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_gravity(
    system: *const pc_system,
    t: f64,
    y: *const f64,
    y_length: usize,
    tau: *mut f64,
    tau_length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let compute = |inventory: &Inventory, inner: &mut Inner| {
        let (dim, k) = (inventory.dim(), inner.field.quasi_velocities());
        let target = Target { data: tau, length: tau_length, expected: k, what: "tau" };
        // SAFETY: as the preamble demands.
        let (y, tau) = unsafe { slices(State { y, length: y_length }, dim, target) }?;
        inner.read_quasi_velocities(inventory, t, y)?;
        let (inverse, field, room) = inner.inverse(inventory)?;
        let (parameters, forces) = inverse.parameters_mut().split_at_mut(field.parameters().len());
        field.parameters_at(t, parameters)?;
        forces.fill(0.0);
        Ok(inverse.holding(t, &room.state, tau)?)
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, compute) }
}

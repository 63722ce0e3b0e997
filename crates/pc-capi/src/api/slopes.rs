//! Derivatives of the observables, and the linear equations near a state.

use pc_mech::VectorField;

use crate::api::rates::{State, Target, slices};
use crate::ffi::call_error::CallError;
use crate::ffi::error::pc_error;
use crate::ffi::pointer::{apart, integers, numbers, room};
use crate::ffi::status::pc_status;
use crate::machinery::slopes::{Forces, add_through_forces};
use crate::machinery::system::{Inner, Inventory, inside, pc_system};

/// Writes the derivatives ∂h/∂y of the observables h of pc_system_observe at (t, y), o × dim and
/// column-major for o = pc_system_observable_count, so `length` is o*dim. Observables that
/// contain accelerations or reactions change with these, and external forces with the state, as
/// they do in pc_system_jacobian. An entry is not finite where its observable has no derivative,
/// as that of a speed at rest, or no value. The first call derives them, as pc_system_new derives
/// equations.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_observable_jacobian(
    system: *const pc_system,
    t: f64,
    y: *const f64,
    y_length: usize,
    jacobian: *mut f64,
    length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let evaluate = |inventory: &Inventory, inner: &mut Inner| {
        let (dim, rows) = (inventory.dim(), inventory.observables.len());
        let target = Target { data: jacobian, length, expected: rows * dim, what: "jacobian" };
        // SAFETY: as the preamble demands.
        let (y, jacobian) = unsafe { slices(State { y, length: y_length }, dim, target) }?;
        let (motion, field) = inner.slopes(inventory, (t, y), Forces::OfFunction)?;
        motion.observable_jacobian(t, y, jacobian)?;
        if let Some(force_slopes) = field.force_jacobian(t, y)? {
            let mut by_parameters = vec![0.0; rows * motion.parameters().len()];
            motion.observable_parameter_jacobian(t, y, &mut by_parameters)?;
            let by_forces = &by_parameters[rows * inventory.parameters.len()..];
            add_through_forces(jacobian, by_forces, force_slopes, (rows, inventory.forces.len()));
        }
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, evaluate) }
}

/// Writes the derivatives ∂h/∂p of the observables at (t, y) by all parameters, o × p and
/// column-major for p = pc_system_parameter_count, at constant external forces. For an input with
/// a table it is the derivative by a shift of its values; a parameter that is an expression in
/// others counts as one by itself. Otherwise like pc_system_observable_jacobian; it needs no
/// pc_model_differentiate.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_observable_parameter_jacobian(
    system: *const pc_system,
    t: f64,
    y: *const f64,
    y_length: usize,
    jacobian: *mut f64,
    length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let evaluate = |inventory: &Inventory, inner: &mut Inner| {
        let (rows, columns) = (inventory.observables.len(), inventory.parameters.len());
        let target = Target { data: jacobian, length, expected: rows * columns, what: "jacobian" };
        // SAFETY: as the preamble demands.
        let (y, jacobian) = unsafe { slices(State { y, length: y_length }, inventory.dim(), target) }?;
        let (motion, _) = inner.slopes(inventory, (t, y), Forces::OfFunction)?;
        let mut all = vec![0.0; rows * motion.parameters().len()];
        motion.observable_parameter_jacobian(t, y, &mut all)?;
        jacobian.copy_from_slice(&all[..rows * columns]);
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, evaluate) }
}

/// Linearises ẏ = f(t, y, u), h = h(t, y, u) at (t, y), which need not be an equilibrium:
///
///   δẏ = A δy + B δu,   δh = C δy + D δu,
///
/// where u are all external forces, in the order of pc_system_force_name, then the parameters
/// with the indices `inputs`, such as inputs of the model; h are the observables of
/// pc_system_observe. In contrast to pc_system_jacobian, A is the derivative at constant u: that
/// of the open loop.
///
/// `forces` are the values of the external forces, so that none needs to be set; NULL, of length
/// 0, for those of the function of pc_system_set_force. Parameters and inputs have their current
/// values. The matrices are column-major, for dim = pc_system_dim, o = pc_system_observable_count
/// and m the number of components of u: `a` is dim × dim, `b` dim × m, `c` o × dim and `d` o × m.
/// Those that are NULL, of length 0, are left out. Entries of C and D may be not finite, as those
/// of pc_system_observable_jacobian.
///
/// Where constraints hold, the deviations δy of motions are those that satisfy them to first
/// order; pc_system_linearization has the equations in independent components. The first call
/// derives the matrices, as pc_system_new derives equations.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_linearize(
    system: *const pc_system,
    t: f64,
    y: *const f64,
    y_length: usize,
    forces: *const f64,
    forces_length: usize,
    inputs: *const usize,
    inputs_length: usize,
    a: *mut f64,
    a_length: usize,
    b: *mut f64,
    b_length: usize,
    c: *mut f64,
    c_length: usize,
    d: *mut f64,
    d_length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let evaluate = |inventory: &Inventory, inner: &mut Inner| {
        let (dim, rows) = (inventory.dim(), inventory.observables.len());
        let (own, external) = (inventory.parameters.len(), inventory.forces.len());
        let given = !(forces.is_null() && forces_length == 0);
        // SAFETY: null or `inputs_length` indices, as the preamble demands.
        let inputs = unsafe { integers(inputs, inputs_length, "inputs") }?;
        if let Some(&index) = inputs.iter().find(|&&index| index >= own) {
            return Err(CallError::Index { what: "inputs", index, count: own });
        }
        let columns = external + inputs.len();
        let wanted = [
            (a, a_length, dim * dim, "a"),
            (b, b_length, dim * columns, "b"),
            (c, c_length, rows * dim, "c"),
            (d, d_length, rows * columns, "d"),
        ];
        // Compared by addresses alone: an index is no longer than a number.
        let indices = (inputs.as_ptr().cast(), inputs_length, inputs_length, "inputs");
        separate(&wanted, &[(y, y_length, dim, "y"), (forces, forces_length, external, "forces"), indices])?;
        // SAFETY: as the preamble demands; none that is written shares memory with another.
        let y = unsafe { numbers(y, y_length, dim, "y") }?;
        let forces = match given {
            // SAFETY: as the preamble demands.
            true => Forces::Given(unsafe { numbers(forces, forces_length, external, "forces") }?),
            false => Forces::OfFunction,
        };
        // SAFETY: null or room for as many numbers, as the preamble demands.
        let [a, b, c, d] = wanted.map(|place| unsafe { wish(place) });
        let (a, b, c, d) = (a?, b?, c?, d?);
        let (motion, _) = inner.slopes(inventory, (t, y), forces)?;
        if let Some(a) = a {
            motion.jacobian(t, y, a)?;
        }
        // External forces follow the parameters.
        let places = || (own..own + external).chain(inputs.iter().copied());
        let mut all = vec![0.0; dim.max(rows) * motion.parameters().len()];
        if let Some(b) = b {
            let all = &mut all[..dim * motion.parameters().len()];
            motion.parameter_jacobian(t, y, all)?;
            pick(all, places(), dim, b);
        }
        if let Some(c) = c {
            motion.observable_jacobian(t, y, c)?;
        }
        if let Some(d) = d {
            let all = &mut all[..rows * motion.parameters().len()];
            motion.observable_parameter_jacobian(t, y, all)?;
            pick(all, places(), rows, d);
        }
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, evaluate) }
}

/// An array that may be wanted: its address, its length, the length that it has to have, and its
/// name.
type Wish = (*mut f64, usize, usize, &'static str);

/// Refuses arrays to be written that share memory with each other or with those that are read;
/// arrays of a wrong length are refused elsewhere, and empty ones are nowhere.
fn separate(wanted: &[Wish], read: &[(*const f64, usize, usize, &'static str)]) -> Result<(), CallError> {
    let fits =
        |&(_, length, expected, _): &(*const f64, usize, usize, &str)| length == expected && length > 0;
    let mut known: Vec<_> = read.iter().copied().filter(fits).collect();
    let written =
        wanted.iter().map(|&(data, length, expected, what)| (data.cast_const(), length, expected, what));
    for (data, length, expected, what) in written.filter(fits) {
        for &(other, other_length, _, other_what) in &known {
            apart((other, other_length, other_what), (data, length, what))?;
        }
        known.push((data, length, expected, what));
    }
    Ok(())
}

/// The array, unless it is null.
///
/// # Safety
/// Null, or room for as many numbers as said, which nobody else uses during the call.
unsafe fn wish<'a>((data, length, expected, what): Wish) -> Result<Option<&'a mut [f64]>, CallError> {
    if data.is_null() && length == 0 {
        return Ok(None);
    }
    // SAFETY: as promised.
    unsafe { room(data, length, expected, what) }.map(Some)
}

/// Copies columns of a matrix.
fn pick(all: &[f64], places: impl Iterator<Item = usize>, rows: usize, to: &mut [f64]) {
    for (column, place) in to.chunks_exact_mut(rows).zip(places) {
        column.copy_from_slice(&all[place * rows..(place + 1) * rows]);
    }
}

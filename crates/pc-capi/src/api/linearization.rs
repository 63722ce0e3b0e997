//! Equilibria and steady motions, and the linear equations near them in independent components.

use std::ffi::{CString, c_char, c_int};

use pc_analysis::Linearization;
use pc_mech::Matrix;

use crate::ffi::boundary::entry;
use crate::ffi::call_error::CallError;
use crate::ffi::error::pc_error;
use crate::ffi::pointer::{clear, free, handle, integers, numbers, room, write};
use crate::ffi::status::pc_status;
use crate::ffi::strings::{c_strings, nth};
use crate::machinery::linear::{About, Linear};
use crate::machinery::system::{Inner, Inventory, inside, pc_system};

/// The linear equations near a state, δẋ = A δx + B δu, δh = C δx + D δu, in independent
/// components x of the states that satisfy the constraints. It never changes. Free it with
/// pc_linearization_free.
pub struct pc_linearization {
    found: Linearization,
    state: Vec<f64>,
    components: Vec<CString>,
    inputs: Vec<CString>,
    outputs: Vec<CString>,
}

/// About which state pc_system_linearization linearises.
#[repr(C)]
pub enum pc_about {
    /// The state that is given; it has to satisfy the constraints.
    PC_ABOUT_STATE = 0,
    /// The steady motion nearest to it by Newton's method, in which all rates vanish but those of
    /// cyclic coordinates.
    PC_ABOUT_STEADY = 1,
    /// The equilibrium nearest to it, with all quasi-velocities 0.
    PC_ABOUT_REST = 2,
}

/// The lists of a linearization, and its matrices by their rows and columns.
#[repr(C)]
pub enum pc_linear_part {
    /// The components x, which are names of components of the state.
    PC_LINEAR_COMPONENTS = 0,
    /// u: the external forces, then the parameters that were chosen.
    PC_LINEAR_INPUTS = 1,
    /// h: the outputs of the model that have derivatives at the state.
    PC_LINEAR_OUTPUTS = 2,
}

/// The matrices of a linearization.
#[repr(C)]
pub enum pc_linear_matrix {
    /// A, by components and components.
    PC_LINEAR_A = 0,
    /// B, by components and inputs.
    PC_LINEAR_B = 1,
    /// C, by outputs and components.
    PC_LINEAR_C = 2,
    /// D, by outputs and inputs.
    PC_LINEAR_D = 3,
    /// The eigenvalues of A, two columns: real and imaginary parts, by components.
    PC_LINEAR_EIGENVALUES = 4,
}

/// Linearises the equations of a model in independent components about a state near y: the state
/// itself, the steady motion, or the equilibrium, as `about`, a pc_about, says. Of the components
/// of the states that satisfy the constraints as many are kept as are independent there; a steady
/// motion is described without its cyclic coordinates, whose rates are constant.
///
/// Newton's method holds the components with the indices `held` at their values in y, to choose
/// one of a family of steady motions; it does not leave the states that motions reach from y.
/// External forces are constant, with the values `forces`; NULL, of length 0, for those that the
/// function of pc_system_set_force has at (t, y). `inputs` are the indices of parameters that are
/// inputs; all external forces are. The system has to be in quasi-velocities of the model
/// (PC_POINCARE). The first call, and one with other inputs, derives equations, as pc_system_new
/// does.
///
/// Returns PC_EVALUATION where no steady state is found, or the rates have no derivatives there,
/// and PC_UNSUPPORTED where steady states are sought for equations that depend on time, and for
/// other forms of the equations.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_linearization(
    system: *const pc_system,
    about: c_int,
    t: f64,
    y: *const f64,
    y_length: usize,
    held: *const usize,
    held_length: usize,
    forces: *const f64,
    forces_length: usize,
    inputs: *const usize,
    inputs_length: usize,
    linearization: *mut *mut pc_linearization,
    error: *mut *mut pc_error,
) -> pc_status {
    let compute = |inventory: &Inventory, inner: &mut Inner| {
        let (dim, own, external) = (inventory.dim(), inventory.parameters.len(), inventory.forces.len());
        let about = match about {
            0 => About::State,
            1 => About::Steady,
            2 => About::Rest,
            value => return Err(CallError::Choice { what: "pc_about", value: value.into() }),
        };
        // SAFETY: null or as many numbers and indices as said, as the preamble demands.
        let (y, held, inputs) = unsafe {
            (
                numbers(y, y_length, dim, "y")?,
                integers(held, held_length, "held")?,
                integers(inputs, inputs_length, "inputs")?,
            )
        };
        for (list, count, what) in [(held, dim, "held"), (inputs, own, "inputs")] {
            if let Some(&index) = list.iter().find(|&&index| index >= count) {
                return Err(CallError::Index { what, index, count });
            }
        }
        let mut values = vec![0.0; own + external];
        if forces.is_null() && forces_length == 0 {
            values.copy_from_slice(inner.field.inputs(t, y)?);
        } else {
            // SAFETY: null or `forces_length` numbers, as the preamble demands.
            values[own..].copy_from_slice(unsafe { numbers(forces, forces_length, external, "forces") }?);
        }
        inner.field.parameters_at(t, &mut values[..own])?;
        if !inner.linear.as_ref().is_some_and(|linear| linear.has(inputs)) {
            let derive =
                || inventory.derive(|model| Ok(Box::new(Linear::of(&model, &inventory.names, inputs)?)));
            inner.linear = Some(inventory.derivations.linear.get(&format!("{inputs:?}"), derive)?);
        }
        const MISSING: CallError =
            CallError::Unsupported { what: "a linearization", why: "it was not derived" };
        let linear = inner.linear.as_mut().ok_or(MISSING)?;
        let (found, state) = linear.about(about, (t, y), held, &values)?;
        let external = inventory.forces.iter().cloned();
        let made = pc_linearization {
            components: c_strings(&found.components),
            inputs: external.chain(inputs.iter().map(|&place| inventory.parameters[place].clone())).collect(),
            outputs: c_strings(&found.outputs),
            found,
            state,
        };
        // SAFETY: null or memory for a handle, as the preamble demands.
        unsafe { write(linearization, Box::into_raw(Box::new(made)), "linearization") }
    };
    let checked = || {
        // SAFETY: as the preamble demands.
        unsafe { clear(linearization, "linearization") }
    };
    // SAFETY: `error` is null or memory for a pointer.
    match unsafe { entry(error, checked) } {
        // SAFETY: as the preamble demands.
        pc_status::PC_OK => unsafe { inside(system, error, compute) },
        refused => refused,
    }
}

impl pc_linearization {
    fn list(&self, part: c_int) -> &[CString] {
        match part {
            0 => &self.components,
            1 => &self.inputs,
            2 => &self.outputs,
            _ => &[],
        }
    }
}

/// The number of components, inputs or outputs, according to a pc_linear_part; 0 for NULL.
#[unsafe(no_mangle)]
pub extern "C" fn pc_linearization_count(linearization: Option<&pc_linearization>, part: c_int) -> usize {
    linearization.map_or(0, |linearization| linearization.list(part).len())
}

/// The name of a component, input or output, counted from 0, according to a pc_linear_part; an
/// external force has the name of its quasi-velocity. NULL beyond the last.
#[unsafe(no_mangle)]
pub extern "C" fn pc_linearization_name(
    linearization: Option<&pc_linearization>,
    part: c_int,
    index: usize,
) -> *const c_char {
    linearization.map_or(std::ptr::null(), |linearization| nth(linearization.list(part), index))
}

/// Returns 1 if the state is steady: all rates vanish but those of cyclic coordinates; else 0,
/// and 0 for NULL.
#[unsafe(no_mangle)]
pub extern "C" fn pc_linearization_is_steady(linearization: Option<&pc_linearization>) -> c_int {
    linearization.map_or(0, |linearization| linearization.found.is_steady.into())
}

/// Writes the state of the system about which the equations were linearised: the equilibrium or
/// the steady motion that was found.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_linearization_state(
    linearization: *const pc_linearization,
    y: *mut f64,
    y_length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let read = || {
        // SAFETY: null or a live handle, as the preamble demands.
        let state = &unsafe { handle(linearization, "linearization") }?.state;
        // SAFETY: null or room for `y_length` numbers, as the preamble demands.
        unsafe { room(y, y_length, state.len(), "y") }?.copy_from_slice(state);
        Ok(())
    };
    // SAFETY: `error` is null or memory for a pointer.
    unsafe { entry(error, read) }
}

/// Writes a matrix, a pc_linear_matrix, column-major; pc_linearization_count gives the numbers of
/// its rows and columns.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_linearization_matrix(
    linearization: *const pc_linearization,
    matrix: c_int,
    values: *mut f64,
    length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let read = || {
        // SAFETY: null or a live handle, as the preamble demands.
        let found = &unsafe { handle(linearization, "linearization") }?.found;
        let column_major = |of: &Matrix<f64>| -> Vec<f64> {
            (0..of.columns())
                .flat_map(|j| (0..of.rows()).map(move |i| (i, j)))
                .map(|place| of[place])
                .collect()
        };
        let entries = match matrix {
            0 => column_major(&found.state_matrix),
            1 => column_major(&found.input_matrix),
            2 => column_major(&found.output_matrix),
            3 => column_major(&found.feedthrough),
            4 => {
                let all = found.spectrum.eigenvalues();
                all.iter().map(|one| one.real).chain(all.iter().map(|one| one.imaginary)).collect()
            }
            value => return Err(CallError::Choice { what: "pc_linear_matrix", value: value.into() }),
        };
        // SAFETY: null or room for `length` numbers, as the preamble demands.
        unsafe { room(values, length, entries.len(), "values") }?.copy_from_slice(&entries);
        Ok(())
    };
    // SAFETY: `error` is null or memory for a pointer.
    unsafe { entry(error, read) }
}

/// Frees a linearization. NULL is allowed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_linearization_free(linearization: *mut pc_linearization) {
    // SAFETY: null or a handle of ours that nobody uses any more.
    unsafe { free(linearization) };
}

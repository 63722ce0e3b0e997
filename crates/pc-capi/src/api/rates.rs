//! f(t, y) and its derivatives.

use std::slice;

use pc_mech::VectorField;

use crate::ffi::boundary::succeeded;
use crate::ffi::call_error::CallError;
use crate::ffi::error::pc_error;
use crate::ffi::pointer::{apart, are_usable, finite, fresh, numbers, room, write};
use crate::ffi::status::pc_status;
use crate::machinery::system::{Inner, Inventory, Room, holding, inside, pc_system};

/// A state from C.
#[derive(Clone, Copy)]
pub(crate) struct State {
    pub(crate) y: *const f64,
    pub(crate) length: usize,
}

/// An array passed by C, to be written.
#[derive(Clone, Copy)]
pub(crate) struct Target {
    pub(crate) data: *mut f64,
    pub(crate) length: usize,
    pub(crate) expected: usize,
    pub(crate) what: &'static str,
}

/// The state and the array as slices.
///
/// # Safety
/// Both arrays are null or have the stated length.
#[inline]
pub(crate) unsafe fn slices<'a>(
    state: State,
    dim: usize,
    target: Target,
) -> Result<(&'a [f64], &'a mut [f64]), CallError> {
    let Target { data, length, expected, .. } = target;
    if state.length == dim && length == expected && are_usable((state.y, dim), (data, expected)) {
        // SAFETY: not null, aligned, and as promised; they share no memory.
        unsafe { Ok((slice::from_raw_parts(state.y, dim), fresh(data, expected))) }
    } else {
        // SAFETY: as promised.
        unsafe { misfits(state, dim, target) }
    }
}

/// The same as [`slices`], for the case in which a check fails or an array is empty.
///
/// # Safety
/// As for [`slices`].
#[cold]
unsafe fn misfits<'a>(
    state: State,
    dim: usize,
    target: Target,
) -> Result<(&'a [f64], &'a mut [f64]), CallError> {
    let Target { data, length, expected, what } = target;
    if state.length == dim && length == expected {
        apart((state.y, dim, "y"), (data, expected, what))?;
    }
    // SAFETY: as promised; they share no memory.
    unsafe { Ok((numbers(state.y, state.length, dim, "y")?, room(data, length, expected, what)?)) }
}

/// Returns an error unless all values are finite.
pub(crate) fn all_finite(what: &'static str, values: &[f64]) -> Result<(), CallError> {
    match values.iter().find(|value| !value.is_finite()) {
        Some(&value) => Err(CallError::NoValue { what, value }),
        None => Ok(()),
    }
}

/// Writes the rate f(t, y) of the state to ydot.
///
/// After the first call it takes no lock if f is a single piece of machine code, that is, if no
/// function of the program computes forces, M is not factorised numerically, and no velocities are
/// solved for. Any number of threads may then call it at the same time; while another thread sets
/// parameters, the rates are those for the parameters before or after. It returns PC_BUSY, with
/// ydot undefined, only if parameters are set during its evaluation, or if it fails while the
/// handle is in use.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_rhs(
    system: *const pc_system,
    t: f64,
    y: *const f64,
    y_length: usize,
    ydot: *mut f64,
    ydot_length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let (state, ydot) = (State { y, length: y_length }, (ydot, ydot_length));
    let evaluate = |system: &pc_system, inner: &mut Inner| {
        system.prepare_direct(inner);
        let dim = system.inventory.dim();
        let target = Target { data: ydot.0, length: ydot.1, expected: dim, what: "ydot" };
        // SAFETY: as the preamble demands.
        let (y, ydot) = unsafe { slices(state, dim, target) }?;
        Ok(inner.field.rhs(t, y, ydot)?)
    };
    // SAFETY: as the preamble demands.
    unsafe {
        if system.as_ref().is_some_and(|system| rates_without_lock(system, t, state, ydot)) {
            succeeded(error)
        } else {
            holding(system, error, evaluate)
        }
    }
}

/// Writes ydot using machine code alone; returns false if f is more than that, or fails, or the
/// parameters change during the call.
///
/// # Safety
/// Each array is null or has the stated length.
#[inline]
unsafe fn rates_without_lock(
    system: &pc_system,
    t: f64,
    state: State,
    (ydot, ydot_length): (*mut f64, usize),
) -> bool {
    let Some(direct) = system.direct() else { return false };
    let dim = direct.dim();
    // SAFETY: arrays of that length, as promised, which share no memory; the system, and so its field, lives.
    state.length == dim
        && ydot_length == dim
        && are_usable((state.y, dim), (ydot, dim))
        && unsafe { direct.rates(t, state.y, ydot) }
}

/// Writes ∂f/∂y, dim × dim and column-major, so `length` is dim*dim.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_jacobian(
    system: *const pc_system,
    t: f64,
    y: *const f64,
    y_length: usize,
    jacobian: *mut f64,
    length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let evaluate = |inventory: &Inventory, inner: &mut Inner| {
        let (state, dim) = (State { y, length: y_length }, inventory.dim());
        let target = Target { data: jacobian, length, expected: dim * dim, what: "jacobian" };
        // SAFETY: as the preamble demands.
        let (y, jacobian) = unsafe { slices(state, dim, target) }?;
        Ok(inner.field.jacobian(t, y, jacobian)?)
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, evaluate) }
}

/// The entries of ∂f/∂y that may be nonzero, in compressed columns: the rows of the entries of
/// column j, ascending, are `row_indices[column_starts[j]]` up to, but not including,
/// `row_indices[column_starts[j + 1]]`. Gives pointers to dim + 1 and `entries` numbers that
/// belong to the system and its copies. Each of the three arguments may be NULL.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_jacobian_pattern(
    system: *const pc_system,
    entries: *mut usize,
    column_starts: *mut *const usize,
    row_indices: *mut *const usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let get = || {
        // SAFETY: null or a live handle, as the preamble demands.
        let inventory = &unsafe { crate::ffi::pointer::handle(system, "system") }?.inventory;
        let pattern = inventory.pattern.as_ref().ok_or(NO_PATTERN)?;
        // SAFETY: null or places for results, as the preamble demands.
        unsafe {
            if !entries.is_null() {
                write(entries, pattern.len(), "entries")?;
            }
            if !column_starts.is_null() {
                write(column_starts, pattern.column_starts().as_ptr(), "column_starts")?;
            }
            if !row_indices.is_null() {
                write(row_indices, pattern.row_indices().as_ptr(), "row_indices")?;
            }
        }
        Ok(())
    };
    // SAFETY: `error` is null or memory for a pointer.
    unsafe { crate::ffi::boundary::entry(error, get) }
}

const NO_PATTERN: CallError =
    CallError::Unsupported { what: "the zero pattern of the Jacobian", why: "it has no Jacobian" };

/// Writes the entries of ∂f/∂y that pc_system_jacobian_pattern lists, in its order.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_sparse_jacobian(
    system: *const pc_system,
    t: f64,
    y: *const f64,
    y_length: usize,
    values: *mut f64,
    length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let evaluate = |inventory: &Inventory, inner: &mut Inner| {
        let (state, dim) = (State { y, length: y_length }, inventory.dim());
        let expected = inventory.pattern.as_ref().ok_or(NO_PATTERN)?.len();
        let target = Target { data: values, length, expected, what: "values" };
        // SAFETY: as the preamble demands.
        let (y, values) = unsafe { slices(state, dim, target) }?;
        inner.field.sparse_jacobian(t, y, values)?;
        all_finite("an entry of ∂f/∂y", values)
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, evaluate) }
}

/// Writes the product (∂f/∂y) v; all three arrays have the length dim.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_jvp(
    system: *const pc_system,
    t: f64,
    y: *const f64,
    y_length: usize,
    v: *const f64,
    v_length: usize,
    product: *mut f64,
    product_length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let evaluate = |inventory: &Inventory, inner: &mut Inner| {
        let (state, dim) = (State { y, length: y_length }, inventory.dim());
        let target = Target { data: product, length: product_length, expected: dim, what: "product" };
        if v_length == dim && product_length == dim {
            apart((v, dim, "v"), (product, dim, "product"))?;
        }
        // SAFETY: as the preamble demands; the product shares no memory with v.
        let v = unsafe { numbers(v, v_length, dim, "v") }?;
        // SAFETY: as the preamble demands.
        let (y, product) = unsafe { slices(state, dim, target) }?;
        let pattern = inventory.pattern.as_ref().ok_or(NO_PATTERN)?;
        let values = inner.room.numbers(pattern.len());
        inner.field.sparse_jacobian(t, y, values)?;
        product.fill(0.0);
        for ((i, j), value) in pattern.entries().zip(&*values) {
            product[i] += value * v[j];
        }
        all_finite("the product", product)
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, evaluate) }
}

/// Writes ∂f/∂p, dim × pc_system_parameter_count and column-major, so `length` is their product.
/// Each derivative is taken with all other parameters fixed, even those that are expressions in
/// this one; for an input with a table, the derivative is taken with respect to the value of the
/// input. Returns PC_UNSUPPORTED if pc_model_differentiate was not called, or if there are external
/// forces.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_parameter_jacobian(
    system: *const pc_system,
    t: f64,
    y: *const f64,
    y_length: usize,
    jacobian: *mut f64,
    length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let evaluate = |inventory: &Inventory, inner: &mut Inner| {
        if !inner.field.has_parameter_jacobian() {
            let why = "pc_model_differentiate was not called";
            return Err(CallError::Unsupported { what: "∂f/∂p", why });
        }
        let (state, dim) = (State { y, length: y_length }, inventory.dim());
        let expected = dim * inventory.parameters.len();
        let target = Target { data: jacobian, length, expected, what: "jacobian" };
        // SAFETY: as the preamble demands.
        let (y, jacobian) = unsafe { slices(state, dim, target) }?;
        Ok(inner.field.parameter_jacobian(t, y, jacobian)?)
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, evaluate) }
}

/// Writes ∂f/∂t, which Rosenbrock's methods need; it has the length of the state. The first call
/// derives it, as pc_system_new derives equations, unless f does not contain t. Returns
/// PC_UNSUPPORTED if there are external forces, whose ∂/∂t is unknown, or inputs that have tables.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_time_derivative(
    system: *const pc_system,
    t: f64,
    y: *const f64,
    y_length: usize,
    derivative: *mut f64,
    length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let evaluate = |inventory: &Inventory, inner: &mut Inner| {
        let unknown = |why| Err(CallError::Unsupported { what: "∂f/∂t", why });
        if !inventory.forces.is_empty() {
            return unknown("the time derivative of external forces is unknown");
        }
        if !inventory.model.parameter_values().tables().is_empty() {
            return unknown("there are inputs with tables");
        }
        let (state, dim) = (State { y, length: y_length }, inventory.dim());
        let target = Target { data: derivative, length, expected: dim, what: "derivative" };
        // SAFETY: as the preamble demands.
        let (y, derivative) = unsafe { slices(state, dim, target) }?;
        match inner.by_time(inventory)? {
            Some(motion) => Ok(motion.time_derivative(t, y, derivative)?),
            None => {
                derivative.fill(0.0);
                Ok(())
            }
        }
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, evaluate) }
}

/// Projects the state, in place: onto the constraints, along the shortest path in the kinetic
/// metric, and to the values that the integrals of pc_model_keep have at the start of the model, or
/// at the state of pc_system_keep_from. With neither constraints nor such integrals the state stays
/// as it is.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_project(
    system: *const pc_system,
    t: f64,
    y: *mut f64,
    y_length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let project = |inventory: &Inventory, inner: &mut Inner| {
        // SAFETY: as the preamble demands.
        let given = unsafe { numbers(y, y_length, inventory.dim(), "y") }?;
        let Inner { field, room: Room { state, .. }, .. } = inner;
        state.copy_from_slice(given);
        if field.has_projection() {
            field.project(t, state)?;
        }
        all_finite("a component of the state", state)?;
        // SAFETY: as the preamble demands.
        unsafe { room(y, y_length, inventory.dim(), "y") }?.copy_from_slice(state);
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, project) }
}

/// Makes pc_system_project keep the integrals of pc_model_keep at their values at (t, y),
/// moved onto the constraints, also after parameters are set. Solvers maintain the values at their
/// own start.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_system_keep_from(
    system: *mut pc_system,
    t: f64,
    y: *const f64,
    y_length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let keep = |inventory: &Inventory, inner: &mut Inner| {
        let t = finite(t, "t")?;
        // SAFETY: as the preamble demands.
        let y = unsafe { numbers(y, y_length, inventory.dim(), "y") }?;
        for &value in y {
            finite(value, "a number of y")?;
        }
        inner.keep_from(t, y);
        Ok(())
    };
    // SAFETY: as the preamble demands.
    unsafe { inside(system, error, keep) }
}

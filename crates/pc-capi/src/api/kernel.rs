//! The right-hand side as a plain function pointer with a context.

use std::ffi::{c_int, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::slice;

use pc_mech::VectorField;

use crate::ffi::boundary::entry;
use crate::ffi::call_error::CallError;
use crate::ffi::error::pc_error;
use crate::ffi::pointer::{are_usable, clear, free, fresh, numbers, write};
use crate::ffi::status::pc_status;
use crate::machinery::motion_field::MotionField;
use crate::machinery::own_rhs::Own;
use crate::machinery::system::{Inner, holding, pc_system};

/// f(t, y) for an integrator of your own: the context of pc_kernel_rhs and pc_kernel_jacobian.
/// Free it with pc_kernel_free.
///
/// It holds workspace, so each thread needs its own kernel, and two calls at the same time are not
/// safe; in return it takes no locks.
pub struct pc_kernel {
    dim: usize,
    own: Option<Own>,
    motion: MotionField,
}

impl pc_kernel {
    fn new(mut motion: MotionField, dim: usize) -> pc_kernel {
        let own = Own::of(&mut motion);
        pc_kernel { dim, own, motion }
    }
}

/// Makes a kernel of the system with its current parameters.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_kernel_new(
    system: *const pc_system,
    kernel: *mut *mut pc_kernel,
    error: *mut *mut pc_error,
) -> pc_status {
    let new = |system: &pc_system, inner: &mut Inner| {
        // The clone below shares what is compiled before it.
        system.prepare_direct(inner);
        let made = Box::new(pc_kernel::new(inner.field.clone(), system.inventory.dim()));
        // SAFETY: null or memory for a handle, as the preamble demands.
        unsafe { write(kernel, Box::into_raw(made), "kernel") }
    };
    let checked = || {
        // SAFETY: as the preamble demands.
        unsafe { clear(kernel, "kernel") }
    };
    // SAFETY: `error` is null or memory for a pointer.
    match unsafe { entry(error, checked) } {
        // SAFETY: as the preamble demands.
        pc_status::PC_OK => unsafe { holding(system, error, new) },
        refused => refused,
    }
}

/// Frees a kernel. NULL is allowed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_kernel_free(kernel: *mut pc_kernel) {
    // SAFETY: null or a handle of ours that nobody uses any more.
    unsafe { free(kernel) };
}

/// Sets all parameters of a kernel, in the order of pc_system_parameter_name.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_kernel_set_parameters(
    kernel: *mut pc_kernel,
    values: *const f64,
    length: usize,
    error: *mut *mut pc_error,
) -> pc_status {
    let set = || {
        // SAFETY: null or a live kernel that no other thread uses, as its documentation demands.
        let kernel = unsafe { kernel.as_mut() }.ok_or(CallError::Null { what: "kernel" })?;
        let parameters = kernel.motion.parameters_mut();
        // SAFETY: null or `length` numbers, as the preamble demands.
        let values = unsafe { numbers(values, length, parameters.len(), "values") }?;
        if let Some(&value) = values.iter().find(|value| !value.is_finite()) {
            return Err(CallError::NotFinite { what: "a parameter", value });
        }
        parameters.copy_from_slice(values);
        if let Some(own) = &mut kernel.own {
            own.read_parameters(&mut kernel.motion);
        }
        Ok(())
    };
    // SAFETY: `error` is null or memory for a pointer.
    unsafe { entry(error, set) }
}

/// Writes ydot = f(t, y), both of pc_system_dim numbers, which is not checked; they must not
/// share memory. `kernel` is a pc_kernel of this thread.
///
/// Returns 0 on success, 1 where f cannot be evaluated but a smaller step may help, and −1 where no
/// step helps. pc_system_rhs at the same (t, y) says why. It has the form of the functions that
/// GSL's odeiv2 takes, with the kernel as `params`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_kernel_rhs(t: f64, y: *const f64, ydot: *mut f64, kernel: *mut c_void) -> c_int {
    // SAFETY: a kernel, whose motion lives, and disjoint arrays of its dimension, as the
    // documentation demands.
    unsafe {
        if let Some(pc_kernel { dim, own: Some(own), .. }) = kernel.cast::<pc_kernel>().as_mut()
            && are_usable((y, *dim), (ydot, *dim))
            && own.rates(t, y, ydot)
        {
            return 0;
        }
        rates_of_motion(t, y, ydot, kernel)
    }
}

/// The same by the motion itself, where there is no machine code, and to tell failures apart.
///
/// # Safety
/// As for [`pc_kernel_rhs`].
#[cold]
#[inline(never)] // so that the fast way needs no registers to be saved
unsafe fn rates_of_motion(t: f64, y: *const f64, ydot: *mut f64, kernel: *mut c_void) -> c_int {
    // SAFETY: as promised.
    unsafe { evaluate(y, ydot, kernel, |dim| dim, |motion, y, ydot| motion.rhs(t, y, ydot)) }
}

/// Writes ∂f/∂y, dim × dim and column-major; otherwise it is like pc_kernel_rhs. The first call
/// compiles it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_kernel_jacobian(
    t: f64,
    y: *const f64,
    jacobian: *mut f64,
    kernel: *mut c_void,
) -> c_int {
    // SAFETY: a kernel and arrays of its dimension, as the documentation demands.
    unsafe { evaluate(y, jacobian, kernel, |dim| dim * dim, |motion, y, j| motion.jacobian(t, y, j)) }
}

/// Writes f(t, y) for `count` states, which are given one after the other in `states`, to `rates`,
/// in the same order. Otherwise it is like pc_kernel_rhs: it returns 1 if f cannot be evaluated at
/// some states, whose rates are then NaN; it returns −1 at a state where no step helps, and does
/// not write the rates of the states after it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn pc_kernel_rhs_many(
    t: f64,
    states: *const f64,
    count: usize,
    rates: *mut f64,
    kernel: *mut c_void,
) -> c_int {
    // SAFETY: null or a live kernel, as the documentation demands.
    let Some(dim) = (unsafe { kernel.cast::<pc_kernel>().as_ref() }).map(|kernel| kernel.dim) else {
        return -1;
    };
    let most = isize::MAX as usize / size_of::<f64>();
    let Some(len) = dim.checked_mul(count).filter(|&len| len <= most) else { return -1 };
    if count == 0 {
        return 0;
    }
    if !are_usable((states, len), (rates, len)) {
        return -1;
    }
    let mut answer = 0;
    for place in (0..len).step_by(dim.max(1)) {
        // SAFETY: within disjoint arrays of that length, as the documentation demands.
        unsafe {
            match pc_kernel_rhs(t, states.add(place), rates.add(place), kernel) {
                0 => {}
                1 => {
                    fresh(rates.add(place), dim);
                    answer = 1;
                }
                fatal => return fatal,
            }
        }
    }
    answer
}

/// # Safety
/// `kernel` is null or a live `pc_kernel` that no other thread uses, `y` is null or has the length
/// of its state, and `target` is null or has length `len`.
#[inline]
unsafe fn evaluate(
    y: *const f64,
    target: *mut f64,
    kernel: *mut c_void,
    len: impl FnOnce(usize) -> usize,
    function: impl FnOnce(&mut MotionField, &[f64], &mut [f64]) -> Result<(), pc_expr::Failure>,
) -> c_int {
    // SAFETY: as promised.
    let Some(kernel) = (unsafe { kernel.cast::<pc_kernel>().as_mut() }) else { return -1 };
    let (dim, len) = (kernel.dim, len(kernel.dim));
    if !are_usable((y, dim), (target, len)) {
        return -1;
    }
    // SAFETY: not null, aligned, and as promised; they share no memory.
    let (y, target) = unsafe { (slice::from_raw_parts(y, dim), fresh(target, len)) };
    // Unwind safe: a panic leaves other numbers in the scratch, which is written before it is read.
    match catch_unwind(AssertUnwindSafe(|| function(&mut kernel.motion, y, target))) {
        Ok(Ok(())) => 0,
        Ok(Err(failure)) if failure.is_recoverable() => 1,
        _ => -1,
    }
}

/// The dimension of a kernel's state; 0 for NULL.
#[unsafe(no_mangle)]
pub extern "C" fn pc_kernel_dim(kernel: Option<&pc_kernel>) -> usize {
    kernel.map_or(0, |kernel| kernel.dim)
}

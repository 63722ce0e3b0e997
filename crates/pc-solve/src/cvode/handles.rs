//! Owning handles of the SUNDIALS objects of one solver.
//!
//! Each frees its object when dropped and must be dropped before its [`Context`].

use std::ffi::{c_int, c_void};
use std::ptr::NonNull;
use std::slice;

use sundials_sys as sys;

use crate::cvode::context::Context;
use crate::cvode::operations;
use crate::error::SolveError;

/// A serial `N_Vector`.
pub(crate) struct Vector {
    raw: NonNull<sys::_generic_N_Vector>,
    data: NonNull<f64>,
    len: usize,
}

impl Vector {
    pub(crate) fn new(context: &mut Context, values: &[f64]) -> Result<Self, SolveError> {
        // SAFETY: the context is live; a slice is never longer than i64::MAX.
        let raw = unsafe { sys::N_VNew_Serial(values.len() as sys::sunindextype, context.raw()) };
        let raw = context.check_new("N_VNew_Serial", raw)?;
        // SAFETY: the vector is live, serial and ours alone.
        unsafe { operations::install(raw.as_ptr()) };
        let mut vector = Vector { raw, data: NonNull::dangling(), len: values.len() };
        // SAFETY: the vector is live and serial; its data stay in place as long as it lives.
        let data = unsafe { numbers_of(vector.raw()) };
        vector.data = context.check_new("N_VNew_Serial", data)?;
        // SAFETY: the data have room for `values.len()` numbers and are not part of `values`.
        unsafe { vector.data.as_ptr().copy_from_nonoverlapping(values.as_ptr(), values.len()) };
        Ok(vector)
    }

    /// Makes an instance of CVODES that starts from this vector repeat any step that violates an
    /// inequality, with at most half its length.
    ///
    /// As the factor for the length, CVODES takes 0.9 times the smallest quotient of two vectors,
    /// which it uses for nothing else. It forms the quotient with the prediction instead of the
    /// last state, so that it is infinite where the prediction is exact.
    pub(crate) fn halve_after_violations(&mut self) {
        // SAFETY: the vector is live and ours alone, and so is its table of operations, which
        // clones copy.
        unsafe { (*(*self.raw.as_ptr()).ops).nvminquotient = Some(bounded_quotient) };
    }

    pub(crate) fn raw(&self) -> sys::N_Vector {
        self.raw.as_ptr()
    }

    pub(crate) fn as_slice(&self) -> &[f64] {
        // SAFETY: `data` holds `len` initialised numbers, which only a call given this vector
        // changes.
        unsafe { slice::from_raw_parts(self.data.as_ptr(), self.len) }
    }

    pub(crate) fn as_mut_slice(&mut self) -> &mut [f64] {
        // SAFETY: as for `as_slice`, and borrowed exclusively.
        unsafe { slice::from_raw_parts_mut(self.data.as_ptr(), self.len) }
    }
}

/// The address of the numbers in a vector. `N_VGetArrayPointer` calls through a table, whose cost
/// is noticeable for small systems.
///
/// # Safety
/// The vector is live and serial.
#[inline]
pub(crate) unsafe fn numbers_of(vector: sys::N_Vector) -> *mut f64 {
    // SAFETY: a serial vector has this layout.
    unsafe { (*(*vector).content.cast::<sys::_N_VectorContent_Serial>()).data }
}

/// The smallest quotient of corresponding components, or 0.5/0.9 if that is smaller.
unsafe extern "C" fn bounded_quotient(numerator: sys::N_Vector, denominator: sys::N_Vector) -> f64 {
    // SAFETY: both are live serial vectors of the same length.
    unsafe { sys::N_VMinQuotient_Serial(numerator, denominator) }.min(0.5 / 0.9)
}

impl Drop for Vector {
    fn drop(&mut self) {
        // SAFETY: the vector is owned.
        unsafe { sys::N_VDestroy(self.raw.as_ptr()) };
    }
}

/// A `SUNNonlinearSolver`: Newton's or the fixed-point iteration.
pub(crate) struct NonlinearIteration(NonNull<sys::_generic_SUNNonlinearSolver>);

impl NonlinearIteration {
    pub(crate) fn newton(context: &mut Context, y: &Vector) -> Result<Self, SolveError> {
        // SAFETY: both are live and of one context; `y` is only a template to clone.
        let raw = unsafe { sys::SUNNonlinSol_Newton(y.raw(), context.raw()) };
        context.check_new("SUNNonlinSol_Newton", raw).map(NonlinearIteration)
    }

    pub(crate) fn fixed_point(context: &mut Context, y: &Vector) -> Result<Self, SolveError> {
        let acceleration_vectors = 0;
        // SAFETY: both are live and of one context; `y` is only a template to clone.
        let raw = unsafe { sys::SUNNonlinSol_FixedPoint(y.raw(), acceleration_vectors, context.raw()) };
        context.check_new("SUNNonlinSol_FixedPoint", raw).map(NonlinearIteration)
    }

    /// Newton's iteration, for `count` vectors at a time.
    pub(crate) fn newton_of(context: &mut Context, count: c_int, y: &Vector) -> Result<Self, SolveError> {
        // SAFETY: both are live and of one context; `y` is only a template to clone.
        let raw = unsafe { sys::SUNNonlinSol_NewtonSens(count, y.raw(), context.raw()) };
        context.check_new("SUNNonlinSol_NewtonSens", raw).map(NonlinearIteration)
    }

    /// The fixed-point iteration, for `count` vectors at a time.
    pub(crate) fn fixed_point_of(
        context: &mut Context,
        count: c_int,
        y: &Vector,
    ) -> Result<Self, SolveError> {
        let acceleration_vectors = 0;
        // SAFETY: both are live and of one context; `y` is only a template to clone.
        let raw =
            unsafe { sys::SUNNonlinSol_FixedPointSens(count, y.raw(), acceleration_vectors, context.raw()) };
        context.check_new("SUNNonlinSol_FixedPointSens", raw).map(NonlinearIteration)
    }

    pub(crate) fn raw(&self) -> sys::SUNNonlinearSolver {
        self.0.as_ptr()
    }
}

impl Drop for NonlinearIteration {
    fn drop(&mut self) {
        // SAFETY: the nonlinear solver is owned; CVODES frees only those it made itself.
        unsafe { sys::SUNNonlinSolFree(self.0.as_ptr()) };
    }
}

/// A type that CVODES takes by value and that is not an address.
pub(crate) trait Number {}
impl Number for f64 {}
impl Number for c_int {}

/// The memory block of CVODES.
pub(crate) struct Memory(*mut c_void);

impl Memory {
    pub(crate) fn new(context: &mut Context, method: c_int) -> Result<Self, SolveError> {
        // SAFETY: the context is live.
        let raw = unsafe { sys::CVodeCreate(method, context.raw()) };
        context.check_new("CVodeCreate", raw).map(|raw| Memory(raw.as_ptr()))
    }

    pub(crate) fn raw(&self) -> *mut c_void {
        self.0
    }

    /// Calls a set-up `function` of CVODES that takes one `value`, once CVODES has been
    /// initialised.
    pub(crate) fn set<T: Number>(
        &self,
        context: &mut Context,
        name: &'static str,
        function: unsafe extern "C" fn(*mut c_void, T) -> c_int,
        value: T,
    ) -> Result<(), SolveError> {
        // SAFETY: the memory is live; values are numbers, which CVODES checks.
        context.check(name, unsafe { function(self.0, value) })
    }
}

impl Drop for Memory {
    fn drop(&mut self) {
        // SAFETY: the memory is owned; what it refers to is dropped later.
        unsafe { sys::CVodeFree(&raw mut self.0) };
    }
}

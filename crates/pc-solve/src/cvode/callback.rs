//! Callbacks from CVODES to a [`VectorField`], which handle failures, panics and non-finite values.

use std::any::Any;
use std::ffi::{c_int, c_void};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::ptr::NonNull;
use std::slice;

use pc_expr::{Failure, VectorField};
use sundials_sys as sys;

use crate::cvode::forward::variation::Variation;
use crate::cvode::handles::numbers_of;
use crate::cvode::integrals::Integrands;
use crate::cvode::linear::work::Work;
use crate::cvode::projection::Offset;
use crate::error::NonFinite;

pub(crate) const SUCCESS: c_int = 0;
const RECOVERABLE: c_int = 1;
pub(crate) const FATAL: c_int = -1;

/// What the callbacks read and write.
pub(crate) struct Callbacks<F> {
    pub(crate) field: F,
    pub(crate) dim: usize,
    pub(crate) linear: Work,
    /// Converts the vectors of CVODES to states, if the field has a projection.
    offset: Option<Offset>,
    /// The last failure, until it is taken.
    failure: Option<Failure>,
    panic: Option<Box<dyn Any + Send>>,
    /// The equations of variation, if sensitivities are requested.
    pub(crate) variation: Variation,
    /// The integrands, if integrals are requested.
    pub(crate) integrands: Option<Integrands>,
}

impl<F: VectorField> Callbacks<F> {
    pub(crate) fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> c_int {
        self.guard(|field, offset| {
            let y = offset.map_or(y, |offset| offset.state_of(y));
            field.rhs(t, y, ydot)?;
            if field.checks_rates() {
                return Ok(());
            }
            match ydot.iter().position(|rate| !rate.is_finite()) {
                None => Ok(()),
                Some(i) => Err(Failure::recoverable(NonFinite::Rate {
                    component: field.component_name(i),
                    value: ydot[i],
                    t,
                })),
            }
        })
    }

    /// Calls `evaluate`, stores its failure or panic for the caller of CVODES, and returns the code
    /// that CVODES expects.
    pub(crate) fn guard(
        &mut self,
        evaluate: impl FnOnce(&mut F, Option<&mut Offset>) -> Result<(), Failure>,
    ) -> c_int {
        if self.panic.is_some() {
            return FATAL;
        }
        let (field, offset) = (&mut self.field, self.offset.as_mut());
        // Unwind safe: the panic resumes in the caller as soon as CVODES has returned.
        match catch_unwind(AssertUnwindSafe(|| evaluate(field, offset))) {
            Ok(Ok(())) => SUCCESS,
            Ok(Err(failure)) => {
                let answer = if failure.is_recoverable() { RECOVERABLE } else { FATAL };
                self.failure = Some(failure);
                answer
            }
            Err(panic) => {
                self.panic = Some(panic);
                FATAL
            }
        }
    }
}

/// An owned [`Callbacks`] at a fixed address, which CVODES may keep.
pub(crate) struct UserData<F>(NonNull<Callbacks<F>>);

impl<F> UserData<F> {
    pub(crate) fn new(field: F, dim: usize) -> Self
    where
        F: VectorField,
    {
        let offset = field.has_projection().then(|| Offset::new(dim));
        let callbacks = Callbacks {
            field,
            dim,
            linear: Work::default(),
            offset,
            failure: None,
            panic: None,
            variation: Variation::default(),
            integrands: None,
        };
        UserData(NonNull::from(Box::leak(Box::new(callbacks))))
    }

    /// The address to pass to `CVodeSetUserData`.
    pub(crate) fn address(&self) -> *mut c_void {
        self.0.as_ptr().cast()
    }

    pub(crate) fn field(&self) -> &F {
        // SAFETY: owned and live; callbacks run only in calls that borrow the owner exclusively.
        &unsafe { self.0.as_ref() }.field
    }

    /// The data of the callbacks of the linear solver.
    pub(crate) fn linear(&self) -> &Work {
        // SAFETY: owned and live; callbacks run only in calls that borrow the owner exclusively.
        &unsafe { self.0.as_ref() }.linear
    }

    pub(crate) fn set_linear(&mut self, work: Work) {
        // SAFETY: owned and live, borrowed exclusively.
        unsafe { self.0.as_mut() }.linear = work;
    }

    /// Notes that CVODES has been reinitialised at y(t) = y.
    pub(crate) fn restart(&mut self, t: f64, y: &[f64])
    where
        F: VectorField,
    {
        // SAFETY: owned and live, borrowed exclusively.
        unsafe { self.0.as_mut() }.field.restart(t, y);
        self.begin_anew();
    }

    /// Notes that CVODES has been reinitialised at its current state.
    pub(crate) fn begin_anew(&mut self) {
        // SAFETY: owned and live, borrowed exclusively.
        let callbacks = unsafe { self.0.as_mut() };
        callbacks.linear.forget_counts();
        if let Some(offset) = &mut callbacks.offset {
            offset.clear();
        }
    }

    pub(crate) fn into_field(self) -> F {
        let callbacks = std::mem::ManuallyDrop::new(self).0;
        // SAFETY: made by `Box::leak` in `new`, and `drop` will not run.
        unsafe { Box::from_raw(callbacks.as_ptr()) }.field
    }

    /// The vector field, and the offset of its states if the field has a projection.
    pub(crate) fn projection(&mut self) -> Option<(&mut F, &mut Offset)> {
        // SAFETY: owned and live, borrowed exclusively.
        let callbacks = unsafe { self.0.as_mut() };
        callbacks.offset.as_mut().map(|offset| (&mut callbacks.field, offset))
    }

    /// Evaluates f at a vector of CVODES, outside calls of CVODES; returns whether the evaluation
    /// succeeded. A panic resumes.
    pub(crate) fn look(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> bool
    where
        F: VectorField,
    {
        // SAFETY: owned and live, borrowed exclusively.
        let callbacks = unsafe { self.0.as_mut() };
        ydot.fill(f64::NAN);
        let answer = callbacks.rhs(t, y, ydot);
        if let Some(panic) = callbacks.panic.take() {
            resume_unwind(panic);
        }
        callbacks.failure = None; // CVODES meets it if it gets there
        answer == SUCCESS
    }

    /// The field, for use outside calls of CVODES.
    pub(crate) fn field_mut(&mut self) -> &mut F {
        // SAFETY: owned and live, borrowed exclusively.
        &mut unsafe { self.0.as_mut() }.field
    }

    pub(crate) fn variation(&self) -> &Variation {
        // SAFETY: owned and live; callbacks run only in calls that borrow the owner exclusively.
        &unsafe { self.0.as_ref() }.variation
    }

    pub(crate) fn set_variation(&mut self, variation: Variation) {
        // SAFETY: owned and live, borrowed exclusively.
        unsafe { self.0.as_mut() }.variation = variation;
    }

    pub(crate) fn set_integrands(&mut self, integrands: Integrands) {
        // SAFETY: owned and live, borrowed exclusively.
        unsafe { self.0.as_mut() }.integrands = Some(integrands);
    }

    pub(crate) fn take_failure(&mut self) -> Option<Failure> {
        // SAFETY: owned and live, borrowed exclusively.
        unsafe { self.0.as_mut() }.failure.take()
    }

    pub(crate) fn take_panic(&mut self) -> Option<Box<dyn Any + Send>> {
        // SAFETY: owned and live, borrowed exclusively.
        unsafe { self.0.as_mut() }.panic.take()
    }
}

impl<F> Drop for UserData<F> {
    fn drop(&mut self) {
        // SAFETY: made by `Box::leak` in `new`, and owned.
        drop(unsafe { Box::from_raw(self.0.as_ptr()) });
    }
}

/// `CVRhsFn`.
///
/// # Safety
/// Called by CVODES with the address of a [`UserData<F>`] and vectors of its dimension.
pub(crate) unsafe extern "C" fn rhs<F: VectorField>(
    t: f64,
    y: sys::N_Vector,
    ydot: sys::N_Vector,
    user_data: *mut c_void,
) -> c_int {
    // SAFETY: the address is of a live `Callbacks<F>`, which nobody else uses during a call of
    // CVODES.
    let callbacks = unsafe { &mut *user_data.cast::<Callbacks<F>>() };
    // SAFETY: `y` and `ydot` are live serial vectors of length `dim`, distinct from each other.
    let (y, ydot) = unsafe {
        let y = slice::from_raw_parts(numbers_of(y), callbacks.dim);
        (y, nan_slice(numbers_of(ydot), callbacks.dim))
    };
    callbacks.rhs(t, y, ydot)
}

/// The `len` numbers at `data` as a slice, all set to NaN to detect entries that the field leaves
/// unwritten.
///
/// # Safety
/// `data` has room for `len` numbers, which nothing else uses during `'a`; the numbers need not be
/// initialised.
pub(crate) unsafe fn nan_slice<'a>(data: *mut f64, len: usize) -> &'a mut [f64] {
    for i in 0..len {
        // SAFETY: within the room promised.
        unsafe { data.add(i).write(f64::NAN) };
    }
    // SAFETY: initialised just now, and ours alone.
    unsafe { slice::from_raw_parts_mut(data, len) }
}

//! States inside the last internal step.

use std::ffi::c_int;

use pc_expr::VectorField;
use sundials_sys as sys;

use crate::cvode::cvode::Cvode;
use crate::error::{Reason, SolveError};
use crate::integration::stepper::LastStep;

impl<F: VectorField> Cvode<F> {
    /// The start and end of the last step, and its order.
    pub(crate) fn step_made(&self) -> LastStep {
        let end = self.step_time;
        if self.direction.is_none() || self.restarted {
            return LastStep { start: end, end, degree: None };
        }
        let (mut length, mut degree): (f64, c_int) = (0.0, 0);
        let memory = self.memory.raw();
        // SAFETY: the memory is live and initialised; the others are places for the results.
        unsafe {
            sys::CVodeGetLastStep(memory, &raw mut length);
            sys::CVodeGetLastOrder(memory, &raw mut degree);
        }
        LastStep { start: end - length, end, degree: u32::try_from(degree).ok() }
    }

    /// Writes the derivative of y of the given order at `t`, in the last step, to the work vector.
    pub(crate) fn interpolate_to_work(&mut self, t: f64, order: u32) -> Result<(), SolveError> {
        let order = i32::try_from(order).unwrap_or(i32::MAX);
        // SAFETY: memory and vector are live and of one context; a step has been taken.
        let code = unsafe { sys::CVodeGetDky(self.memory.raw(), t, order, self.work.raw()) };
        if code != sys::CV_SUCCESS {
            let reason = Reason::Cvode { code: code.into(), message: self.context.take_messages() };
            return Err(self.error(reason, None));
        }
        if order == 0 { self.project(t, false) } else { Ok(()) }
    }
}

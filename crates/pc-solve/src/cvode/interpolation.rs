//! States inside the last internal step.

use pc_expr::VectorField;
use sundials_sys as sys;

use crate::cvode::cvode::Cvode;
use crate::error::{InputError, Reason, SolveError};
use crate::integration::options::finite;

impl<F: VectorField> Cvode<F> {
    /// The derivative of y of the given order at `t` in the last internal step, by the polynomial of the method.
    ///
    /// Order 0 is y itself, [projected](VectorField::project) where the field does so. The polynomial has the degree of
    /// the order of that step.
    ///
    /// # Errors
    /// [`InputError::NoStep`] before the first step, [`InputError::OutsideStep`] outside the last step, and
    /// [`InputError::DerivativeOrder`] above the degree; [`Reason::Projection`].
    pub fn interpolate(&mut self, t: f64, order: u32) -> Result<&[f64], SolveError> {
        finite("the time", t)?;
        if self.direction.is_none() {
            return Err(InputError::NoStep.into());
        }
        self.check_inside(t, order, self.step_time)?;
        let stands_at = self.time;
        let outcome = self.interpolate_to_work(t, order);
        self.time = stands_at; // which a failed projection moves
        outcome?;
        Ok(self.work.as_slice())
    }

    /// Checks that `t` lies in the last internal step, as far as that is asked for up to `end`, and that its polynomial has
    /// a derivative of that order.
    ///
    /// As CVODES does, a time may lie outside by its rounding, 100 ε of the time.
    pub(crate) fn check_inside(&self, t: f64, order: u32, end: f64) -> Result<(), InputError> {
        let (mut now, mut length, mut degree) = (0.0, 0.0, 0);
        let memory = self.memory.raw();
        // SAFETY: the memory is live and initialised; the others are places for the results.
        unsafe {
            sys::CVodeGetCurrentTime(memory, &raw mut now);
            sys::CVodeGetLastStep(memory, &raw mut length);
            sys::CVodeGetLastOrder(memory, &raw mut degree);
        }
        let (start, direction) = (now - length, 1.0_f64.copysign(length));
        let slack = 100.0 * f64::EPSILON * (now.abs() + length.abs());
        if (start - t) * direction > slack || (t - end) * direction > slack {
            return Err(InputError::OutsideStep { requested: t, start, end });
        }
        let highest = u32::try_from(degree).unwrap_or(0);
        if order > highest {
            return Err(InputError::DerivativeOrder { order, highest });
        }
        Ok(())
    }

    /// As [`interpolate`](Cvode::interpolate), where it has been checked that this can be.
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

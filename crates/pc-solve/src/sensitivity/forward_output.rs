//! Sensitivities inside internal steps.

use std::ops::ControlFlow;

use pc_expr::VectorField;
use sundials_sys as sys;

use crate::cvode::cvode::{Cvode, Ending};
use crate::cvode::handles::Vector;
use crate::error::{InputError, Reason, SolveError};
use crate::integration::dense_output::Segment;
use crate::integration::options::finite;

impl<F: VectorField> Cvode<F> {
    /// The derivative of S of the given order at `t` in the last internal step, by the polynomial of the method, column-major
    /// as [`sensitivities`](Cvode::sensitivities).
    ///
    /// # Errors
    /// As for [`interpolate`](Cvode::interpolate); [`InputError::NoSensitivities`] if there are none.
    pub fn interpolate_sensitivities(&mut self, t: f64, order: u32) -> Result<Vec<f64>, SolveError> {
        finite("the time", t)?;
        if self.direction.is_none() {
            return Err(InputError::NoStep.into());
        }
        self.check_inside(t, order, self.step_time)?;
        self.sensitivities_by_time(t, order)?.ok_or_else(|| InputError::NoSensitivities.into())
    }

    /// The same, where it has been checked that `t` is in the step and what the degree is; none where there is nothing but a
    /// start.
    pub(crate) fn sensitivities_by_time(&self, t: f64, order: u32) -> Result<Option<Vec<f64>>, SolveError> {
        let Some(forward) = self.sensitivity.as_ref().filter(|_| self.direction.is_some() && !self.restarted)
        else {
            return Ok(None);
        };
        let mut raw = forward.raw();
        let k = i32::try_from(order).unwrap_or(i32::MAX);
        // SAFETY: a step has been taken with sensitivities; there are as many vectors as columns, which nobody looks at.
        let code = unsafe { sys::CVodeGetSensDky(self.memory.raw(), t, k, raw.as_mut_ptr()) };
        if code != sys::CV_SUCCESS {
            let message = format!("the sensitivities at t = {t} cannot be interpolated");
            return Err(self.error(Reason::Cvode { code: code.into(), message }, None));
        }
        Ok(Some(forward.columns.iter().flat_map(Vector::as_slice).copied().collect()))
    }

    /// As [`run_dense`](Cvode::run_dense), with the segment of S of the same span, whose components are its entries,
    /// column-major.
    ///
    /// # Errors
    /// As there; [`InputError::NoSensitivities`] if there are none.
    pub fn run_dense_with_sensitivities(
        &mut self,
        end: f64,
        mut segments: impl FnMut(Segment, Segment) -> ControlFlow<()>,
    ) -> Result<Ending, SolveError> {
        self.check_times(&[end])?;
        let mut steps = 0;
        loop {
            let (from, state) = (self.time, self.state().to_vec());
            if from == end {
                return Ok(Ending::Completed);
            }
            if from == self.step_time {
                self.check_steps(steps, end)?;
                self.internal_step(end)?;
                steps += 1;
            }
            let direction = 1.0_f64.copysign(end - from);
            let next = if (self.step_time - end) * direction > 0.0 { end } else { self.step_time };
            if next != self.step_time {
                self.interpolate_to_work(next, 0)?;
                std::mem::swap(&mut self.output, &mut self.work);
            }
            self.time = next;
            let reached = self.state().to_vec();
            let of_state = self.segment((from, &state), (next, &reached))?;
            let of_matrix = self.segment_of_sensitivities(from, next)?;
            if next != from && segments(of_state, of_matrix).is_break() {
                return Ok(Ending::Stopped);
            }
        }
    }

    /// S along the last internal step, between two of its times: nothing moves S after a step, so that the polynomial begins
    /// where the step did, to rounding.
    pub(crate) fn segment_of_sensitivities(&self, start: f64, end: f64) -> Result<Segment, SolveError> {
        let mut order = 0;
        // SAFETY: the memory is live and initialised; `order` is a place for the result.
        unsafe { sys::CVodeGetLastOrder(self.memory.raw(), &raw mut order) };
        let at = |k: u32| -> Result<Vec<f64>, SolveError> {
            self.sensitivities_by_time(end, k)?.ok_or_else(|| InputError::NoSensitivities.into())
        };
        let mut segment = Segment::new(start, (end, &at(0)?));
        for k in 1..=u32::try_from(order).unwrap_or(0) {
            segment.push(k, &at(k)?);
        }
        Ok(segment)
    }
}

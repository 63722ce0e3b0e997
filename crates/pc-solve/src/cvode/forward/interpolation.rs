//! Sensitivities inside the last internal step.

use pc_expr::VectorField;
use sundials_sys as sys;

use crate::cvode::cvode::Cvode;
use crate::cvode::handles::Vector;
use crate::error::{InputError, Reason, SolveError};
use crate::integration::dense_output::Segment;

impl<F: VectorField> Cvode<F> {
    /// S at `t` in the last step; none before the first step.
    pub(crate) fn sensitivities_at(&self, t: f64) -> Result<Option<Vec<f64>>, SolveError> {
        self.sensitivities_by_time(t, 0)
    }

    /// The derivative of S of the given order at `t` in the last step, column-major; none before
    /// the first step.
    pub(crate) fn sensitivities_by_time(&self, t: f64, order: u32) -> Result<Option<Vec<f64>>, SolveError> {
        let Some(forward) = self.sensitivity.as_ref().filter(|_| self.direction.is_some() && !self.restarted)
        else {
            return Ok(None);
        };
        let mut raw = forward.raw();
        let k = i32::try_from(order).unwrap_or(i32::MAX);
        // SAFETY: a step has been taken with sensitivities; there is a vector for each column, and
        // nobody borrows them.
        let code = unsafe { sys::CVodeGetSensDky(self.memory.raw(), t, k, raw.as_mut_ptr()) };
        if code != sys::CV_SUCCESS {
            let message = format!("the sensitivities at t = {t} cannot be interpolated");
            return Err(self.error(Reason::Cvode { code: code.into(), message }, None));
        }
        Ok(Some(forward.columns.iter().flat_map(Vector::as_slice).copied().collect()))
    }

    /// S as a function of time, between two times in the last internal step. S is not projected
    /// after a step, so that the polynomials of successive steps agree where they meet, up to
    /// rounding error.
    pub(crate) fn segment_of_sensitivities(&self, start: f64, end: f64) -> Result<Segment, SolveError> {
        let at = |k: u32| -> Result<Vec<f64>, SolveError> {
            self.sensitivities_by_time(end, k)?.ok_or_else(|| InputError::NoSensitivities.into())
        };
        let mut segment = Segment::new((start, end), end, &at(0)?);
        for k in 1..=self.step_made().degree.unwrap_or(0) {
            segment.push(k, &at(k)?);
        }
        Ok(segment)
    }
}

//! Internal steps as polynomials.

use std::ops::ControlFlow;

use pc_expr::VectorField;
use sundials_sys as sys;

use crate::cvode::cvode::{Cvode, Ending};
use crate::error::SolveError;
use crate::integration::dense_output::Segment;

impl<F: VectorField> Cvode<F> {
    /// Integrates to `end` and gives the motion as [`Segment`]s, one for each internal step, to `segment`, which may
    /// stop it at the end of that.
    ///
    /// Only the last step is kept here: what is wanted of the others is for `segment` to keep.
    ///
    /// # Errors
    /// As for [`run`](Cvode::run); segments before the failure have been given.
    pub fn run_dense(
        &mut self,
        end: f64,
        mut segment: impl FnMut(Segment) -> ControlFlow<()>,
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
            let piece = self.segment((from, &state), (next, &reached))?;
            if next != from && segment(piece).is_break() {
                return Ok(Ending::Stopped);
            }
        }
    }

    /// The last internal step between two of its states.
    pub(crate) fn segment(
        &mut self,
        (start, from): (f64, &[f64]),
        (end, to): (f64, &[f64]),
    ) -> Result<Segment, SolveError> {
        let mut order = 0;
        // SAFETY: the memory is live and initialised; `order` is a place for the result.
        unsafe { sys::CVodeGetLastOrder(self.memory.raw(), &raw mut order) };
        let mut segment = Segment::new(start, (end, to));
        for k in 1..=u32::try_from(order).unwrap_or(0) {
            self.interpolate_to_work(end, k)?;
            segment.push(k, self.work.as_slice());
        }
        segment.close(from);
        Ok(segment)
    }
}

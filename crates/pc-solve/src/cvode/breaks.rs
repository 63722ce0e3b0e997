//! Steps that end where the field is not smooth.

use pc_expr::VectorField;
use sundials_sys as sys;

use crate::cvode::cvode::Cvode;
use crate::error::SolveError;
use crate::integration::breaks::next_break;

impl<F: VectorField> Cvode<F> {
    /// The break of the field, or the stop time, that the next step towards a given time must not
    /// pass; none if the field has no breaks. Reinitialises CVODES where the field has jumped.
    pub(super) fn stop_before_break(&mut self, towards: f64) -> Result<Option<f64>, SolveError> {
        if self.field().breaks().is_empty() {
            return Ok(None);
        }
        // Without a stop time a step may end beyond `towards`.
        let end = self.stop_time.unwrap_or(f64::INFINITY.copysign(towards - self.step_time));
        let (t, next) = next_break(self.field().breaks(), self.step_time, end);
        let jumped = self.callbacks.field_mut().enter(t, end);
        if jumped && self.direction.is_some() {
            self.begin_anew()?;
        }
        // CVODES forgets a stop time that it has reached.
        match next.or(self.stop_time) {
            Some(stop) => {
                self.memory.set(&mut self.context, "CVodeSetStopTime", sys::CVodeSetStopTime, stop)?;
                Ok(Some(stop))
            }
            None => Ok(None),
        }
    }

    /// Reinitialises CVODES at its current state, without notifying the field.
    fn begin_anew(&mut self) -> Result<(), SolveError> {
        let before = self.work_so_far();
        let work = self.sensitivity_statistics();
        let columns = self.sensitivities_at(self.step_time)?;
        let integrals = self.quadrature.as_ref().map(|_| self.quadratures()).transpose()?;
        self.work.as_mut_slice().copy_from_slice(self.step_state.as_slice());
        // SAFETY: the memory is initialised; CVODES copies the start from the vector, which has its
        // dimension.
        let code = unsafe { sys::CVodeReInit(self.memory.raw(), self.step_time, self.work.raw()) };
        self.context.check("CVodeReInit", code)?;
        self.begin_integrals_anew(integrals)?;
        if let Some(columns) = columns {
            self.begin_columns_anew(&columns, work)?;
        }
        self.callbacks.begin_anew();
        self.earlier = before;
        self.earlier.current_time = self.step_time;
        self.idle_steps = 0;
        self.idle_failure = None;
        Ok(())
    }
}

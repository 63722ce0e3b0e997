//! A new start with the same options.

use pc_expr::VectorField;
use sundials_sys as sys;

use crate::cvode::cvode::Cvode;
use crate::error::{InputError, SolveError};
use crate::integration::inequality;
use crate::integration::options::{check_length, finite};

impl<F: VectorField> Cvode<F> {
    /// Starts anew at y(t) = y, after a jump of the state, say.
    ///
    /// Options and stop time stay, and the [statistics](Cvode::statistics) count on. The method begins at order 1; the
    /// next step may go either way.
    ///
    /// # Errors
    /// [`SolveError::Input`] unless all is finite and of the right length, or if there are sensitivities, which
    /// [have to be given too](Cvode::restart_with_sensitivities); [`SolveError::Setup`] if CVODES refuses. The integration is
    /// then where it was.
    pub fn restart(&mut self, t: f64, y: &[f64]) -> Result<(), SolveError> {
        if self.sensitivity.is_some() {
            return Err(InputError::Restart.into());
        }
        self.restart_alone(t, y)
    }

    /// The same, of the state without its sensitivities.
    pub(crate) fn restart_alone(&mut self, t: f64, y: &[f64]) -> Result<(), SolveError> {
        finite("the start time", t)?;
        check_length("the start", y.len(), self.field().dim())?;
        if let Some(i) = y.iter().position(|value| !value.is_finite()) {
            let what = format!("{} at the start", self.field().component_name(i));
            return Err(InputError::NotFinite { what, value: y[i] }.into());
        }
        inequality::check(self.field(), y, &self.inequalities)?;
        let before = self.statistics();
        let integrals = self.integrals_to_keep()?;
        self.work.as_mut_slice().copy_from_slice(y);
        // SAFETY: the memory is initialised; CVODES copies the start from the vector, which has its dimension.
        let code = unsafe { sys::CVodeReInit(self.memory.raw(), t, self.work.raw()) };
        self.context.check("CVodeReInit", code)?;
        self.begin_integrals_anew(integrals)?;
        self.callbacks.restart(t, y);
        self.foresight.restart();
        self.step_state.as_mut_slice().copy_from_slice(y);
        self.time = t;
        self.step_time = t;
        self.direction = None;
        self.idle_steps = 0;
        self.idle_failure = None;
        self.earlier = before;
        self.earlier.current_time = t;
        self.restarted = true;
        self.jumped = true;
        // CVODES forgets a stop time that it has reached.
        self.set_stop_time(self.stop_time)
    }

    /// Changes the field where the integration stands, such as the value of an input, and [begins anew](Cvode::restart)
    /// there: what was computed ahead of [`time`](Cvode::time) is forgotten.
    ///
    /// # Errors
    /// As for [`restart`](Cvode::restart); the field is changed nevertheless.
    pub fn change(&mut self, change: impl FnOnce(&mut F)) -> Result<(), SolveError> {
        let (t, state) = (self.time, self.state().to_vec());
        change(self.callbacks.field_mut());
        self.restart(t, &state)
    }
}

//! Restarts of a method, with the same options.

use pc_expr::VectorField;
use sundials_sys as sys;

use crate::cvode::cvode::Cvode;
use crate::error::SolveError;

impl<F: VectorField> Cvode<F> {
    /// Restarts from y(t) = y, without sensitivities; the method begins at order 1.
    pub(crate) fn restart_alone(
        &mut self,
        t: f64,
        y: &[f64],
        direction: Option<f64>,
    ) -> Result<(), SolveError> {
        let before = self.work_so_far();
        let integrals = self.integrals_to_keep()?;
        self.work.as_mut_slice().copy_from_slice(y);
        // SAFETY: the memory is initialised; CVODES copies the start from the vector, which has its
        // dimension.
        let code = unsafe { sys::CVodeReInit(self.memory.raw(), t, self.work.raw()) };
        self.context.check("CVodeReInit", code)?;
        self.begin_integrals_anew(integrals)?;
        self.callbacks.restart(t, y);
        self.foresight.restart();
        self.step_state.as_mut_slice().copy_from_slice(y);
        self.time = t;
        self.step_time = t;
        self.direction = direction;
        self.idle_steps = 0;
        self.idle_failure = None;
        self.earlier = before;
        self.earlier.current_time = t;
        self.restarted = true;
        // CVODES forgets a stop time that it has reached.
        self.set_cvodes_stop_time(self.stop_time)
    }
}

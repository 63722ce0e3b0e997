//! Integration with sensitivities.

use std::ffi::{c_int, c_long, c_void};
use std::ops::ControlFlow;

use pc_expr::VectorField;
use sundials_sys as sys;

use super::{Cvode, Ending};
use crate::error::{Reason, SolveError};
use crate::handles::{NonlinearIteration, Vector};
use crate::linearisation::Linearisation;
use crate::options::{NonlinearSolver, Options};
use crate::sensitivity::{Correction, Sensitivities, SensitivityStatistics};
use crate::variation::{self, Variation};

/// What an integration with sensitivities has besides.
pub(super) struct Forward {
    /// Referred to by CVODES.
    _nonlinear_iteration: NonlinearIteration,
    /// Where CVODES writes the columns.
    columns: Vec<Vector>,
    /// S(`time`) when asked for, S(t0) before; column-major.
    matrix: Vec<f64>,
    correction: Correction,
}

impl Forward {
    /// The vectors as CVODES takes them.
    fn raw(&self) -> Vec<sys::N_Vector> {
        self.columns.iter().map(Vector::raw).collect()
    }
}

impl<F: VectorField> Cvode<F> {
    /// Starts at y(t0) = y0 as [`new`](Cvode::new) does, with derivatives of the motion.
    ///
    /// # Errors
    /// As for [`new`](Cvode::new); [`SolveError::Input`] if a column asks for what the field does not have.
    pub fn with_sensitivities(
        field: F,
        t0: f64,
        y0: &[f64],
        options: &Options,
        sensitivities: &Sensitivities,
    ) -> Result<Self, SolveError> {
        sensitivities.validate(&field)?;
        let linearisation = Linearisation::new(&field, options);
        let mut cvode = Cvode::new(field, t0, y0, options)?;
        if sensitivities.is_empty() {
            return Ok(cvode);
        }
        cvode.callbacks.set_variation(Variation::new(linearisation, sensitivities.parameters()));
        cvode.begin_sensitivities(sensitivities, options.nonlinear_solver)?;
        Ok(cvode)
    }

    fn begin_sensitivities(
        &mut self,
        sensitivities: &Sensitivities,
        solver: NonlinearSolver,
    ) -> Result<(), SolveError> {
        let Cvode { memory, context, step_state, .. } = self;
        let count = sensitivities.len() as c_int;
        let matrix = sensitivities.start(step_state.as_slice().len());
        let columns = matrix
            .chunks_exact(step_state.as_slice().len())
            .map(|column| Vector::new(context, column))
            .collect::<Result<Vec<_>, _>>()?;
        let (method, together) = match sensitivities.correction {
            Correction::Staggered => (sys::CV_STAGGERED, count),
            Correction::Simultaneous => (sys::CV_SIMULTANEOUS, count + 1),
        };
        let nonlinear_iteration = match solver {
            NonlinearSolver::Newton => NonlinearIteration::newton_of(context, together, step_state)?,
            NonlinearSolver::FixedPoint => NonlinearIteration::fixed_point_of(context, together, step_state)?,
        };
        // Kept before CVODES refers to it.
        let forward = Forward {
            _nonlinear_iteration: nonlinear_iteration,
            columns,
            matrix,
            correction: sensitivities.correction,
        };
        let (mut raw, iteration) = (forward.raw(), forward._nonlinear_iteration.raw());
        self.sensitivity = Some(forward);

        let mem = memory.raw();
        // SAFETY: the memory is initialised and has its user data, whose variation has `count` columns; CVODES copies
        // the `count` vectors.
        let code =
            unsafe { sys::CVodeSensInit(mem, count, method, Some(variation::rates::<F>), raw.as_mut_ptr()) };
        context.check("CVodeSensInit", code)?;
        match sensitivities.tolerances {
            Some((relative, absolute)) => {
                let mut absolute = vec![absolute; sensitivities.len()];
                // SAFETY: sensitivities are initialised; CVODES copies one number for each column.
                let code = unsafe { sys::CVodeSensSStolerances(mem, relative, absolute.as_mut_ptr()) };
                context.check("CVodeSensSStolerances", code)?;
            }
            None => {
                // SAFETY: sensitivities are initialised.
                context.check("CVodeSensEEtolerances", unsafe { sys::CVodeSensEEtolerances(mem) })?;
            }
        }
        let error_control = c_int::from(sensitivities.error_control);
        memory.set(context, "CVodeSetSensErrCon", sys::CVodeSetSensErrCon, error_control)?;
        // SAFETY: sensitivities are initialised, with the method chosen; the iteration outlives the memory.
        let code = unsafe {
            match sensitivities.correction {
                Correction::Staggered => sys::CVodeSetNonlinearSolverSensStg(mem, iteration),
                Correction::Simultaneous => sys::CVodeSetNonlinearSolverSensSim(mem, iteration),
            }
        };
        context.check("the nonlinear solver of the sensitivities", code)
    }

    /// S at [`time`](Cvode::time): entry `i + j * dim` is the derivative of component i by what column j stands for.
    ///
    /// Empty unless the integration was begun [with sensitivities](Cvode::with_sensitivities).
    ///
    /// # Errors
    /// [`SolveError::Integration`] if a derivative has grown beyond the largest number.
    pub fn sensitivities(&mut self) -> Result<&[f64], SolveError> {
        if self.direction.is_some()
            && let Some(forward) = &self.sensitivity
        {
            let mut raw = forward.raw();
            // SAFETY: a step has been taken with sensitivities; there are as many vectors as columns.
            let code = unsafe { sys::CVodeGetSensDky(self.memory.raw(), self.time, 0, raw.as_mut_ptr()) };
            if code != sys::CV_SUCCESS {
                let reason = Reason::Cvode { code: code.into(), message: self.context.take_messages() };
                return Err(self.error(reason, None));
            }
        }
        let Some(forward) = &mut self.sensitivity else { return Ok(&[]) };
        if self.direction.is_some() {
            let dim = self.step_state.as_slice().len();
            for (values, column) in forward.matrix.chunks_exact_mut(dim).zip(&forward.columns) {
                values.copy_from_slice(column.as_slice());
            }
        }
        self.finite_sensitivities()?;
        Ok(self.sensitivity.as_ref().map_or(&[], |forward| &forward.matrix))
    }

    fn finite_sensitivities(&self) -> Result<(), SolveError> {
        let Some(forward) = &self.sensitivity else { return Ok(()) };
        let Some(k) = forward.matrix.iter().position(|value| !value.is_finite()) else { return Ok(()) };
        let dim = self.step_state.as_slice().len();
        let component = format!(
            "column {} (from 0) of the sensitivity of {}",
            k / dim,
            self.field().component_name(k % dim)
        );
        let reason = Reason::Overflow { component, value: forward.matrix[k], t: self.time };
        Err(self.error(reason, None))
    }

    /// As [`run`](Cvode::run), and gives each (t, y, S) to `output`.
    ///
    /// # Errors
    /// As for [`run`](Cvode::run) and [`sensitivities`](Cvode::sensitivities).
    pub fn run_with_sensitivities(
        &mut self,
        times: &[f64],
        mut output: impl FnMut(f64, &[f64], &[f64]) -> ControlFlow<()>,
    ) -> Result<Ending, SolveError> {
        let end = self.check_times(times)?;
        for &t in times {
            // Without an observer nothing can stop it.
            let _ = self.advance(t, end, &mut |_, _| ControlFlow::Continue(()))?;
            self.sensitivities()?;
            let matrix = self.sensitivity.as_ref().map_or(&[][..], |forward| &forward.matrix);
            if output(t, self.state(), matrix).is_break() {
                return Ok(Ending::Stopped);
            }
        }
        Ok(Ending::Completed)
    }

    /// The work for the sensitivities so far.
    pub fn sensitivity_statistics(&self) -> SensitivityStatistics {
        let Some(forward) = &self.sensitivity else { return SensitivityStatistics::default() };
        let counter = |get: unsafe extern "C" fn(*mut c_void, *mut c_long) -> c_int| {
            let mut value = 0;
            // SAFETY: the memory is live, with sensitivities; `value` is a place for the result.
            unsafe { get(self.memory.raw(), &raw mut value) };
            u64::try_from(value).unwrap_or(0)
        };
        // Those of a simultaneous correction are counted with the state's.
        let alone = |get| if forward.correction == Correction::Staggered { counter(get) } else { 0 };
        SensitivityStatistics {
            evaluations: counter(sys::CVodeGetSensNumRhsEvals),
            error_test_failures: counter(sys::CVodeGetSensNumErrTestFails),
            nonlinear_iterations: alone(sys::CVodeGetSensNumNonlinSolvIters),
            nonlinear_failures: alone(sys::CVodeGetSensNumNonlinSolvConvFails),
        }
    }
}

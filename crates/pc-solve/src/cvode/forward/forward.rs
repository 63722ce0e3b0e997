//! Integration with sensitivities.

use std::ffi::{c_int, c_long, c_void};

use pc_expr::VectorField;
use sundials_sys as sys;

use crate::cvode::cvode::Cvode;
use crate::cvode::forward::columns::Forward;
use crate::cvode::forward::equations;
use crate::cvode::forward::linearisation::Linearisation;
use crate::cvode::forward::sensitivities::{Correction, Sensitivities, SensitivityStatistics};
use crate::cvode::forward::variation::Variation;
use crate::cvode::handles::{NonlinearIteration, Vector};
use crate::error::{Reason, SolveError};
use crate::settings::nonlinear_solver::NonlinearSolver;
use crate::settings::options::Options;

impl<F: VectorField> Cvode<F> {
    /// Starts at y(t0) = y0 as [`new`](Cvode::new) does, and integrates derivatives of the motion
    /// too.
    ///
    /// # Errors
    /// As for [`new`](Cvode::new); [`SolveError::Input`] if a column needs a derivative that the
    /// field does not have.
    pub fn with_sensitivities(
        field: F,
        t0: f64,
        y0: &[f64],
        options: &Options,
        sensitivities: &Sensitivities,
    ) -> Result<Self, SolveError> {
        sensitivities.validate(&field)?;
        let start = sensitivities.start(field.dim());
        Cvode::new(field, t0, y0, options)?.and_sensitivities(sensitivities, options, start)
    }

    /// Adds columns, whose initial values are `start`, to this integration, which has not yet
    /// begun.
    pub(crate) fn and_sensitivities(
        mut self,
        sensitivities: &Sensitivities,
        options: &Options,
        start: Vec<f64>,
    ) -> Result<Self, SolveError> {
        sensitivities.validate(self.field())?;
        if sensitivities.is_empty() {
            return Ok(self);
        }
        let mut linearisation = Linearisation::new(self.field(), options);
        let (t, y) = (self.time, self.step_state.as_slice().to_vec());
        let scales = sensitivities.sizes(self.callbacks.field_mut(), &mut linearisation, t, &y);
        self.callbacks.set_variation(Variation::new(linearisation, sensitivities.parameters()));
        self.begin_sensitivities(sensitivities, options.iteration(), start, scales)?;
        Ok(self)
    }

    fn begin_sensitivities(
        &mut self,
        sensitivities: &Sensitivities,
        solver: NonlinearSolver,
        matrix: Vec<f64>,
        mut scales: Vec<f64>,
    ) -> Result<(), SolveError> {
        let Cvode { memory, context, step_state, .. } = self;
        let count = sensitivities.len() as c_int;
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
        // Stored before CVODES refers to it.
        let forward = Forward {
            _nonlinear_iteration: nonlinear_iteration,
            columns,
            matrix,
            correction: sensitivities.correction,
            earlier: SensitivityStatistics::default(),
        };
        let (mut raw, iteration) = (forward.raw(), forward._nonlinear_iteration.raw());
        self.sensitivity = Some(forward);

        let mem = memory.raw();
        // SAFETY: the memory is initialised and has its user data, whose variation has `count`
        // columns; CVODES copies the `count` vectors.
        let code =
            unsafe { sys::CVodeSensInit(mem, count, method, Some(equations::rates::<F>), raw.as_mut_ptr()) };
        context.check("CVodeSensInit", code)?;
        // SAFETY: sensitivities are initialised; CVODES copies one size for each column; it needs
        // no parameters, since the equations are given.
        let code = unsafe {
            sys::CVodeSetSensParams(mem, std::ptr::null_mut(), scales.as_mut_ptr(), std::ptr::null_mut())
        };
        context.check("CVodeSetSensParams", code)?;
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
        // SAFETY: sensitivities are initialised, with the method chosen; the iteration outlives the
        // memory.
        let code = unsafe {
            match sensitivities.correction {
                Correction::Staggered => sys::CVodeSetNonlinearSolverSensStg(mem, iteration),
                Correction::Simultaneous => sys::CVodeSetNonlinearSolverSensSim(mem, iteration),
            }
        };
        context.check("the nonlinear solver of the sensitivities", code)
    }

    /// Restarts from y(t) = y with these columns of S, which are finite.
    pub(crate) fn restart_with_columns(
        &mut self,
        t: f64,
        y: &[f64],
        matrix: &[f64],
        direction: Option<f64>,
    ) -> Result<(), SolveError> {
        let work = self.sensitivity_statistics();
        self.restart_alone(t, y, direction)?;
        self.begin_columns_anew(matrix, work)
    }

    /// Reinitialises the columns of S, if there are any, once the state has been reinitialised;
    /// `work` is the work done so far.
    pub(crate) fn begin_columns_anew(
        &mut self,
        matrix: &[f64],
        work: SensitivityStatistics,
    ) -> Result<(), SolveError> {
        let Some(forward) = &mut self.sensitivity else { return Ok(()) };
        forward.earlier = work;
        forward.matrix.copy_from_slice(matrix);
        let dim = self.step_state.as_slice().len();
        for (column, values) in forward.columns.iter_mut().zip(matrix.chunks_exact(dim)) {
            column.as_mut_slice().copy_from_slice(values);
        }
        let method = match forward.correction {
            Correction::Staggered => sys::CV_STAGGERED,
            Correction::Simultaneous => sys::CV_SIMULTANEOUS,
        };
        let mut raw = forward.raw();
        // SAFETY: sensitivities are initialised, by the same method; CVODES copies the vectors.
        let code = unsafe { sys::CVodeSensReInit(self.memory.raw(), method, raw.as_mut_ptr()) };
        self.context.check("CVodeSensReInit", code)
    }

    /// S at the current time, column-major; empty without sensitivities.
    pub(crate) fn columns_here(&self) -> Result<Vec<f64>, SolveError> {
        let Some(forward) = &self.sensitivity else { return Ok(Vec::new()) };
        let matrix = self.sensitivities_at(self.time)?.unwrap_or_else(|| forward.matrix.clone());
        let Some(k) = matrix.iter().position(|value| !value.is_finite()) else { return Ok(matrix) };
        let dim = self.step_state.as_slice().len();
        let component = format!(
            "column {} (from 0) of the sensitivity of {}",
            k / dim,
            self.field().component_name(k % dim)
        );
        let reason = Reason::Overflow { component, value: matrix[k], t: self.time };
        Err(self.error(reason, None))
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
        // A simultaneous correction counts with that of the state.
        let alone = |get| if forward.correction == Correction::Staggered { counter(get) } else { 0 };
        let earlier = forward.earlier;
        SensitivityStatistics {
            evaluations: earlier.evaluations + counter(sys::CVodeGetSensNumRhsEvals),
            error_test_failures: earlier.error_test_failures + counter(sys::CVodeGetSensNumErrTestFails),
            nonlinear_iterations: earlier.nonlinear_iterations + alone(sys::CVodeGetSensNumNonlinSolvIters),
            nonlinear_failures: earlier.nonlinear_failures + alone(sys::CVodeGetSensNumNonlinSolvConvFails),
        }
    }
}

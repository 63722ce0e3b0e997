//! Derivatives of a motion where it is asked for: at outputs, inside steps, and as functions of time.

use std::ops::ControlFlow;

use pc_expr::{Events, VectorField};
use sundials_sys as sys;

use crate::cvode::cvode::Cvode;
use crate::cvode::handles::Vector;
use crate::error::{InputError, Reason, SolveError};
use crate::events::events::Occurrence;
use crate::integration::dense_output::Segment;
use crate::integration::integration::{Ending, Integration};
use crate::integration::observer::Observed;
use crate::integration::options::{Options, check_length, finite};
use crate::integration::stepper::Stepper;
use crate::sensitivity::options::{Sensitivities, SensitivityStatistics};

impl<F: VectorField> Integration<Cvode<F>> {
    /// Starts at y(t0) = y0 as [`new`](Integration::new) does, with derivatives of the motion.
    ///
    /// # Errors
    /// As for [`Cvode::with_sensitivities`].
    pub fn with_sensitivities(
        field: F,
        t0: f64,
        y0: &[f64],
        options: &Options,
        sensitivities: &Sensitivities,
    ) -> Result<Self, SolveError> {
        Ok(Integration::of(Cvode::with_sensitivities(field, t0, y0, options, sensitivities)?))
    }
}

/// Derivatives are the matter of CVODES: no other method has them.
impl<F: VectorField, E: Events> Integration<Cvode<F>, E> {
    /// S at [`time`](Integration::time), S⁺ at an event: entry `i + j * dim` is the derivative of component i by what column j
    /// stands for.
    ///
    /// Empty unless the integration was begun [with sensitivities](Integration::with_sensitivities).
    ///
    /// # Errors
    /// [`SolveError::Integration`] if a derivative has grown beyond the largest number.
    pub fn sensitivities(&mut self) -> Result<Vec<f64>, SolveError> {
        self.engine.columns()
    }

    /// The work for the sensitivities so far.
    pub fn sensitivity_statistics(&self) -> SensitivityStatistics {
        self.engine.sensitivity_statistics()
    }

    /// Starts anew at y(t) = y as [`restart`](Integration::restart) does, with these columns of S.
    ///
    /// Behind a jump that depends on the state, S jumps too.
    ///
    /// # Errors
    /// As for [`restart`](Integration::restart); [`SolveError::Input`] unless `matrix` is finite and as long as
    /// [`sensitivities`](Integration::sensitivities).
    pub fn restart_with_sensitivities(
        &mut self,
        t: f64,
        y: &[f64],
        matrix: &[f64],
    ) -> Result<(), SolveError> {
        let expected = self.field().dim() * self.engine.column_parameters().len();
        check_length("the sensitivities", matrix.len(), expected)?;
        for &value in matrix {
            finite("a sensitivity", value)?;
        }
        self.restart_with_columns(t, y, matrix)
    }

    /// As [`run`](Integration::run), and gives each (t, y, S) to `output`, y⁺ and S⁺ at the time of an event.
    ///
    /// # Errors
    /// As for [`run`](Integration::run) and [`sensitivities`](Integration::sensitivities).
    pub fn run_with_sensitivities(
        &mut self,
        times: &[f64],
        mut output: impl FnMut(f64, &[f64], &[f64]) -> ControlFlow<()>,
        occurred: impl FnMut(&Occurrence) -> ControlFlow<()>,
    ) -> Result<Ending, SolveError> {
        let matrix = std::cell::RefCell::new(Vec::new());
        let output = |t: f64, y: &[f64]| output(t, y, &matrix.borrow());
        self.run_through(times, &mut Observed::new(output).occurrences(occurred), |integration| {
            *matrix.borrow_mut() = integration.engine.columns()?;
            Ok(())
        })
    }

    /// The derivative of S of the given order at `t` in the last step, as [`interpolate`](Integration::interpolate) gives that
    /// of y; column-major.
    ///
    /// # Errors
    /// As there; [`InputError::NoSensitivities`] if there are none.
    pub fn interpolate_sensitivities(&mut self, t: f64, order: u32) -> Result<Vec<f64>, SolveError> {
        self.engine.last_step().check_inside(t, order, self.front.t)?;
        self.engine.sensitivities_by_time(t, order)?.ok_or_else(|| InputError::NoSensitivities.into())
    }

    /// As [`run_dense`](Integration::run_dense), with the segment of S of the same span, whose components are its entries,
    /// column-major: from S⁺ to S⁻.
    ///
    /// # Errors
    /// As there; [`InputError::NoSensitivities`] if there are none.
    pub fn run_dense_with_sensitivities(
        &mut self,
        end: f64,
        mut segments: impl FnMut(Segment, Segment) -> ControlFlow<()>,
        occurred: impl FnMut(&Occurrence) -> ControlFlow<()>,
    ) -> Result<Ending, SolveError> {
        let mut observer = Observed::new(|_, _: &[f64]| ControlFlow::Continue(())).occurrences(occurred);
        self.run_in_pieces(end, &mut observer, |integration, from, to| {
            let of_state = integration.segment(from, to)?;
            Ok(segments(of_state, integration.engine.segment_of_sensitivities(from.0, to.0)?))
        })
    }
}

impl<F: VectorField> Cvode<F> {
    /// S at `t` in the last step; none where there is nothing but a start.
    pub(crate) fn sensitivities_at(&self, t: f64) -> Result<Option<Vec<f64>>, SolveError> {
        self.sensitivities_by_time(t, 0)
    }

    /// The derivative of S of that order at `t` in the last step, column-major; none where there is nothing but a start.
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

    /// S along the last internal step, between two of its times: nothing moves S after a step, so that the polynomial begins
    /// where the step did, to rounding.
    pub(crate) fn segment_of_sensitivities(&self, start: f64, end: f64) -> Result<Segment, SolveError> {
        let at = |k: u32| -> Result<Vec<f64>, SolveError> {
            self.sensitivities_by_time(end, k)?.ok_or_else(|| InputError::NoSensitivities.into())
        };
        let mut segment = Segment::new(start, (end, &at(0)?));
        for k in 1..=self.step_made().degree.unwrap_or(0) {
            segment.push(k, &at(k)?);
        }
        Ok(segment)
    }
}

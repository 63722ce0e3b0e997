//! Derivatives of a motion at outputs, inside steps, and as functions of time.

use std::ops::ControlFlow;

use pc_expr::{Events, VectorField};

use crate::cvode::cvode::Cvode;
use crate::cvode::forward::sensitivities::{Sensitivities, SensitivityStatistics};
use crate::error::{InputError, SolveError};
use crate::events::events::Occurrence;
use crate::integration::checks::{check_length, finite};
use crate::integration::dense_output::Segment;
use crate::integration::integration::{Ending, Integration};
use crate::integration::observer::Observed;
use crate::integration::stepper::Stepper;
use crate::settings::options::Options;

impl<F: VectorField> Integration<Cvode<F>> {
    /// Starts at y(t0) = y0 as [`new`](Integration::new) does, and integrates derivatives of the
    /// motion too.
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

/// Access to the derivatives, for methods that have them.
impl<S: Stepper, E: Events> Integration<S, E> {
    /// The matrix S at [`time`](Integration::time), which is S⁺ at an event: entry `i + j * dim` is
    /// the derivative of component i for column j.
    ///
    /// Empty unless the integration was begun [with
    /// sensitivities](Integration::with_sensitivities).
    ///
    /// # Errors
    /// [`SolveError::Integration`] if a derivative has grown beyond the largest number.
    pub fn sensitivities(&mut self) -> Result<Vec<f64>, SolveError> {
        self.engine.columns()
    }

    /// Restarts from y(t) = y as [`restart`](Integration::restart) does, with these columns of S.
    ///
    /// If the state jumps by an amount that depends on the state, S jumps too.
    ///
    /// # Errors
    /// As for [`restart`](Integration::restart); [`SolveError::Input`] unless `matrix` is finite
    /// and has the length of [`sensitivities`](Integration::sensitivities).
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

    /// Like [`run`](Integration::run), but passes each (t, y, S) to `output`, with y⁺ and S⁺ at an
    /// event.
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
        self.run_through(times, &mut Observed::new(output).occurrences(occurred), &mut |integration| {
            *matrix.borrow_mut() = integration.engine.columns()?;
            Ok(())
        })
    }
}

/// Access to what only CVODES provides.
impl<F: VectorField, E: Events> Integration<Cvode<F>, E> {
    /// The work for the sensitivities so far.
    pub fn sensitivity_statistics(&self) -> SensitivityStatistics {
        self.engine.sensitivity_statistics()
    }

    /// The derivative of S of the given order at `t` in the last step, column-major, as
    /// [`interpolate`](Integration::interpolate) gives for y.
    ///
    /// # Errors
    /// As for [`interpolate`](Integration::interpolate); [`InputError::NoSensitivities`] if there
    /// are no sensitivities.
    pub fn interpolate_sensitivities(&mut self, t: f64, order: u32) -> Result<Vec<f64>, SolveError> {
        self.engine.last_step().check_inside(t, order, self.front.t)?;
        self.engine.sensitivities_by_time(t, order)?.ok_or_else(|| InputError::NoSensitivities.into())
    }

    /// Like [`run_dense`](Integration::run_dense), but also passes on a segment of S over the same
    /// span, from S⁺ to S⁻; its components are the entries of S, column-major.
    ///
    /// # Errors
    /// As for [`run_dense`](Integration::run_dense); [`InputError::NoSensitivities`] if there are
    /// no sensitivities.
    pub fn run_dense_with_sensitivities(
        &mut self,
        end: f64,
        mut segments: impl FnMut(Segment, Segment) -> ControlFlow<()>,
        occurred: impl FnMut(&Occurrence) -> ControlFlow<()>,
    ) -> Result<Ending, SolveError> {
        let mut observer = Observed::new(|_, _: &[f64]| ControlFlow::Continue(())).occurrences(occurred);
        self.run_in_pieces(end, &mut observer, &mut |integration, from, to| {
            let of_state = integration.segment(from, to)?;
            Ok(segments(of_state, integration.engine.segment_of_sensitivities(from.0, to.0)?))
        })
    }
}

//! Integration with CVODES: constructors, and the functions that only this method provides.

use std::cell::RefCell;
use std::ops::ControlFlow;

use pc_expr::{Events, VectorField};

use crate::cvode::cvode::Cvode;
use crate::cvode::integrals::Integrals;
use crate::cvode::linear::solver::LinearSolver;
use crate::error::SolveError;
use crate::integration::integration::{Ending, Integration};
use crate::integration::observer::Observed;
use crate::settings::options::Options;

impl<F: VectorField> Integration<Cvode<F>> {
    /// Starts at y(t0) = y0 with CVODES, using Adams' formulas unless the method is
    /// [`Bdf`](crate::Method::Bdf); `y0` has one number per component.
    ///
    /// # Errors
    /// As for [`Cvode::new`].
    pub fn new(field: F, t0: f64, y0: &[f64], options: &Options) -> Result<Self, SolveError> {
        Ok(Integration::of(Cvode::new(field, t0, y0, options)?))
    }
}

/// The data of the error control and of the linear solver.
impl<F: VectorField, E: Events> Integration<Cvode<F>, E> {
    /// The same as [`Cvode::linear_solver`].
    pub fn linear_solver(&self) -> Option<&LinearSolver> {
        self.engine.linear_solver()
    }

    /// The same as [`Cvode::error_weights`].
    ///
    /// # Errors
    /// As there.
    pub fn error_weights(&mut self) -> Result<&[f64], SolveError> {
        self.engine.error_weights()
    }

    /// The same as [`Cvode::local_errors`].
    ///
    /// # Errors
    /// As there.
    pub fn local_errors(&mut self) -> Result<&[f64], SolveError> {
        self.engine.local_errors()
    }
}

impl<F: VectorField> Integration<Cvode<F>> {
    /// Starts at y(t0) = y0 as [`new`](Integration::new) does, with integrals along the motion,
    /// which begin at 0.
    ///
    /// A [checkpoint](Integration::checkpoint) does not contain them: after resuming, integrals
    /// have to be requested again, and begin at 0.
    ///
    /// # Errors
    /// As for [`Cvode::with_integrals`].
    pub fn with_integrals(
        field: F,
        t0: f64,
        y0: &[f64],
        options: &Options,
        integrals: Integrals,
    ) -> Result<Self, SolveError> {
        Ok(Integration::of(Cvode::with_integrals(field, t0, y0, options, integrals)?))
    }

    /// Adds integrals along the motion to this integration, which has not yet begun.
    ///
    /// # Errors
    /// As for [`Cvode::and_integrals`].
    pub fn and_integrals(self, integrals: Integrals, options: &Options) -> Result<Self, SolveError> {
        Ok(Integration::of(self.engine.and_integrals(integrals, options)?))
    }
}

impl<F: VectorField, E: Events> Integration<Cvode<F>, E> {
    /// The integrals from the start to [`time`](Integration::time), across events, in the order of
    /// their integrands.
    ///
    /// # Errors
    /// [`InputError::NoIntegrals`](crate::InputError::NoIntegrals) unless integrals were requested;
    /// [`SolveError::Integration`] if one of them has grown beyond the largest number.
    pub fn integrals(&mut self) -> Result<Vec<f64>, SolveError> {
        self.engine.integrals_here()
    }

    /// Like [`run`](Integration::run), but passes each (t, y) with the integrals up to t to
    /// `output`.
    ///
    /// # Errors
    /// As for [`run`](Integration::run) and [`integrals`](Integration::integrals).
    pub fn run_with_integrals(
        &mut self,
        times: &[f64],
        mut output: impl FnMut(f64, &[f64], &[f64]) -> ControlFlow<()>,
    ) -> Result<Ending, SolveError> {
        let values = RefCell::new(Vec::new());
        let mut observer = Observed::new(|t, y: &[f64]| output(t, y, &values.borrow()));
        self.run_through(times, &mut observer, &mut |integration| {
            *values.borrow_mut() = integration.engine.integrals_here()?;
            Ok(())
        })
    }
}

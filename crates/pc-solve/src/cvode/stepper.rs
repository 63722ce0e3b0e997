//! The methods of CVODES as a [`Stepper`].

use pc_expr::VectorField;

use crate::cvode::cvode::Cvode;
use crate::error::SolveError;
use crate::integration::limits::Limits;
use crate::integration::statistics::Statistics;
use crate::integration::stepper::{LastStep, Stepper};

impl<F: VectorField> Stepper for Cvode<F> {
    type Field = F;

    fn field(&self) -> &F {
        self.callbacks.field()
    }

    fn field_mut(&mut self) -> &mut F {
        self.callbacks.field_mut()
    }

    fn into_field(self) -> F {
        let Cvode { memory, callbacks, .. } = self;
        drop(memory);
        callbacks.into_field() // The other parts are dropped after this, in order.
    }

    fn limits(&self) -> &Limits {
        &self.limits
    }

    fn limits_mut(&mut self) -> &mut Limits {
        &mut self.limits
    }

    fn last_step(&self) -> LastStep {
        self.step_made()
    }

    fn end_time(&self) -> f64 {
        self.step_time
    }

    fn end_state(&self) -> &[f64] {
        self.step_state.as_slice()
    }

    fn time(&self) -> f64 {
        self.time
    }

    fn stand_at(&mut self, t: f64) {
        self.time = t;
    }

    fn step(&mut self, towards: f64) -> Result<(), SolveError> {
        self.internal_step(towards)
    }

    fn interpolate(&mut self, t: f64, order: u32) -> Result<&[f64], SolveError> {
        let stands_at = self.time;
        let outcome = self.interpolate_to_work(t, order);
        self.time = stands_at; // a failed projection moves it
        outcome?;
        Ok(self.work.as_slice())
    }

    fn restart(
        &mut self,
        t: f64,
        y: &[f64],
        columns: &[f64],
        direction: Option<f64>,
    ) -> Result<(), SolveError> {
        self.restart_with_columns(t, y, columns, direction)
    }

    fn stop_time(&self) -> Option<f64> {
        self.stop_time
    }

    fn set_stop_time(&mut self, t: Option<f64>) -> Result<(), SolveError> {
        self.set_cvodes_stop_time(t)?;
        self.stop_time = t;
        Ok(())
    }

    fn statistics(&self) -> Statistics {
        self.work_so_far()
    }

    fn tolerance(&self, i: usize, y: f64) -> f64 {
        self.foresight.tolerance(i, y)
    }

    fn least_size(&self) -> f64 {
        self.foresight.least_size()
    }

    fn columns(&self) -> Result<Vec<f64>, SolveError> {
        self.columns_here()
    }

    fn column_parameters(&self) -> &[Option<usize>] {
        self.callbacks.variation().parameters()
    }
}

//! [`Auto`] as a [`Stepper`].

use pc_expr::VectorField;

use super::switch::{Auto, Engine};
use crate::error::SolveError;
use crate::integration::limits::Limits;
use crate::integration::statistics::Statistics;
use crate::integration::stepper::{LastStep, Stepper};

/// Forwards a call to the current method.
macro_rules! each {
    ($engine:expr, $method:ident => $call:expr) => {
        match $engine {
            Engine::Explicit($method) => $call,
            Engine::Implicit($method) => $call,
        }
    };
}

impl<F: VectorField> Stepper for Auto<F> {
    type Field = F;

    fn field(&self) -> &F {
        each!(self.engine(), method => method.field())
    }

    fn field_mut(&mut self) -> &mut F {
        each!(self.engine_mut(), method => method.field_mut())
    }

    fn into_field(self) -> F {
        each!(self.into_engine(), method => method.into_field())
    }

    fn limits(&self) -> &Limits {
        each!(self.engine(), method => method.limits())
    }

    fn limits_mut(&mut self) -> &mut Limits {
        each!(self.engine_mut(), method => method.limits_mut())
    }

    fn last_step(&self) -> LastStep {
        each!(self.engine(), method => method.last_step())
    }

    fn end_state(&self) -> &[f64] {
        each!(self.engine(), method => method.end_state())
    }

    fn time(&self) -> f64 {
        each!(self.engine(), method => method.time())
    }

    fn stand_at(&mut self, t: f64) {
        each!(self.engine_mut(), method => method.stand_at(t));
    }

    fn step(&mut self, towards: f64) -> Result<(), SolveError> {
        self.consider()?;
        each!(self.engine_mut(), method => method.step(towards))
    }

    fn interpolate(&mut self, t: f64, order: u32) -> Result<&[f64], SolveError> {
        each!(self.engine_mut(), method => method.interpolate(t, order))
    }

    fn restart(
        &mut self,
        t: f64,
        y: &[f64],
        columns: &[f64],
        direction: Option<f64>,
    ) -> Result<(), SolveError> {
        each!(self.engine_mut(), method => method.restart(t, y, columns, direction))
    }

    fn enter_piece(
        &mut self,
        t: f64,
        y: &[f64],
        columns: &[f64],
        direction: Option<f64>,
    ) -> Result<(), SolveError> {
        each!(self.engine_mut(), method => method.enter_piece(t, y, columns, direction))
    }

    fn stop_time(&self) -> Option<f64> {
        each!(self.engine(), method => method.stop_time())
    }

    fn set_stop_time(&mut self, t: Option<f64>) -> Result<(), SolveError> {
        each!(self.engine_mut(), method => method.set_stop_time(t))
    }

    fn statistics(&self) -> Statistics {
        self.work()
    }

    fn tolerance(&self, i: usize, y: f64) -> f64 {
        each!(self.engine(), method => method.tolerance(i, y))
    }

    fn least_size(&self) -> f64 {
        each!(self.engine(), method => method.least_size())
    }
}

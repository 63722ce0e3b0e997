//! The method as a [`Stepper`].

use pc_expr::VectorField;

use super::dense::DEGREE;
use super::setup::Dop853;
use crate::error::{Reason, SolveError};
use crate::integration::limits::Limits;
use crate::integration::statistics::Statistics;
use crate::integration::stepper::{LastStep, Stepper};

impl<F: VectorField> Stepper for Dop853<F> {
    type Field = F;

    fn field(&self) -> &F {
        &self.field
    }

    fn field_mut(&mut self) -> &mut F {
        &mut self.field
    }

    fn into_field(self) -> F {
        self.field
    }

    fn limits(&self) -> &Limits {
        &self.limits
    }

    fn limits_mut(&mut self) -> &mut Limits {
        &mut self.limits
    }

    fn last_step(&self) -> LastStep {
        let degree = (!self.begins).then_some(DEGREE);
        let start = if self.begins { self.end.t } else { self.start.t };
        LastStep { start, end: self.end.t, degree }
    }

    fn end_state(&self) -> &[f64] {
        &self.end.y[..self.dim()]
    }

    fn time(&self) -> f64 {
        self.time
    }

    fn stand_at(&mut self, t: f64) {
        self.time = t;
    }

    fn step(&mut self, towards: f64) -> Result<(), SolveError> {
        self.make_step(towards)
    }

    fn interpolate(&mut self, t: f64, order: u32) -> Result<&[f64], SolveError> {
        if !self.has_polynomial {
            // The field may meanwhile have entered the interval after a break.
            if !self.field.breaks().is_empty() {
                self.field.enter(self.start.t, self.end.t);
            }
            let Dop853 { field, start, end, made, early, argument, polynomial, .. } = self;
            let count = &mut self.statistics.rhs_evaluations;
            let result = polynomial.make((field, count), (start, end), made, early, argument);
            result.map_err(|(t, failure)| self.failed(Reason::Rates { t }, Some(failure)))?;
            self.has_polynomial = true;
        }
        let dim = self.dim();
        self.polynomial.evaluate(t, order, &mut self.argument[..dim]);
        if order == 0
            && self.field.has_projection()
            && let Err(failure) = self.field.project(t, &mut self.argument[..dim])
        {
            return Err(self.failed(Reason::Projection { t }, Some(failure)));
        }
        Ok(&self.argument[..dim])
    }

    fn restart(
        &mut self,
        t: f64,
        y: &[f64],
        _columns: &[f64],
        _direction: Option<f64>,
    ) -> Result<(), SolveError> {
        self.field.restart(t, y);
        self.end.t = t;
        self.end.y[..y.len()].copy_from_slice(y);
        (self.time, self.begins) = (t, true);
        (self.has_rates, self.has_polynomial) = (false, false);
        // After a jump the motion may change faster: a step as long as the last could pass over an
        // event that recurs at once, like the impacts of a ball whose bounces accumulate.
        self.control.next = self.control.initial;
        self.last_length = None;
        self.stiffness.restart();
        self.statistics.limited_steps += self.places.limited;
        self.places.restart();
        self.statistics.current_time = t;
        Ok(())
    }

    fn enter_piece(
        &mut self,
        t: f64,
        y: &[f64],
        columns: &[f64],
        direction: Option<f64>,
    ) -> Result<(), SolveError> {
        let last = self.control.next;
        self.restart(t, y, columns, direction)?;
        self.last_length = last;
        Ok(())
    }

    fn stop_time(&self) -> Option<f64> {
        self.stop_time
    }

    fn set_stop_time(&mut self, t: Option<f64>) -> Result<(), SolveError> {
        self.stop_time = t;
        Ok(())
    }

    fn statistics(&self) -> Statistics {
        let limited_steps = self.statistics.limited_steps + self.places.limited;
        Statistics { limited_steps, stiff_from: self.stiffness.seen, ..self.statistics }
    }

    fn tolerance(&self, i: usize, y: f64) -> f64 {
        self.control.tolerance(i, y)
    }

    fn least_size(&self) -> f64 {
        let largest = self.control.absolute[..self.dim()].iter().copied().fold(0.0, f64::max);
        largest / self.control.relative
    }
}

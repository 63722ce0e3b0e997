//! Methods that make steps.

use pc_expr::{Failure, PolynomialMotion, VectorField};

use crate::error::{InputError, IntegrationError, Reason, SolveError};
use crate::integration::checks::finite;
use crate::integration::limits::Limits;
use crate::integration::statistics::Statistics;

/// A method that makes steps: the interface to [`Integration`](crate::Integration).
///
/// A stepper knows the states along its last step, and is at a [`time`](Stepper::time) in that
/// step. From these functions `Integration` builds outputs, events and their resets, dense output
/// and checkpoints in the same way for every method.
///
/// ```
/// use pc_solve::{FixedStep, Integration, RungeKutta4, from_fn};
///
/// let decay = from_fn(1, |_t, y, ydot| { ydot[0] = -y[0]; Ok(()) });
/// let mut motion = Integration::of(RungeKutta4::new(decay, 0.0, &[1.0], &FixedStep::new(0.01))?);
/// assert!((motion.state_at(1.0)?[0] - (-1.0_f64).exp()).abs() < 1e-10);
/// # Ok::<(), pc_solve::SolveError>(())
/// ```
pub trait Stepper {
    /// The vector field that is integrated.
    type Field: VectorField;

    /// The vector field.
    fn field(&self) -> &Self::Field;

    /// The vector field, mutable, between steps.
    fn field_mut(&mut self) -> &mut Self::Field;

    /// Ends the integration and returns the vector field.
    fn into_field(self) -> Self::Field
    where
        Self: Sized;

    /// The limits of the integration.
    fn limits(&self) -> &Limits;

    /// The limits of the integration, mutable.
    fn limits_mut(&mut self) -> &mut Limits;

    /// The last step.
    fn last_step(&self) -> LastStep;

    /// The end of the last step, which is needed at each step.
    fn end_time(&self) -> f64 {
        self.last_step().end
    }

    /// y at the end of the last step.
    fn end_state(&self) -> &[f64];

    /// The current time, which lies in the last step.
    fn time(&self) -> f64;

    /// Moves to a time in the last step, at which derivatives and integrals, if there are any, will
    /// be read.
    fn stand_at(&mut self, t: f64);

    /// Makes a step from the end of the last one in the direction of `towards`, possibly beyond it,
    /// but not beyond the stop time, and moves to its end.
    ///
    /// # Errors
    /// [`SolveError::Integration`]; the last step is then still the previous one, and the stepper
    /// is at its end.
    fn step(&mut self, towards: f64) -> Result<(), SolveError>;

    /// The derivative of y of the given order at `t` in the last step, both validated by the
    /// caller; order 0 is y itself, [projected](VectorField::project) where the field does so.
    ///
    /// # Errors
    /// [`SolveError::Integration`]
    fn interpolate(&mut self, t: f64, order: u32) -> Result<&[f64], SolveError>;

    /// The time in the last step about which the polynomial of the step is expanded; the
    /// derivatives there are the coefficients, up to factorials.
    fn centre(&self) -> f64 {
        self.last_step().end
    }

    /// Restarts from y(t) = y, validated by the caller, with these [columns](Stepper::columns);
    /// statistics continue.
    ///
    /// If a direction is given, the next step must go in that direction; otherwise it may go in
    /// either direction.
    ///
    /// # Errors
    /// [`SolveError`] if this is not possible; the stepper is then unchanged.
    fn restart(
        &mut self,
        t: f64,
        y: &[f64],
        columns: &[f64],
        direction: Option<f64>,
    ) -> Result<(), SolveError>;

    /// [Restarts](Stepper::restart) where the field changes to another piece while the state stays
    /// the same: the next step may be as long as the last.
    ///
    /// # Errors
    /// As there.
    fn enter_piece(
        &mut self,
        t: f64,
        y: &[f64],
        columns: &[f64],
        direction: Option<f64>,
    ) -> Result<(), SolveError> {
        self.restart(t, y, columns, direction)
    }

    /// The stop time, beyond which the field is never evaluated.
    fn stop_time(&self) -> Option<f64>;

    /// Sets the stop time, which the caller has validated, or removes it.
    ///
    /// # Errors
    /// [`SolveError`] if the method cannot do so.
    fn set_stop_time(&mut self, t: Option<f64>) -> Result<(), SolveError>;

    /// The work so far.
    fn statistics(&self) -> Statistics;

    /// The tolerance of component `i` when its value is y.
    fn tolerance(&self, i: usize, y: f64) -> f64;

    /// The smallest significant size of a component: values below the tolerances say nothing about
    /// the scale of the component.
    fn least_size(&self) -> f64;

    /// The derivatives integrated with the motion, at the current time, column-major; empty if
    /// there are none.
    ///
    /// # Errors
    /// [`SolveError::Integration`] if these derivatives are not finite.
    fn columns(&self) -> Result<Vec<f64>, SolveError> {
        Ok(Vec::new())
    }

    /// The index of the parameter of each column that is a derivative with respect to a parameter.
    fn column_parameters(&self) -> &[Option<usize>] {
        &[]
    }

    /// The states along the last step as a polynomial about its [centre](Stepper::centre), without
    /// projection; `room` holds its coefficients.
    ///
    /// # Errors
    /// [`SolveError::Integration`]
    fn polynomial<'a>(&'a mut self, room: &'a mut Vec<f64>) -> Result<PolynomialMotion<'a>, SolveError> {
        let (centre, degree) = (self.centre(), self.last_step().degree.unwrap_or(0));
        room.clear();
        let mut factorial = 1.0;
        for k in 0..=degree {
            factorial *= f64::from(k.max(1));
            room.extend(self.interpolate(centre, k)?.iter().map(|derivative| derivative / factorial));
        }
        Ok(PolynomialMotion { start: centre, coefficients: room })
    }

    /// The error for a failure beyond the end of the last step; the stepper moves to that end.
    fn failed(&mut self, reason: Reason, failure: Option<Failure>) -> SolveError {
        let (time, state) = (self.end_time(), self.end_state().to_vec());
        self.stand_at(time);
        SolveError::Integration(Box::new(IntegrationError { reason, time, state, failure }))
    }
}

/// The last step of a method, along which the states are known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LastStep {
    /// Its start.
    pub start: f64,
    /// The end of the step; before the first step, the start of the integration.
    pub end: f64,
    /// The degree of the polynomial that gives the states along the step; none before the first
    /// step.
    pub degree: Option<u32>,
}

impl LastStep {
    /// Checks that `t` lies between the start of the step and `end`, and that the polynomial of the
    /// step has a derivative of that order. As in CVODE, `t` may lie outside by rounding errors, up
    /// to 100 ε times the time.
    pub(crate) fn check_inside(&self, t: f64, order: u32, end: f64) -> Result<(), InputError> {
        finite("the time", t)?;
        let Some(highest) = self.degree else { return Err(InputError::NoStep) };
        let (start, direction) = (self.start, 1.0_f64.copysign(self.end - self.start));
        let slack = 100.0 * f64::EPSILON * (self.end.abs() + (self.end - start).abs());
        if (start - t) * direction > slack || (t - end) * direction > slack {
            return Err(InputError::OutsideStep { requested: t, start, end });
        }
        if order > highest {
            return Err(InputError::DerivativeOrder { order, highest });
        }
        Ok(())
    }
}

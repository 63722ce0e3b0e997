//! Methods that make steps.

use pc_expr::{Failure, PolynomialMotion, VectorField};

use crate::error::{InputError, IntegrationError, Reason, SolveError};
use crate::integration::checks::finite;
use crate::integration::limits::Limits;
use crate::integration::statistics::Statistics;

/// A method that makes steps: the interface to [`Integration`](crate::Integration).
///
/// A stepper has made a last step, whose states it knows from start to end, and stands at a [`time`](Stepper::time) in
/// it. Outputs, events and their resets, dense output and checkpoints are not the task of a method: `Integration`
/// makes them from these functions, for every method alike.
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

    /// The vector field, between steps.
    fn field_mut(&mut self) -> &mut Self::Field;

    /// The vector field; the integration is over.
    fn into_field(self) -> Self::Field
    where
        Self: Sized;

    /// The limits of the integration.
    fn limits(&self) -> &Limits;

    /// The same, to be changed.
    fn limits_mut(&mut self) -> &mut Limits;

    /// The last step.
    fn last_step(&self) -> LastStep;

    /// Its end alone, which is asked for at each step.
    fn end_time(&self) -> f64 {
        self.last_step().end
    }

    /// y at the end of the last step.
    fn end_state(&self) -> &[f64];

    /// The current time, in the last step.
    fn time(&self) -> f64;

    /// Moves to a time in the last step, for which derivatives and integrals, if there are any, are read next.
    fn stand_at(&mut self, t: f64);

    /// Makes a step from the end of the last one in the direction of `towards`, possibly beyond it, but not beyond the
    /// stop time, and stands at its end.
    ///
    /// # Errors
    /// [`SolveError::Integration`]; the last step is then the one before, and the stepper stands at its end.
    fn step(&mut self, towards: f64) -> Result<(), SolveError>;

    /// The derivative of y of the given order at `t` in the last step, both of which have been checked; order 0 is y itself,
    /// [projected](VectorField::project) where the field does so.
    ///
    /// # Errors
    /// [`SolveError::Integration`]
    fn interpolate(&mut self, t: f64, order: u32) -> Result<&[f64], SolveError>;

    /// The time in the last step about which its polynomial is given: the derivatives there are its coefficients, others are sums of them.
    fn centre(&self) -> f64 {
        self.last_step().end
    }

    /// Restarts at y(t) = y, which has been checked, with these [columns](Stepper::columns); statistics continue.
    ///
    /// With events the direction of integration stays; without, the next step may go either way.
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

    /// A time beyond which the field is never evaluated.
    fn stop_time(&self) -> Option<f64>;

    /// Sets that time, which has been checked, or removes it.
    ///
    /// # Errors
    /// [`SolveError`] if that cannot be.
    fn set_stop_time(&mut self, t: Option<f64>) -> Result<(), SolveError>;

    /// The work so far.
    fn statistics(&self) -> Statistics;

    /// The tolerance of component `i` where its value is y.
    fn tolerance(&self, i: usize, y: f64) -> f64;

    /// The least size of a component that matters: values below the tolerances are not a measure of a state.
    fn least_size(&self) -> f64;

    /// The derivatives of the motion that are integrated with it, where it stands, column-major; empty if there are none.
    ///
    /// # Errors
    /// [`SolveError::Integration`] if they are not finite.
    fn columns(&self) -> Result<Vec<f64>, SolveError> {
        Ok(Vec::new())
    }

    /// The parameter by which each column is the derivative, if it is one by a parameter.
    fn column_parameters(&self) -> &[Option<usize>] {
        &[]
    }

    /// The states along the last step as a polynomial about its [centre](Stepper::centre), with room for its coefficients; those inside
    /// are not projected.
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

    /// The error of a failure beyond the end of the last step, where the stepper then stands.
    fn failed(&mut self, reason: Reason, failure: Option<Failure>) -> SolveError {
        let (time, state) = (self.end_time(), self.end_state().to_vec());
        self.stand_at(time);
        SolveError::Integration(Box::new(IntegrationError { reason, time, state, failure }))
    }
}

/// The last step of a method: the states between its start and its end are known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LastStep {
    /// Its start.
    pub start: f64,
    /// Its end; the start of a method that has made no step yet.
    pub end: f64,
    /// The degree of the polynomial that the states along it lie on; none where there is no step but a start.
    pub degree: Option<u32>,
}

impl LastStep {
    /// Checks that `t` lies in the step, as far as that is asked for up to `end`, and that its polynomial has a derivative
    /// of that order. A time may lie outside by its rounding, 100 ε of the time, as CVODE has it.
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

//! Integrals along a motion.

use std::cell::RefCell;
use std::fmt;
use std::ops::ControlFlow;

use pc_expr::{Events, Failure, VectorField};

use crate::cvode::cvode::Cvode;
use crate::error::{InputError, SolveError, SolveFailure};
use crate::integration::integration::{Ending, Integration};
use crate::integration::observer::Observed;
use crate::integration::options::{Options, Tolerance, positive};
use crate::integration::trajectory::Trajectory;

/// Writes g(t, y) to its last argument.
pub(crate) type Integrands = Box<dyn FnMut(f64, &[f64], &mut [f64]) -> Result<(), Failure> + Send>;

/// Integrals ∫ g(t, y) dt along a motion, for any number of functions g that the motion does not feel: the work of a force,
/// the length of a path, a mean value.
///
/// They are computed by the formulas of the method as more components of the state would be, but take no part in its
/// implicit equations. Steps have to pass the error test of the integrals too, unless that is [left out](Integrals::error_control).
///
/// ```
/// use pc_solve::{Integration, Integrals, Options, from_fn};
///
/// // ẏ = −y from 1: ∫ y dt = 1 − e^(−t), ∫ y² dt = (1 − e^(−2t))/2.
/// let decay = from_fn(1, |_t, y, ydot| {
///     ydot[0] = -y[0];
///     Ok(())
/// });
/// let integrals = Integrals::new(2, |_t, y, rates| {
///     rates.copy_from_slice(&[y[0], y[0] * y[0]]);
///     Ok(())
/// });
/// let mut motion = Integration::with_integrals(decay, 0.0, &[1.0], &Options::default(), integrals)?;
/// motion.state_at(2.0)?;
/// let found = motion.integrals()?;
/// assert!((found[0] - (1.0 - (-2.0_f64).exp())).abs() < 1e-8);
/// assert!((found[1] - (1.0 - (-4.0_f64).exp()) / 2.0).abs() < 1e-8);
/// # Ok::<(), pc_solve::SolveError>(())
/// ```
pub struct Integrals {
    pub(crate) count: usize,
    pub(crate) integrands: Integrands,
    pub(crate) error_control: bool,
    tolerances: Option<(f64, f64)>,
}

impl fmt::Debug for Integrals {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Integrals")
            .field("count", &self.count)
            .field("error_control", &self.error_control)
            .field("tolerances", &self.tolerances)
            .finish_non_exhaustive()
    }
}

impl Integrals {
    /// `count` integrals, at least 1, of the functions g(t, y) that the closure writes to its last argument, every entry.
    pub fn new(
        count: usize,
        integrands: impl FnMut(f64, &[f64], &mut [f64]) -> Result<(), Failure> + Send + 'static,
    ) -> Integrals {
        Integrals { count, integrands: Box::new(integrands), error_control: true, tolerances: None }
    }

    /// Whether steps have to pass the error test of the integrals; if not, the motion is that without them.
    pub fn error_control(self, error_control: bool) -> Integrals {
        Integrals { error_control, ..self }
    }

    /// Relative and absolute tolerance of the integrals, positive; those of the state, of the absolute ones the least, unless
    /// given.
    pub fn tolerances(self, relative: f64, absolute: f64) -> Integrals {
        Integrals { tolerances: Some((relative, absolute)), ..self }
    }

    /// Relative and absolute tolerance, if all is valid.
    pub(crate) fn validate(&self, options: &Options) -> Result<(f64, f64), InputError> {
        positive("the number of integrals", self.count as f64)?;
        let (relative, absolute) = self.tolerances.unwrap_or_else(|| {
            let least = match &options.absolute_tolerance {
                Tolerance::Scalar(atol) => *atol,
                Tolerance::Vector(atol) => atol.iter().copied().fold(f64::INFINITY, f64::min),
            };
            // An absolute tolerance of 0 would ask for integrals exact at 0, where they begin.
            let smallest = if least > 0.0 { least } else { options.relative_tolerance };
            (options.relative_tolerance, smallest)
        });
        positive("the relative tolerance of the integrals", relative)?;
        positive("the absolute tolerance of the integrals", absolute)?;
        Ok((relative, absolute))
    }
}

impl<F: VectorField> Integration<Cvode<F>> {
    /// Starts at y(t0) = y0 as [`new`](Integration::new) does, with integrals along the motion, which are 0 there.
    ///
    /// A [checkpoint](Integration::checkpoint) has none of them: what goes on from one is asked for integrals anew, which begin
    /// at 0.
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

    /// This integration, which has not begun, with integrals along the motion.
    ///
    /// # Errors
    /// As for [`Cvode::and_integrals`].
    pub fn and_integrals(self, integrals: Integrals, options: &Options) -> Result<Self, SolveError> {
        Ok(Integration::of(self.engine.and_integrals(integrals, options)?))
    }
}

impl<F: VectorField, E: Events> Integration<Cvode<F>, E> {
    /// The integrals from the start to [`time`](Integration::time), over what occurred, in the order of their integrands.
    ///
    /// # Errors
    /// [`InputError::NoIntegrals`] unless they were asked for; [`SolveError::Integration`] if one has grown beyond the largest
    /// number.
    pub fn integrals(&mut self) -> Result<Vec<f64>, SolveError> {
        self.engine.integrals_here()
    }

    /// As [`run`](Integration::run), and gives each (t, y) with the integrals to there to `output`.
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
        self.run_through(times, &mut observer, |integration| {
            *values.borrow_mut() = integration.engine.integrals_here()?;
            Ok(())
        })
    }
}

/// Integrates ẏ = f(t, y) from y(t0) = y0 as [`solve`](crate::integration::solve()) does, with integrals from t0 to each output time.
///
/// # Errors
/// As there.
pub fn solve_with_integrals<F: VectorField>(
    field: F,
    t0: f64,
    y0: &[f64],
    times: &[f64],
    options: &Options,
    integrals: Integrals,
) -> Result<(Trajectory, Vec<Vec<f64>>), Box<SolveFailure>> {
    let mut reached = Trajectory::new(field.dim());
    let mut options = options.clone();
    options.stop_time = options.stop_time.or(times.last().copied().filter(|t| t.is_finite()));
    let mut integration = match Integration::with_integrals(field, t0, y0, &options, integrals) {
        Ok(integration) => integration,
        Err(error) => return Err(Box::new(SolveFailure { reached, error })),
    };
    let mut values = Vec::with_capacity(times.len());
    let result = integration.run_with_integrals(times, |t, y, integrals| {
        reached.push(t, y);
        values.push(integrals.to_vec());
        ControlFlow::Continue(())
    });
    reached.finish(matches!(result, Ok(Ending::Completed)), integration.statistics());
    match result {
        Ok(_) => Ok((reached, values)),
        Err(error) => Err(Box::new(SolveFailure { reached, error })),
    }
}

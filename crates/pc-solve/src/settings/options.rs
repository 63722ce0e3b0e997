//! Options of an integration.

use pc_expr::{Deadline, Method};

#[cfg(feature = "cvode")]
use crate::cvode::linear::solver::LinearSolver;
use crate::error::InputError;
use crate::events::events::Accumulation;
use crate::integration::checks::{check_length, finite, positive};
use crate::integration::limits::Limits;
use crate::settings::inequality::Inequality;
use crate::settings::nonlinear_solver::NonlinearSolver;
use crate::settings::tolerance::Tolerance;

/// Method, tolerances and limits of an integration.
///
/// A step is accepted if the root mean square of eᵢ/(rtol |yᵢ| + atolᵢ) over the components is at
/// most 1, where e is the estimated local error. [`Method::Taylor`] chooses its step beforehand, so
/// that the largest of these quotients, with the terms left out of its series as e, is about 1.
/// The values are checked when an integration starts.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    pub(crate) method: Method,
    /// None for the default of the method.
    pub(crate) nonlinear_solver: Option<NonlinearSolver>,
    #[cfg(feature = "cvode")]
    pub(crate) linear_solver: Option<LinearSolver>,
    pub(crate) inequalities: Vec<Inequality>,
    pub(crate) relative_tolerance: f64,
    pub(crate) absolute_tolerance: Tolerance,
    pub(crate) max_steps: u64,
    pub(crate) initial_step: Option<f64>,
    pub(crate) min_step: Option<f64>,
    pub(crate) max_step: Option<f64>,
    pub(crate) max_order: Option<u32>,
    pub(crate) stop_time: Option<f64>,
    pub(crate) samples_per_step: u32,
    pub(crate) accumulation: Accumulation,
    pub(crate) deadline: Option<Deadline>,
}

impl Default for Options {
    /// [`Method::Auto`], or [`Method::Dop853`] without the feature `cvode`, with the defaults of
    /// [`Options::new`].
    fn default() -> Self {
        Options::new(if cfg!(feature = "cvode") { Method::Auto } else { Method::Dop853 })
    }
}

impl Options {
    /// The method.
    pub fn method(&self) -> Method {
        self.method
    }

    /// Options for a method with tolerances 1e-9 (relative) and 1e-12 (absolute), at most 500 000
    /// steps between outputs, Newton's iteration for BDF and fixed-point iteration for Adams.
    pub fn new(method: Method) -> Self {
        Options {
            method,
            nonlinear_solver: None,
            #[cfg(feature = "cvode")]
            linear_solver: None,
            inequalities: Vec::new(),
            relative_tolerance: 1e-9,
            absolute_tolerance: Tolerance::Scalar(1e-12),
            max_steps: 500_000,
            initial_step: None,
            min_step: None,
            max_step: None,
            max_order: None,
            stop_time: None,
            samples_per_step: 4,
            accumulation: Accumulation::default(),
            deadline: None,
        }
    }

    /// Sets how the implicit equation of a step is solved.
    pub fn nonlinear_solver(self, nonlinear_solver: NonlinearSolver) -> Self {
        Options { nonlinear_solver: Some(nonlinear_solver), ..self }
    }

    #[cfg(feature = "cvode")]
    /// Sets how the linear systems of Newton's iteration are solved; the [default](LinearSolver)
    /// depends on the field's dimension and zero pattern.
    pub fn linear_solver(self, linear_solver: LinearSolver) -> Self {
        Options { linear_solver: Some(linear_solver), ..self }
    }

    /// Sets the inequalities to be satisfied, one for each component; there are none by default.
    ///
    /// Inequalities cannot be combined with a field [that has a
    /// projection](pc_expr::VectorField::has_projection), which would move the states again, nor with
    /// [`Method::Taylor`], which imposes none.
    pub fn inequalities(self, inequalities: Vec<Inequality>) -> Self {
        Options { inequalities, ..self }
    }

    /// Sets the relative tolerance, which is positive. A tolerance below ε = 2.2e-16 is taken as ε,
    /// or as 2 ε for Adams' and BDF formulas; only Taylor's method, which carries the rounding
    /// error of the state along, supports smaller tolerances.
    pub fn relative_tolerance(self, relative_tolerance: f64) -> Self {
        Options { relative_tolerance, ..self }
    }

    /// Sets the absolute tolerance, which is positive: one number, or a `Vec` with a number for
    /// each component.
    pub fn absolute_tolerance(self, absolute_tolerance: impl Into<Tolerance>) -> Self {
        Options { absolute_tolerance: absolute_tolerance.into(), ..self }
    }

    /// Sets the maximum number of internal steps from one output to the next, at least 1; exceeding
    /// it is the error [`Code::TooMuchWork`](crate::Code::TooMuchWork).
    pub fn max_steps(self, max_steps: u64) -> Self {
        Options { max_steps, ..self }
    }

    /// Sets the length of the first step, which is positive in both directions of time; by default
    /// it is estimated.
    pub fn initial_step(self, length: f64) -> Self {
        Options { initial_step: Some(length), ..self }
    }

    /// Sets the minimum length of a step, which is positive in both directions of time.
    pub fn min_step(self, length: f64) -> Self {
        Options { min_step: Some(length), ..self }
    }

    /// Sets the maximum length of a step, which is positive in both directions of time.
    pub fn max_step(self, length: f64) -> Self {
        Options { max_step: Some(length), ..self }
    }

    /// Sets the highest order to be used, from 1 to [`Method::highest_order`].
    pub fn max_order(self, order: u32) -> Self {
        Options { max_order: Some(order), ..self }
    }

    /// Sets a time beyond which the vector field is never evaluated.
    pub fn stop_time(self, t: f64) -> Self {
        Options { stop_time: Some(t), ..self }
    }

    /// Sets the number of equal parts of each internal step at whose ends event functions are
    /// sampled if they are not programs of the state; at least 1, by default 4. Between two samples
    /// [an even number](crate::Integration) of their zeros may be missed.
    pub fn samples_per_step(self, parts: u32) -> Self {
        Options { samples_per_step: parts, ..self }
    }

    /// Sets when occurrences of an event count as accumulated, which is an error.
    pub fn accumulation(self, accumulation: Accumulation) -> Self {
        Options { accumulation, ..self }
    }

    /// Sets the time after which no further step begins; passing this deadline is [an
    /// error](crate::Reason::Ended).
    pub fn deadline(self, deadline: Deadline) -> Self {
        Options { deadline: Some(deadline), ..self }
    }

    /// The same options for a method of CVODES, with Adams in place of [`Method::Auto`].
    ///
    /// # Errors
    /// [`InputError::NotCvode`] if another method was chosen.
    #[cfg(feature = "cvode")]
    pub(crate) fn by_cvode(&self) -> Result<Options, InputError> {
        match self.method {
            Method::Bdf | Method::Adams => Ok(self.clone()),
            Method::Auto => {
                let nonlinear_solver = Some(self.iteration());
                Ok(Options { method: Method::Adams, nonlinear_solver, ..self.clone() })
            }
            Method::Dop853 | Method::Taylor => Err(InputError::NotCvode { method: self.method }),
        }
    }

    /// How the implicit equation of a step is solved: as chosen, or by default.
    #[cfg(feature = "cvode")]
    pub(crate) fn iteration(&self) -> NonlinearSolver {
        self.nonlinear_solver.unwrap_or(match self.method {
            Method::Auto if self.linear_solver.is_some() => NonlinearSolver::Newton,
            Method::Adams | Method::Auto | Method::Dop853 | Method::Taylor => NonlinearSolver::FixedPoint,
            Method::Bdf => NonlinearSolver::Newton,
        })
    }

    /// Checks that the method supports the choices made.
    fn check_explicit(&self) -> Result<(), InputError> {
        #[cfg(feature = "cvode")]
        let linear = self.linear_solver.is_some();
        #[cfg(not(feature = "cvode"))]
        let linear = false;
        let refused = match self.method {
            Method::Bdf | Method::Adams => None,
            Method::Dop853 | Method::Auto if self.max_order.is_some() => Some("a highest order"),
            Method::Dop853 | Method::Taylor if self.nonlinear_solver.is_some() => Some("an iteration"),
            Method::Dop853 | Method::Taylor if linear => Some("a linear solver"),
            Method::Taylor if !self.inequalities.is_empty() => Some("inequalities"),
            Method::Dop853 | Method::Taylor | Method::Auto => None,
        };
        refused.map_or(Ok(()), |what| Err(InputError::Explicit { method: self.method, what }))
    }

    /// The relative tolerance for methods whose states are rounded: at least ε, since a smaller
    /// error would not show, and steps shortened to reach it would only add rounding errors. CVODES
    /// needs at least 2 ε.
    pub(crate) fn resolved_tolerance(&self) -> f64 {
        let least = match self.method {
            Method::Adams | Method::Bdf => 2.0 * f64::EPSILON,
            Method::Auto | Method::Dop853 | Method::Taylor => f64::EPSILON,
        };
        self.relative_tolerance.max(least)
    }

    /// The limits, which do not depend on the method.
    pub(crate) fn limits(&self) -> Limits {
        Limits {
            max_steps: self.max_steps,
            samples_per_step: self.samples_per_step,
            accumulation: self.accumulation,
            inequalities: self.inequalities.clone(),
            deadline: self.deadline.clone(),
        }
    }

    pub(crate) fn validate(&self, dim: usize) -> Result<(), InputError> {
        positive("the relative tolerance", self.relative_tolerance)?;
        match &self.absolute_tolerance {
            Tolerance::Scalar(tolerance) => positive("the absolute tolerance", *tolerance)?,
            Tolerance::Vector(tolerances) => {
                check_length("the absolute tolerances", tolerances.len(), dim)?;
                for (i, &tolerance) in tolerances.iter().enumerate() {
                    positive(&format!("absolute tolerance number {i} (from 0)"), tolerance)?;
                }
            }
        }
        if !self.inequalities.is_empty() {
            check_length("the inequalities", self.inequalities.len(), dim)?;
        }
        if self.max_steps == 0 {
            return Err(InputError::MaxSteps);
        }
        let lengths = [
            ("the initial step", self.initial_step),
            ("the minimum step", self.min_step),
            ("the maximum step", self.max_step),
        ];
        for (what, length) in lengths {
            if let Some(length) = length {
                positive(what, length)?;
            }
        }
        if let (Some(min), Some(max)) = (self.min_step, self.max_step)
            && min > max
        {
            return Err(InputError::StepBounds { min, max });
        }
        self.check_explicit()?;
        if let Some(found) = self.max_order {
            let limit = self.method.highest_order();
            if !(1..=limit).contains(&found) {
                return Err(InputError::MaxOrder { method: self.method, limit, found });
            }
        }
        if self.samples_per_step == 0 {
            return Err(InputError::SamplesPerStep);
        }
        if !(0.0..1.0).contains(&self.accumulation.within) {
            return Err(InputError::Accumulation { within: self.accumulation.within });
        }
        if let Some(t) = self.stop_time {
            finite("the stop time", t)?;
        }
        Ok(())
    }
}

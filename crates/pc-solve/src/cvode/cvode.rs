//! The methods of CVODES.

use std::ffi::{c_int, c_void};
use std::fmt;
use std::panic::resume_unwind;

use pc_expr::{Failure, VectorField};
use sundials_sys as sys;

use crate::cvode::callback::UserData;
use crate::cvode::context::Context;
use crate::cvode::handles::{Memory, NonlinearIteration, Vector};
use crate::cvode::linear::linear::Linear;
use crate::cvode::linear::solver::LinearSolver;
use crate::error::{InputError, IntegrationError, Reason, SolveError};
use crate::integration::limits::Limits;
use crate::integration::statistics::Statistics;

/// The variable-order, variable-step multistep methods of CVODES as a [`Stepper`](crate::Stepper)
/// that owns the vector field.
///
/// [`Integration`](crate::Integration) integrates with this stepper; [`solve`](crate::solve()) does
/// so in one call.
pub struct Cvode<F> {
    // Dropped in this order: what CVODES refers to after CVODES, the context last.
    pub(crate) memory: Memory,
    pub(super) _nonlinear_iteration: NonlinearIteration,
    pub(super) linear: Option<Linear>,
    pub(crate) sensitivity: Option<crate::cvode::forward::columns::Forward>,
    pub(crate) quadrature: Option<crate::cvode::quadrature::Quadrature>,
    /// y(`step_time`).
    pub(crate) step_state: Vector,
    /// Room for results of CVODES.
    pub(crate) work: Vector,
    pub(crate) callbacks: UserData<F>,
    pub(crate) context: Context,

    /// The current time, which lies in the last step.
    pub(crate) time: f64,
    /// The end of the last step of CVODES.
    pub(crate) step_time: f64,
    /// The direction of time, 1 or −1, once the first step has been made.
    pub(crate) direction: Option<f64>,
    pub(super) initial_step: Option<f64>,
    pub(super) stop_time: Option<f64>,
    pub(super) limits: Limits,
    /// The number of successive steps that did not advance the time, and the last failure overcome
    /// in these steps.
    pub(super) idle_steps: u32,
    pub(super) idle_failure: Option<Failure>,
    /// The work before the last restart, and whether no step has been made since then.
    pub(super) earlier: Statistics,
    pub(crate) restarted: bool,
    pub(super) foresight: crate::cvode::foresight::Foresight,
}

/// The limit on successive steps with t + h = t: CVODE continues after such a step, since h may
/// grow again.
const MAX_IDLE_STEPS: u32 = 1000;

// SAFETY: the SUNDIALS objects are reached through this struct alone, share nothing with other
// contexts and are not tied to a thread; F is the only part that could be.
unsafe impl<F: Send> Send for Cvode<F> {}

impl<F: VectorField> fmt::Debug for Cvode<F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Cvode")
            .field("time", &self.time)
            .field("state", &self.step_state.as_slice())
            .field("statistics", &self.work_so_far())
            .finish_non_exhaustive()
    }
}

impl<F: VectorField> Cvode<F> {
    pub(crate) fn field(&self) -> &F {
        self.callbacks.field()
    }

    /// The work so far.
    pub(crate) fn work_so_far(&self) -> Statistics {
        if self.restarted {
            return self.earlier;
        }
        let linear = self.linear.as_ref().map(|_| self.callbacks.linear());
        let mut since = Statistics::read(&self.memory, linear);
        since.rhs_evaluations += self.foresight.evaluations;
        since.limited_steps = self.foresight.places.as_ref().map_or(0, |places| places.limited);
        self.earlier.followed_by(&since)
    }

    /// The linear solver for Newton's iteration, either the chosen one or the default for the
    /// field; none for the fixed-point iteration.
    pub fn linear_solver(&self) -> Option<&LinearSolver> {
        self.linear.as_ref().map(Linear::choice)
    }

    /// The weights 1/(rtol |yᵢ| + atolᵢ) of the error test, one for each component, at the end of
    /// the last internal step.
    ///
    /// # Errors
    /// [`InputError::NoStep`] before the first step.
    pub fn error_weights(&mut self) -> Result<&[f64], SolveError> {
        self.vector("CVodeGetErrWeights", sys::CVodeGetErrWeights)
    }

    /// The estimated local errors of the components in the last internal step; a step is accepted
    /// if the root mean square of their products with the [weights](Cvode::error_weights) is at
    /// most 1.
    ///
    /// # Errors
    /// [`InputError::NoStep`] before the first step.
    pub fn local_errors(&mut self) -> Result<&[f64], SolveError> {
        self.vector("CVodeGetEstLocalErrors", sys::CVodeGetEstLocalErrors)
    }

    /// A vector that CVODES provides after the first step.
    fn vector(
        &mut self,
        name: &'static str,
        get: unsafe extern "C" fn(*mut c_void, sys::N_Vector) -> c_int,
    ) -> Result<&[f64], SolveError> {
        if self.direction.is_none() {
            return Err(InputError::NoStep.into());
        }
        // SAFETY: memory and vector are live and of one context; CVODES copies to the vector.
        let code = unsafe { get(self.memory.raw(), self.work.raw()) };
        self.context.check(name, code)?;
        Ok(self.work.as_slice())
    }

    pub(super) fn set_cvodes_stop_time(&mut self, stop_time: Option<f64>) -> Result<(), SolveError> {
        match stop_time {
            Some(t) => self.memory.set(&mut self.context, "CVodeSetStopTime", sys::CVodeSetStopTime, t),
            None => {
                // SAFETY: the memory is live and initialised.
                let code = unsafe { sys::CVodeClearStopTime(self.memory.raw()) };
                self.context.check("CVodeClearStopTime", code)
            }
        }
    }

    /// Makes one step of CVODES.
    pub(crate) fn internal_step(&mut self, towards: f64) -> Result<(), SolveError> {
        if self.direction.is_none()
            && let Some(length) = self.initial_step
        {
            let length = length.copysign(towards - self.step_time);
            self.memory.set(&mut self.context, "CVodeSetInitStep", sys::CVodeSetInitStep, length)?;
        }
        let end = self.stop_before_break(towards)?.or(self.stop_time);
        let start = self.step_time;
        let is_before = |place: &f64| end.is_none_or(|end| (end - place) * (end - start) > 0.0);
        let landing = self.foresee(towards)?.filter(is_before);
        if let Some(t) = landing {
            self.memory.set(&mut self.context, "CVodeSetStopTime", sys::CVodeSetStopTime, t)?;
        }
        // CVODES respects its stop time only if the target is not nearer.
        let target = landing.or(end).unwrap_or(towards);
        let mut t = self.step_time;
        self.restarted = false;
        // SAFETY: all is live and of one context; callbacks use only the user data, which nobody
        // holds meanwhile.
        let code =
            unsafe { sys::CVode(self.memory.raw(), target, self.work.raw(), &raw mut t, sys::CV_ONE_STEP) };
        if let Some(panic) = self.callbacks.take_panic() {
            self.time = self.step_time;
            resume_unwind(panic);
        }
        let failure = self.callbacks.take_failure();
        let message = self.context.take_messages();
        if landing.is_some() {
            self.set_cvodes_stop_time(self.stop_time)?;
        }
        if code != sys::CV_SUCCESS && code != sys::CV_TSTOP_RETURN {
            return Err(self.failed(Reason::Cvode { code: code.into(), message }, failure));
        }
        // A vectorisable check; the index is needed only if it fails.
        if !self.work.as_slice().iter().fold(true, |finite, value| finite & value.is_finite())
            && let Some(i) = self.work.as_slice().iter().position(|value| !value.is_finite())
        {
            let component = self.field().component_name(i);
            let value = self.work.as_slice()[i];
            return Err(self.failed(Reason::Overflow { component, value, t }, failure));
        }
        self.project(t, true)?;
        std::mem::swap(&mut self.step_state, &mut self.work);
        self.direction.get_or_insert(1.0_f64.copysign(towards - self.step_time));
        let before = std::mem::replace(&mut self.step_time, t);
        self.time = t;
        self.check_progress(before, failure)
    }

    /// Fails if many successive steps have not advanced the time; the last one began at `before`.
    ///
    /// `failure` occurred in the last step and was overcome by shortening the step.
    fn check_progress(&mut self, before: f64, failure: Option<Failure>) -> Result<(), SolveError> {
        if self.step_time != before {
            self.idle_steps = 0;
            self.idle_failure = None;
            return Ok(());
        }
        self.idle_steps += 1;
        self.idle_failure = failure.or(self.idle_failure.take());
        if self.idle_steps < MAX_IDLE_STEPS {
            return Ok(());
        }
        self.idle_steps = 0;
        let failure = self.idle_failure.take();
        Err(self.failed(Reason::Stalled, failure))
    }

    /// Projects the work vector, which CVODES has written for time `t`, at the end of a step or
    /// inside it.
    pub(super) fn project(&mut self, t: f64, step: bool) -> Result<(), SolveError> {
        let Some((field, offset)) = self.callbacks.projection() else { return Ok(()) };
        match offset.project(field, t, self.work.as_mut_slice(), step) {
            Ok(()) => Ok(()),
            Err(failure) => Err(self.failed(Reason::Projection { t }, Some(failure))),
        }
    }

    /// Moves to the end of the last successful step and returns the error of the failed one.
    pub(super) fn failed(&mut self, reason: Reason, failure: Option<Failure>) -> SolveError {
        self.time = self.step_time;
        self.error(reason, failure)
    }

    pub(crate) fn error(&self, reason: Reason, failure: Option<Failure>) -> SolveError {
        let state = self.step_state.as_slice().to_vec();
        SolveError::Integration(Box::new(IntegrationError { reason, time: self.step_time, state, failure }))
    }
}

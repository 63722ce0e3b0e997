//! The integrator.

pub(crate) use crate::cvode::quadrature::Quadratures;

use std::ffi::{c_int, c_void};
use std::fmt;
use std::ops::ControlFlow;
use std::panic::resume_unwind;

use pc_expr::{Failure, VectorField};
use sundials_sys as sys;

use crate::cvode::callback::UserData;
use crate::cvode::context::Context;
use crate::cvode::handles::{Memory, NonlinearIteration, Vector};
use crate::cvode::return_code::Code;
use crate::error::{InputError, IntegrationError, Reason, SolveError};
use crate::events::events::Accumulation;
use crate::integration::inequality::Inequality;
use crate::integration::options::finite;
use crate::integration::statistics::Statistics;
use crate::linear::linear::{Linear, LinearSolver};

/// An integration of ẏ = f(t, y) by CVODES, owning the vector field.
///
/// It stands at a [`time`](Cvode::time) with a [`state`](Cvode::state). CVODES itself may be up to one internal step
/// ahead; outputs in between are interpolated with the polynomial of the method, so that asking for more of them
/// changes no step. The direction of time is that of the first step.
///
/// After an error the state is the last one reached. A panic of the vector field leaves the integration so too and
/// goes on to the caller.
pub struct Cvode<F> {
    // Dropped in this order: what CVODES refers to after CVODES, the context last.
    pub(crate) memory: Memory,
    pub(super) _nonlinear_iteration: NonlinearIteration,
    pub(super) linear: Option<Linear>,
    pub(crate) sensitivity: Option<crate::sensitivity::forward::Forward>,
    pub(crate) quadrature: Option<crate::cvode::quadrature::Integration>,
    /// y(`step_time`).
    pub(crate) step_state: Vector,
    /// y(`time`), unless `time` is `step_time`.
    pub(crate) output: Vector,
    /// Where CVODES writes.
    pub(crate) work: Vector,
    pub(crate) callbacks: UserData<F>,
    pub(crate) context: Context,

    pub(crate) time: f64,
    /// How far CVODES is.
    pub(crate) step_time: f64,
    /// 1 or −1 since the first step.
    pub(crate) direction: Option<f64>,
    pub(super) initial_step: Option<f64>,
    pub(super) max_steps: u64,
    pub(super) stop_time: Option<f64>,
    pub(super) inequalities: Vec<Inequality>,
    /// Steps in sequence that have ended at the same time, and the last failure got over in them.
    pub(super) idle_steps: u32,
    pub(super) idle_failure: Option<Failure>,
    /// The work before the last restart, and whether there has been no step since.
    pub(super) earlier: Statistics,
    pub(crate) restarted: bool,
    /// Whether there has been a restart.
    pub(super) jumped: bool,
    pub(super) foresight: crate::cvode::foresight::Foresight,
    /// For events.
    pub(super) samples_per_step: u32,
    pub(super) accumulation: Accumulation,
}

/// CVODE goes on if t + h = t, since h may grow again; after so many such steps it will not.
const MAX_IDLE_STEPS: u32 = 1000;

// SAFETY: the SUNDIALS objects are reached through this struct alone, share nothing with other contexts and are not
// tied to a thread; F is the only part that could be.
unsafe impl<F: Send> Send for Cvode<F> {}

impl<F: VectorField> fmt::Debug for Cvode<F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Cvode")
            .field("time", &self.time)
            .field("state", &self.state())
            .field("statistics", &self.statistics())
            .finish_non_exhaustive()
    }
}

/// How a [`run`](Cvode::run) ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ending {
    /// All output times were reached.
    Completed,
    /// An observer stopped it.
    Stopped,
    /// A terminal event.
    Event {
        /// Its number among the events.
        event: usize,
    },
}

impl<F: VectorField> Cvode<F> {
    /// Integrates to `t` and returns the state there, at once if it is where the integration stands.
    ///
    /// # Errors
    /// [`SolveError::Input`] if `t` is not finite, lies behind or beyond the stop time;
    /// [`SolveError::Integration`] if the integration fails.
    pub fn advance_to(&mut self, t: f64) -> Result<&[f64], SolveError> {
        self.check_ahead(t)?;
        // Without an observer nothing can stop it.
        let _ = self.advance(t, t, &mut |_, _| ControlFlow::Continue(()))?;
        Ok(self.state())
    }

    /// Takes one internal step in the direction of `towards` and returns its end, which may lie beyond `towards`.
    ///
    /// If the integration stands inside the last step, goes to the end of that step instead. The length of the first
    /// step, unless given, is estimated with the distance to `towards` as scale.
    ///
    /// # Errors
    /// As for [`advance_to`](Cvode::advance_to); [`InputError::EndIsStart`] if `towards` is where it stands.
    pub fn step(&mut self, towards: f64) -> Result<f64, SolveError> {
        self.check_ahead(towards)?;
        if towards == self.time {
            return Err(InputError::EndIsStart { t: towards }.into());
        }
        if self.time == self.step_time {
            self.internal_step(towards)?;
        } else {
            self.time = self.step_time;
        }
        Ok(self.time)
    }

    /// Integrates through `times`, which go one way from where the integration stands, and gives each (t, y) to
    /// `output`.
    ///
    /// The first time may be where the integration stands, the last may not.
    ///
    /// # Errors
    /// As for [`advance_to`](Cvode::advance_to); outputs before the failure have been given.
    pub fn run(
        &mut self,
        times: &[f64],
        output: impl FnMut(f64, &[f64]) -> ControlFlow<()>,
    ) -> Result<Ending, SolveError> {
        self.run_observed(times, output, |_, _| ControlFlow::Continue(()))
    }

    /// As [`run`](Cvode::run), and gives the end (t, y) of each internal step to `step`, before the outputs inside
    /// that step: to show progress, or to stop.
    ///
    /// # Errors
    /// As for [`run`](Cvode::run).
    pub fn run_observed(
        &mut self,
        times: &[f64],
        mut output: impl FnMut(f64, &[f64]) -> ControlFlow<()>,
        mut step: impl FnMut(f64, &[f64]) -> ControlFlow<()>,
    ) -> Result<Ending, SolveError> {
        let end = self.check_times(times)?;
        for &t in times {
            if self.advance(t, end, &mut step)?.is_break() || output(t, self.state()).is_break() {
                return Ok(Ending::Stopped);
            }
        }
        Ok(Ending::Completed)
    }

    /// Where the integration stands: the time last advanced or stepped to.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// y at [`time`](Cvode::time).
    pub fn state(&self) -> &[f64] {
        if self.time == self.step_time { self.step_state.as_slice() } else { self.output.as_slice() }
    }

    /// The vector field.
    pub fn field(&self) -> &F {
        self.callbacks.field()
    }

    /// Ends the integration and gives the vector field back.
    pub fn into_field(self) -> F {
        let Cvode { memory, callbacks, .. } = self;
        drop(memory);
        callbacks.into_field() // The other parts are dropped after this, in order.
    }

    /// The work so far.
    pub fn statistics(&self) -> Statistics {
        if self.restarted {
            return self.earlier;
        }
        let linear = self.linear.as_ref().map(|_| self.callbacks.linear());
        let mut since = Statistics::read(&self.memory, linear);
        since.rhs_evaluations += self.foresight.evaluations;
        since.limited_steps = self.foresight.limited;
        self.earlier.followed_by(&since)
    }

    /// The linear solver of Newton's iteration, as chosen or as the field made it; none for the fixed-point iteration.
    pub fn linear_solver(&self) -> Option<&LinearSolver> {
        self.linear.as_ref().map(Linear::choice)
    }

    /// The weights 1/(rtol |yᵢ| + atolᵢ) of the error test, one for each component, at the end of the last internal step.
    ///
    /// # Errors
    /// [`InputError::NoStep`] before the first step.
    pub fn error_weights(&mut self) -> Result<&[f64], SolveError> {
        self.vector("CVodeGetErrWeights", sys::CVodeGetErrWeights)
    }

    /// The estimated local errors of the components in the last internal step; a step is accepted if the root mean
    /// square of their products with the [weights](Cvode::error_weights) is at most 1.
    ///
    /// # Errors
    /// [`InputError::NoStep`] before the first step.
    pub fn local_errors(&mut self) -> Result<&[f64], SolveError> {
        self.vector("CVodeGetEstLocalErrors", sys::CVodeGetEstLocalErrors)
    }

    /// A vector that CVODES has once a step has been taken.
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

    /// Sets a time beyond which the vector field is never evaluated, or removes it.
    ///
    /// # Errors
    /// [`SolveError::Input`] if it is not finite or lies behind the last internal step.
    pub fn set_stop_time(&mut self, stop_time: Option<f64>) -> Result<(), SolveError> {
        if let Some(t) = stop_time {
            finite("the stop time", t)?;
            if self.direction.is_some_and(|direction| (t - self.step_time) * direction < 0.0) {
                return Err(InputError::Behind { requested: t, current: self.step_time }.into());
            }
        }
        self.set_cvodes_stop_time(stop_time)?;
        self.stop_time = stop_time;
        Ok(())
    }

    fn set_cvodes_stop_time(&mut self, stop_time: Option<f64>) -> Result<(), SolveError> {
        match stop_time {
            Some(t) => self.memory.set(&mut self.context, "CVodeSetStopTime", sys::CVodeSetStopTime, t),
            None => {
                // SAFETY: the memory is live and initialised.
                let code = unsafe { sys::CVodeClearStopTime(self.memory.raw()) };
                self.context.check("CVodeClearStopTime", code)
            }
        }
    }

    /// Checks that the integration can go on to `t`.
    pub(super) fn check_ahead(&self, t: f64) -> Result<(), InputError> {
        finite("the time", t)?;
        if t == self.time {
            return Ok(());
        }
        let direction = self.direction.unwrap_or(1.0_f64.copysign(t - self.time));
        if (t - self.time) * direction < 0.0 {
            return Err(InputError::Behind { requested: t, current: self.time });
        }
        match self.stop_time {
            Some(stop_time) if (t - stop_time) * direction > 0.0 => {
                Err(InputError::BeyondStopTime { requested: t, stop_time })
            }
            _ => Ok(()),
        }
    }

    /// Checks output times and returns the last.
    pub(crate) fn check_times(&self, times: &[f64]) -> Result<f64, InputError> {
        let &end = times.last().ok_or(InputError::NoTimes)?;
        for (i, &t) in times.iter().enumerate() {
            finite(&format!("output time number {i} (from 0)"), t)?;
        }
        if end == self.time {
            return Err(InputError::EndIsStart { t: end });
        }
        let direction = 1.0_f64.copysign(end - self.time);
        for (i, pair) in times.windows(2).enumerate() {
            if (pair[1] - pair[0]) * direction <= 0.0 {
                return Err(InputError::TimesNotMonotonic { index: i + 1, previous: pair[0], time: pair[1] });
            }
        }
        if (times[0] - self.time) * direction < 0.0 {
            return Err(InputError::Behind { requested: times[0], current: self.time });
        }
        self.check_ahead(end)?;
        Ok(end)
    }

    /// Goes to `t`, which has been checked, with internal steps towards `end` as far as needed.
    pub(crate) fn advance(
        &mut self,
        t: f64,
        end: f64,
        observe: &mut impl FnMut(f64, &[f64]) -> ControlFlow<()>,
    ) -> Result<ControlFlow<()>, SolveError> {
        if t == self.time {
            return Ok(ControlFlow::Continue(()));
        }
        let mut steps = 0;
        while self.direction.is_none_or(|direction| (t - self.step_time) * direction > 0.0) {
            self.check_steps(steps, t)?;
            self.internal_step(end)?;
            steps += 1;
            if observe(self.step_time, self.step_state.as_slice()).is_break() {
                return Ok(ControlFlow::Break(()));
            }
        }
        if t != self.step_time {
            self.interpolate_to_work(t, 0)?;
            std::mem::swap(&mut self.output, &mut self.work);
        }
        self.time = t;
        Ok(ControlFlow::Continue(()))
    }

    /// That one more step may be taken after so many on the way to `t`: counted here, because CVODES is asked for one step
    /// at a time.
    pub(crate) fn check_steps(&mut self, steps: u64, t: f64) -> Result<(), SolveError> {
        if steps < self.max_steps {
            return Ok(());
        }
        let message = format!("{steps} internal steps taken before reaching t = {t}.");
        Err(self.failed(Reason::Cvode { code: Code::TooMuchWork, message }, None))
    }

    /// One step of CVODES.
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
        // CVODES minds its stop time only if the target is not nearer.
        let target = landing.or(end).unwrap_or(towards);
        let mut t = self.step_time;
        self.restarted = false;
        // SAFETY: all is live and of one context; callbacks use only the user data, which nobody holds meanwhile.
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
        // Looked at several at a time; which it is matters only if there is one.
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

    /// Fails if many steps in sequence have ended where they began, the last at `before`.
    ///
    /// `failure` was met in the last step and got over by a shorter one.
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

    /// Makes a state of what CVODES has written for time `t`, at the end of a step or within it.
    pub(super) fn project(&mut self, t: f64, step: bool) -> Result<(), SolveError> {
        let Some((field, offset)) = self.callbacks.projection() else { return Ok(()) };
        match offset.project(field, t, self.work.as_mut_slice(), step) {
            Ok(()) => Ok(()),
            Err(failure) => Err(self.failed(Reason::Projection { t }, Some(failure))),
        }
    }

    /// The error of a failed step, after going to the end of the last successful one.
    pub(super) fn failed(&mut self, reason: Reason, failure: Option<Failure>) -> SolveError {
        self.time = self.step_time;
        self.error(reason, failure)
    }

    pub(crate) fn error(&self, reason: Reason, failure: Option<Failure>) -> SolveError {
        let state = self.step_state.as_slice().to_vec();
        SolveError::Integration(Box::new(IntegrationError { reason, time: self.step_time, state, failure }))
    }
}

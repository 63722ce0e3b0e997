//! The stepper that switches between two methods.

use std::fmt;

use pc_expr::{Method, VectorField};

use super::growth::Growth;
use crate::cvode::cvode::Cvode;
use crate::cvode::linear::choice::choose;
use crate::dop853::setup::Dop853;
use crate::error::SolveError;
use crate::integration::checks::{check_inequalities, check_start};
use crate::integration::statistics::Statistics;
use crate::integration::stepper::{LastStep, Stepper};
use crate::settings::options::Options;

/// A BDF step of length h counts as non-stiff if h ρ is below this. Such a step takes about two
/// evaluations of f and two linear solves; an explicit step takes twelve evaluations and is stable
/// up to h = 6.1/ρ, so that the explicit method costs no more, even where stability limits its
/// steps.
const STIFF: f64 = 1.0;
/// One in this many BDF steps is examined, …
const EVERY: u64 = 4;
/// … and this many successive examined steps must be non-stiff; the number doubles at each return.
const CLEAR: u32 = 8;
/// The number of returns after which that number stops doubling.
const DOUBLINGS: u32 = 8;

/// A method that uses [`Dop853`] where the motion is not stiff, and [`Cvode`] with BDF formulas
/// where it is.
///
/// The integration begins with the explicit method. Where [stiffness](Dop853::stiff_from) is
/// detected, CVODE continues from the end of that step at order 1; once the length of the steps
/// times an estimate of the largest eigenvalue of ∂f/∂y has been below 1 for many steps, it returns
/// to the explicit method, which is stable while this product is at most 6.1. Each return doubles
/// the number of steps needed for the next one, to prevent oscillation between the methods. The
/// motion alone decides: the same input gives the same steps. A motion resumed from a checkpoint
/// always begins with the explicit method.
pub struct Auto<F: VectorField> {
    /// The current method; none only while one method replaces the other.
    engine: Option<Engine<F>>,
    /// The options of both methods; the method they name is [`Method::Bdf`].
    options: Options,
    growth: Growth,
    /// The number of BDF steps since the last change, and of successive examined steps that were
    /// non-stiff.
    steps: u64,
    clear: u32,
    returns: u32,
    /// The work before the last change, and the evaluations made by `growth` since then.
    earlier: Statistics,
    evaluations: u64,
}

/// The current method, with its state.
pub(super) enum Engine<F: VectorField> {
    Explicit(Box<Dop853<F>>),
    Implicit(Box<Cvode<F>>),
}

impl<F: VectorField> fmt::Debug for Auto<F> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Auto")
            .field("time", &self.time())
            .field("state", &self.end_state())
            .field("method", &self.method())
            .field("statistics", &self.statistics())
            .finish_non_exhaustive()
    }
}

impl<F: VectorField> Auto<F> {
    /// The estimated local errors of the components in the last step, where BDF made it; none where DOP853 did.
    ///
    /// # Errors
    /// As for [`Cvode::local_errors`].
    pub(crate) fn local_errors(&mut self) -> Result<Option<&[f64]>, SolveError> {
        match &mut self.engine {
            Some(Engine::Implicit(cvode)) => cvode.local_errors().map(Some),
            Some(Engine::Explicit(_)) | None => Ok(None),
        }
    }

    /// Starts at y(t0) = y0, one number per component; the method chosen in the options is ignored,
    /// but the options for implicit equations apply to the BDF method.
    ///
    /// # Errors
    /// As for [`Cvode::new`] and [`Dop853::new`].
    pub fn new(field: F, t0: f64, y0: &[f64], options: &Options) -> Result<Self, SolveError> {
        check_start(&field, t0, y0)?;
        Options { method: Method::Auto, ..options.clone() }.validate(y0.len())?;
        check_inequalities(&field, y0, &options.inequalities)?;
        let mut options = Options { method: Method::Bdf, ..options.clone() };
        choose(&field, &options)?;
        let explicit = Dop853::of(field, t0, y0, &options);
        options.initial_step = None; // only for the start of the motion
        Ok(Auto {
            engine: Some(Engine::Explicit(Box::new(explicit))),
            options,
            growth: Growth::new(y0.len()),
            steps: 0,
            clear: 0,
            returns: 0,
            earlier: Statistics::default(),
            evaluations: 0,
        })
    }

    /// The current method: [`Method::Dop853`] or [`Method::Bdf`].
    pub fn method(&self) -> Method {
        match self.engine() {
            Engine::Explicit(_) => Method::Dop853,
            Engine::Implicit(_) => Method::Bdf,
        }
    }

    pub(super) fn engine(&self) -> &Engine<F> {
        self.engine.as_ref().expect("taken only by `change`")
    }

    pub(super) fn engine_mut(&mut self) -> &mut Engine<F> {
        self.engine.as_mut().expect("taken only by `change`")
    }

    pub(super) fn into_engine(self) -> Engine<F> {
        self.engine.expect("taken only by `change`")
    }

    /// The work of both methods.
    pub(super) fn work(&self) -> Statistics {
        let since = match self.engine() {
            Engine::Explicit(explicit) => explicit.statistics(),
            Engine::Implicit(implicit) => {
                let work = implicit.statistics();
                let rhs_evaluations = work.rhs_evaluations + self.evaluations;
                Statistics { rhs_evaluations, implicit_steps: work.steps, ..work }
            }
        };
        let mut all = self.earlier.followed_by(&since);
        if since.steps == 0 && self.earlier.steps > 0 {
            // No step since the change: orders and lengths are those before.
            let Statistics { last_order, current_order, last_step, current_step, .. } = self.earlier;
            all = Statistics { last_order, current_order, last_step, current_step, ..all };
        }
        all
    }

    /// Switches to the other method if the last steps call for the change.
    pub(super) fn consider(&mut self) -> Result<(), SolveError> {
        let changes = match self.engine() {
            Engine::Explicit(explicit) => explicit.stiff_from().is_some(),
            Engine::Implicit(_) => self.is_clear(),
        };
        if changes { self.change() } else { Ok(()) }
    }

    /// Whether BDF steps have been non-stiff for long enough.
    fn is_clear(&mut self) -> bool {
        let Some(Engine::Implicit(implicit)) = &mut self.engine else { return false };
        let LastStep { start, end, degree: Some(_) } = implicit.last_step() else { return false };
        self.steps += 1;
        if !self.steps.is_multiple_of(EVERY) {
            return false;
        }
        let Auto { growth, evaluations, .. } = self;
        growth.stand(implicit.end_state(), |i, y| implicit.tolerance(i, y));
        let rho = growth.estimate(|state, rates| {
            *evaluations += 1;
            implicit.field_mut().rhs(end, state, rates).is_ok() && rates.iter().all(|rate| rate.is_finite())
        });
        let Some(rho) = rho else { return false };
        self.clear = if (end - start).abs() * rho < STIFF { self.clear + 1 } else { 0 };
        self.clear >= CLEAR << self.returns.min(DOUBLINGS)
    }

    /// Continues with the other method from the end of the last step.
    fn change(&mut self) -> Result<(), SolveError> {
        let work = self.work();
        let engine = self.engine_mut();
        let (t, y) = match engine {
            Engine::Explicit(explicit) => (explicit.last_step().end, explicit.end_state().to_vec()),
            Engine::Implicit(implicit) => (implicit.last_step().end, implicit.end_state().to_vec()),
        };
        let (limits, stop_time) = match engine {
            Engine::Explicit(explicit) => (explicit.limits().clone(), explicit.stop_time()),
            Engine::Implicit(implicit) => (implicit.limits().clone(), implicit.stop_time()),
        };
        self.options.stop_time = stop_time;
        let mut failed = None;
        self.engine = self.engine.take().map(|engine| match engine {
            Engine::Explicit(explicit) => match Cvode::start(explicit.into_field(), t, &y, &self.options) {
                Ok(implicit) => Engine::Implicit(Box::new(implicit)),
                Err((error, field)) => {
                    failed = Some(error);
                    Engine::Explicit(Box::new(Dop853::of(field, t, &y, &self.options)))
                }
            },
            Engine::Implicit(implicit) => {
                self.returns += 1;
                Engine::Explicit(Box::new(Dop853::of(implicit.into_field(), t, &y, &self.options)))
            }
        });
        match self.engine_mut() {
            Engine::Explicit(explicit) => *explicit.limits_mut() = limits,
            Engine::Implicit(implicit) => *implicit.limits_mut() = limits,
        }
        self.earlier = Statistics { changes: work.changes + 1, ..work };
        (self.steps, self.clear, self.evaluations) = (0, 0, 0);
        self.growth.forget();
        failed.map_or(Ok(()), Err)
    }
}

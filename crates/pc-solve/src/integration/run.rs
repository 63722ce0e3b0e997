//! Integration from event to event, through the output times.

use std::ops::ControlFlow;

use pc_expr::{Deadline, Events, VectorField};

use crate::error::{InputError, Reason, Shrinks, SolveError};
use crate::events::events::Occurrence;
use crate::integration::checks::finite;
use crate::integration::integration::{Ending, Integration};
use crate::integration::observer::{Observed, Observer};
use crate::integration::pace::Crawl;
use crate::integration::stepper::Stepper;

impl<S: Stepper, E: Events> Integration<S, E> {
    /// Integrates to `t`, or to an earlier terminal event, and reports events, including those at
    /// `t`, to `occurred`, which may stop the integration. All simultaneous events are reported; if
    /// one of them is terminal, the [`Ending`] is that event, even if `occurred` stops the
    /// integration.
    ///
    /// # Errors
    /// [`SolveError::Input`] if `t` is not finite, lies before the current time or beyond the stop
    /// time; [`SolveError::Integration`] if the integration fails, with [`Reason::Event`],
    /// [`Reason::Reset`], [`Reason::Projection`] and [`Reason::Accumulation`] for events.
    pub fn advance_to(
        &mut self,
        t: f64,
        occurred: impl FnMut(&Occurrence) -> ControlFlow<()>,
    ) -> Result<Ending, SolveError> {
        self.advance_observed(
            t,
            Observed::new(|_, _: &[f64]| ControlFlow::Continue(())).occurrences(occurred),
        )
    }

    /// Like [`advance_to`](Integration::advance_to), but reports events and steps to an [`Observer`], which receives no
    /// output.
    ///
    /// # Errors
    /// As for [`advance_to`](Integration::advance_to).
    pub fn advance_observed(&mut self, t: f64, mut observer: impl Observer) -> Result<Ending, SolveError> {
        self.check_ahead(t)?;
        Ok(self.advance(t, t, &mut observer)?.unwrap_or(Ending::Completed))
    }

    /// Integrates through `times`, which are monotonic from the current time on, and passes each
    /// (t, y) to `output`, which may stop the integration.
    ///
    /// The first of them may be the current time, but the last may not. The output at an event is
    /// y⁺; a terminal event gives the last output.
    ///
    /// # Errors
    /// As for [`advance_to`](Integration::advance_to); outputs before the failure have been passed
    /// on.
    pub fn run(
        &mut self,
        times: &[f64],
        output: impl FnMut(f64, &[f64]) -> ControlFlow<()>,
    ) -> Result<Ending, SolveError> {
        self.run_observed(times, Observed::new(output))
    }

    /// Like [`run`](Integration::run), but reports to an [`Observer`].
    ///
    /// # Errors
    /// As for [`run`](Integration::run).
    pub fn run_observed(&mut self, times: &[f64], mut observer: impl Observer) -> Result<Ending, SolveError> {
        self.run_through(times, &mut observer, &mut |_| Ok(()))
    }

    /// The same, but calls `arrived` before each output.
    pub(crate) fn run_through(
        &mut self,
        times: &[f64],
        observer: &mut dyn Observer,
        arrived: &mut dyn FnMut(&mut Self) -> Result<(), SolveError>,
    ) -> Result<Ending, SolveError> {
        let end = self.check_times(times)?;
        for &t in times {
            // Many outputs may fall in one step.
            self.check_deadline()?;
            let ending = self.advance(t, end, observer)?;
            if let Some(Ending::Stopped) = ending {
                return Ok(Ending::Stopped);
            }
            arrived(self)?;
            let flow = observer.output(self.time(), self.state());
            if let Some(ending) = ending {
                return Ok(ending);
            }
            if flow.is_break() {
                return Ok(Ending::Stopped);
            }
        }
        Ok(Ending::Completed)
    }

    /// Checks that, after `steps` steps, another step towards `t` may be made.
    pub(crate) fn check_steps(&mut self, steps: u64, t: f64) -> Result<(), SolveError> {
        if steps < self.engine.limits().max_steps {
            return Ok(());
        }
        let last = self.statistics().last_step.abs();
        Err(self.failed(Reason::Steps { steps, t, last }, None))
    }

    /// Notes a step towards `end`.
    ///
    /// # Errors
    /// [`Reason::Crawls`] if the last steps have hardly advanced the time.
    fn note_pace(&mut self, end: f64) -> Result<(), SolveError> {
        let engine = &self.engine;
        match self.pace.note(self.front.t, end, || engine.statistics().limited_steps) {
            None => Ok(()),
            Some(Crawl { steps, by, shortened }) => {
                let cause = if shortened { Shrinks::Time } else { Shrinks::Component(self.fastest()) };
                Err(self.failed(Reason::Crawls { steps, by, cause }, None))
            }
        }
    }

    /// The component whose rate is the largest relative to the tolerances.
    fn fastest(&mut self) -> String {
        let (t, state) = (self.front.t, self.front_state.clone());
        let mut rates = vec![f64::NAN; state.len()];
        // Rates that fail are as fast as any.
        let known = self.engine.field_mut().rhs(t, &state, &mut rates).is_ok();
        let speed = |i: usize| if known { rates[i].abs() / self.engine.tolerance(i, state[i]) } else { 0.0 };
        let fastest = (0..state.len()).max_by(|&i, &j| speed(i).total_cmp(&speed(j))).unwrap_or(0);
        self.field().component_name(fastest)
    }

    /// Checks that the deadline has not passed.
    pub(crate) fn check_deadline(&mut self) -> Result<(), SolveError> {
        match self.engine.limits().deadline.as_ref().and_then(Deadline::passed) {
            None => Ok(()),
            Some(spent) => Err(self.failed(Reason::Ended(spent), None)),
        }
    }

    /// Advances to `t`, which has been checked, with steps towards `end`.
    fn advance(
        &mut self,
        t: f64,
        end: f64,
        observer: &mut dyn Observer,
    ) -> Result<Option<Ending>, SolveError> {
        let mut steps = 0;
        while !self.is_before_front(t) {
            if !self.due.is_empty() {
                if let Some(ending) = self.occur(&mut |occurrence| observer.occurred(occurrence))? {
                    return Ok(Some(ending));
                }
                continue;
            }
            if t == self.front.t {
                break;
            }
            self.check_steps(steps, t)?;
            // So that it is at the front if the field or the observer panics.
            self.engine.stand_at(self.front.t);
            let makes_step = self.engine.end_time() == self.front.t;
            self.go_on(end)?;
            self.engine.stand_at(self.front.t);
            // What is left of a step after an event is none.
            if makes_step {
                steps += 1;
                self.note_pace(end)?;
            }
            if self.report_step(observer).is_break() {
                return Ok(Some(Ending::Stopped));
            }
        }
        self.stand_at(t)?;
        Ok(None)
    }

    /// Reports the end of a step, or of the part of a step before an event.
    pub(crate) fn report_step(&self, observer: &mut dyn Observer) -> ControlFlow<()> {
        observer.step(self.front.t, &self.front_state)?;
        if observer.measures() {
            observer.measured(self.front.t, &self.front_state, &self.statistics())?;
        }
        ControlFlow::Continue(())
    }

    /// Applies the events at the time where an observer has stopped the integration; returns how
    /// the integration ends, if it does.
    pub(crate) fn settle(
        &mut self,
        occurred: impl FnMut(&Occurrence) -> ControlFlow<()>,
    ) -> Result<Option<Ending>, SolveError> {
        let mut observer = Observed::new(|_, _: &[f64]| ControlFlow::Continue(())).occurrences(occurred);
        self.advance(self.front.t, self.front.t, &mut observer)
    }

    /// Whether `t` lies before the front, so that all events at `t` have already been applied.
    pub(crate) fn is_before_front(&self, t: f64) -> bool {
        self.direction.is_some_and(|direction| (self.front.t - t) * direction > 0.0)
    }

    /// Moves to a time in the last step, at most the time of the front.
    pub(crate) fn stand_at(&mut self, t: f64) -> Result<(), SolveError> {
        if t != self.front.t && t != self.engine.time() {
            match self.engine.interpolate(t, 0) {
                Ok(state) => self.output.copy_from_slice(state),
                Err(error) => return Err(self.stay(error)),
            }
        }
        self.engine.stand_at(t);
        Ok(())
    }

    /// Checks that the integration can advance to `t`.
    pub(crate) fn check_ahead(&self, t: f64) -> Result<(), InputError> {
        finite("the time", t)?;
        let current = self.time();
        if t == current {
            return Ok(());
        }
        let direction = self.direction.unwrap_or(1.0_f64.copysign(t - current));
        if (t - current) * direction < 0.0 {
            return Err(InputError::Behind { requested: t, current });
        }
        match self.engine.stop_time() {
            Some(stop_time) if (t - stop_time) * direction > 0.0 => {
                Err(InputError::BeyondStopTime { requested: t, stop_time })
            }
            _ => Ok(()),
        }
    }

    /// Checks the output times and returns the last of them.
    pub(crate) fn check_times(&self, times: &[f64]) -> Result<f64, InputError> {
        let &end = times.last().ok_or(InputError::NoTimes)?;
        for (i, &t) in times.iter().enumerate() {
            finite(&format!("output time number {i} (from 0)"), t)?;
        }
        let current = self.time();
        if end == current {
            return Err(InputError::EndIsStart { t: end });
        }
        let direction = 1.0_f64.copysign(end - current);
        for (i, pair) in times.windows(2).enumerate() {
            if (pair[1] - pair[0]) * direction <= 0.0 {
                return Err(InputError::TimesNotMonotonic { index: i + 1, previous: pair[0], time: pair[1] });
            }
        }
        if (times[0] - current) * direction < 0.0 {
            return Err(InputError::Behind { requested: times[0], current });
        }
        self.check_ahead(end)?;
        Ok(end)
    }
}

//! Going on from event to event.

use crate::cvode::cvode::Ending;
use std::ops::ControlFlow;

use pc_expr::{Events, VectorField};

use crate::cvode::hybrid::hybrid::Hybrid;
use crate::cvode::return_code::Code;
use crate::error::{Reason, SolveError};
use crate::events::events::Occurrence;
use crate::integration::dense_output::Segment;

impl<F: VectorField, E: Events> Hybrid<F, E> {
    /// Integrates to `t`, or to a terminal event before, and tells what occurs, events at `t` included, to `occurred`,
    /// which may stop it. All that occurs together is told; if one of these events is terminal, it ends the integration, also
    /// where `occurred` stops it.
    ///
    /// # Errors
    /// As for [`Cvode::advance_to`](crate::Cvode::advance_to), and [`Reason::Event`], [`Reason::Reset`],
    /// [`Reason::Projection`] and [`Reason::Accumulation`] for events.
    pub fn advance_to(
        &mut self,
        t: f64,
        mut occurred: impl FnMut(&Occurrence) -> ControlFlow<()>,
    ) -> Result<Ending, SolveError> {
        self.engine.check_ahead(t)?;
        let ending = self.advance(t, t, &mut occurred, &mut |_, _| ControlFlow::Continue(()))?;
        Ok(ending.unwrap_or(Ending::Completed))
    }

    /// Integrates through `times`, which go one way from where the integration stands, gives each (t, y) to `output`
    /// and tells what occurs to `occurred`.
    ///
    /// The output at the time of an event is y⁺. A terminal event is the last output.
    ///
    /// # Errors
    /// As for [`advance_to`](Hybrid::advance_to) and [`Cvode::run`](crate::Cvode::run).
    pub fn run(
        &mut self,
        times: &[f64],
        output: impl FnMut(f64, &[f64]) -> ControlFlow<()>,
        occurred: impl FnMut(&Occurrence) -> ControlFlow<()>,
    ) -> Result<Ending, SolveError> {
        self.run_observed(times, output, occurred, |_, _| ControlFlow::Continue(()))
    }

    /// As [`run`](Hybrid::run), and gives the end (t, y⁻) of each internal step, or of the part of it before an event, to
    /// `step`.
    ///
    /// # Errors
    /// As for [`run`](Hybrid::run).
    pub fn run_observed(
        &mut self,
        times: &[f64],
        mut output: impl FnMut(f64, &[f64]) -> ControlFlow<()>,
        mut occurred: impl FnMut(&Occurrence) -> ControlFlow<()>,
        mut step: impl FnMut(f64, &[f64]) -> ControlFlow<()>,
    ) -> Result<Ending, SolveError> {
        let end = self.engine.check_times(times)?;
        for &t in times {
            let ending = self.advance(t, end, &mut occurred, &mut step)?;
            if let Some(Ending::Stopped) = ending {
                return Ok(Ending::Stopped);
            }
            let flow = output(self.time(), self.state());
            if let Some(ending) = ending {
                return Ok(ending);
            }
            if flow.is_break() {
                return Ok(Ending::Stopped);
            }
        }
        Ok(Ending::Completed)
    }

    /// As [`run`](Hybrid::run), and gives each (t, y, S) to `output`, y⁺ and S⁺ at the time of an event.
    ///
    /// # Errors
    /// As for [`run`](Hybrid::run) and [`sensitivities`](Hybrid::sensitivities).
    pub fn run_with_sensitivities(
        &mut self,
        times: &[f64],
        mut output: impl FnMut(f64, &[f64], &[f64]) -> ControlFlow<()>,
        mut occurred: impl FnMut(&Occurrence) -> ControlFlow<()>,
    ) -> Result<Ending, SolveError> {
        let end = self.engine.check_times(times)?;
        for &t in times {
            let ending = self.advance(t, end, &mut occurred, &mut |_, _| ControlFlow::Continue(()))?;
            if let Some(Ending::Stopped) = ending {
                return Ok(Ending::Stopped);
            }
            let matrix = self.engine.sensitivities()?.to_vec();
            let flow = output(self.time(), self.state(), &matrix);
            if let Some(ending) = ending {
                return Ok(ending);
            }
            if flow.is_break() {
                return Ok(Ending::Stopped);
            }
        }
        Ok(Ending::Completed)
    }

    /// Integrates to `end`, gives the motion as [`Segment`]s, one for each internal step or part of it between events,
    /// and tells what occurs to `occurred`, after the segment that ends there.
    ///
    /// # Errors
    /// As for [`run`](Hybrid::run).
    pub fn run_dense(
        &mut self,
        end: f64,
        mut segment: impl FnMut(Segment) -> ControlFlow<()>,
        mut occurred: impl FnMut(&Occurrence) -> ControlFlow<()>,
    ) -> Result<Ending, SolveError> {
        self.engine.check_times(&[end])?;
        let mut steps = 0;
        loop {
            let (from, state) = (self.time(), self.state().to_vec());
            let next = if self.is_before_front(end) { end } else { self.front.t };
            if next != from {
                self.stand_at(next)?;
                let reached = self.state().to_vec();
                let piece = self.engine.segment((from, &state), (next, &reached))?;
                if segment(piece).is_break() {
                    return Ok(Ending::Stopped);
                }
            } else if !self.due.is_empty() && from == self.front.t {
                if let Some(ending) = self.occur(&mut occurred)? {
                    return Ok(ending);
                }
            } else if from == end {
                return Ok(Ending::Completed);
            } else {
                self.check_steps(steps, end)?;
                self.go_on(end)?;
                steps += 1;
            }
        }
    }

    /// As [`run_dense`](Hybrid::run_dense), with the segment of S of the same span, whose components are its entries,
    /// column-major: from S⁺ to S⁻.
    ///
    /// # Errors
    /// As there; [`InputError::NoSensitivities`] if there are none.
    pub fn run_dense_with_sensitivities(
        &mut self,
        end: f64,
        mut segments: impl FnMut(Segment, Segment) -> ControlFlow<()>,
        mut occurred: impl FnMut(&Occurrence) -> ControlFlow<()>,
    ) -> Result<Ending, SolveError> {
        self.engine.check_times(&[end])?;
        let mut steps = 0;
        loop {
            let (from, state) = (self.time(), self.state().to_vec());
            let next = if self.is_before_front(end) { end } else { self.front.t };
            if next != from {
                self.stand_at(next)?;
                let reached = self.state().to_vec();
                let of_state = self.engine.segment((from, &state), (next, &reached))?;
                let of_matrix = self.engine.segment_of_sensitivities(from, next)?;
                if segments(of_state, of_matrix).is_break() {
                    return Ok(Ending::Stopped);
                }
            } else if !self.due.is_empty() && from == self.front.t {
                if let Some(ending) = self.occur(&mut occurred)? {
                    return Ok(ending);
                }
            } else if from == end {
                return Ok(Ending::Completed);
            } else {
                self.check_steps(steps, end)?;
                self.go_on(end)?;
                steps += 1;
            }
        }
    }

    /// That one more step may be taken after so many on the way to `t`.
    fn check_steps(&mut self, steps: u64, t: f64) -> Result<(), SolveError> {
        if steps < self.engine.max_steps {
            return Ok(());
        }
        let message = format!("{steps} internal steps taken before reaching t = {t}.");
        Err(self.failed(Reason::Cvode { code: Code::TooMuchWork, message }, None))
    }

    /// Goes to `t`, which has been checked, with internal steps towards `end` as far as needed.
    fn advance(
        &mut self,
        t: f64,
        end: f64,
        occurred: &mut impl FnMut(&Occurrence) -> ControlFlow<()>,
        observe: &mut impl FnMut(f64, &[f64]) -> ControlFlow<()>,
    ) -> Result<Option<Ending>, SolveError> {
        let mut steps = 0;
        while !self.is_before_front(t) {
            if !self.due.is_empty() {
                if let Some(ending) = self.occur(occurred)? {
                    return Ok(Some(ending));
                }
                continue;
            }
            if t == self.front.t {
                break;
            }
            self.check_steps(steps, t)?;
            self.go_on(end)?;
            steps += 1;
            if observe(self.front.t, &self.front_state).is_break() {
                self.engine.time = self.front.t;
                return Ok(Some(Ending::Stopped));
            }
        }
        self.stand_at(t)?;
        Ok(None)
    }

    /// Deals with what occurs where an observer has stopped the integration; how it ends, if it does.
    pub(crate) fn settle(
        &mut self,
        occurred: &mut impl FnMut(&Occurrence) -> ControlFlow<()>,
    ) -> Result<Option<Ending>, SolveError> {
        self.advance(self.front.t, self.front.t, occurred, &mut |_, _| ControlFlow::Continue(()))
    }

    /// Whether it is known what occurs at `t`, and nothing does.
    pub(crate) fn is_before_front(&self, t: f64) -> bool {
        self.direction.is_some_and(|direction| (self.front.t - t) * direction > 0.0)
    }

    /// Stands at a time up to the front, in the last internal step.
    pub(crate) fn stand_at(&mut self, t: f64) -> Result<(), SolveError> {
        if t != self.front.t && t != self.engine.time {
            if let Err(error) = self.engine.interpolate_to_work(t, 0) {
                return Err(self.stay(error));
            }
            self.output.copy_from_slice(self.engine.work.as_slice());
        }
        self.engine.time = t;
        Ok(())
    }
}

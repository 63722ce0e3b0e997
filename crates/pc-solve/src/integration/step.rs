//! Single steps, the states inside them, and motions given by the polynomials of the steps.

use std::ops::ControlFlow;

use pc_expr::Events;

use crate::error::{InputError, SolveError};
use crate::events::events::Occurrence;
use crate::integration::dense_output::Segment;
use crate::integration::integration::{Ending, Integration};
use crate::integration::observer::{Observed, Observer};
use crate::integration::stepper::Stepper;

/// Receives the start and the end of a part of a motion, with the states at these two times, and
/// the integration, which is at that end.
pub(crate) type Piece<'a, I> =
    dyn FnMut(&mut I, (f64, &[f64]), (f64, &[f64])) -> Result<ControlFlow<()>, SolveError> + 'a;

impl<S: Stepper, E: Events> Integration<S, E> {
    /// Takes one step towards `towards`, possibly beyond that time, or the part of a step before
    /// the next event, and reports events at its end to `occurred`.
    ///
    /// If the integration is already inside a step, it moves to the end of that step instead. The
    /// state is then y⁺.
    ///
    /// # Errors
    /// As for [`advance_to`](Integration::advance_to); [`InputError::EndIsStart`] if `towards` is
    /// the current time.
    pub fn step(
        &mut self,
        towards: f64,
        occurred: impl FnMut(&Occurrence) -> ControlFlow<()>,
    ) -> Result<Ending, SolveError> {
        let observer = Observed::new(|_, _: &[f64]| ControlFlow::Continue(())).occurrences(occurred);
        self.step_observed(towards, observer)
    }

    /// Like [`step`](Integration::step), but reports to an [`Observer`], which receives no output. If it stops the motion at
    /// the end of the step, events there are left for the next call.
    ///
    /// # Errors
    /// As for [`step`](Integration::step).
    pub fn step_observed(&mut self, towards: f64, mut observer: impl Observer) -> Result<Ending, SolveError> {
        self.check_ahead(towards)?;
        if towards == self.time() {
            return Err(InputError::EndIsStart { t: towards }.into());
        }
        if self.time() == self.front.t && self.due.is_empty() {
            self.go_on(towards)?;
            self.engine.stand_at(self.front.t);
            if self.report_step(&mut observer).is_break() {
                return Ok(Ending::Stopped);
            }
        }
        self.engine.stand_at(self.front.t);
        if self.due.is_empty() {
            return Ok(Ending::Completed);
        }
        Ok(self.occur(&mut |occurrence| observer.occurred(occurrence))?.unwrap_or(Ending::Completed))
    }

    /// The derivative of y of the given order at `t` in the last step, from the polynomial of the
    /// method, up to the front of the search for events.
    ///
    /// Order 0 is y itself, [projected](pc_expr::VectorField::project) where the field does so. The
    /// degree of a multistep method's polynomial is the order of that step.
    ///
    /// # Errors
    /// [`InputError::NoStep`] before the first step and after a reset; [`InputError::OutsideStep`]
    /// outside the last step, and beyond the next event; [`InputError::DerivativeOrder`] for an
    /// order above the degree; [`Reason::Projection`](crate::Reason::Projection).
    pub fn interpolate(&mut self, t: f64, order: u32) -> Result<&[f64], SolveError> {
        self.engine.last_step().check_inside(t, order, self.front.t)?;
        self.engine.interpolate(t, order)
    }

    /// Integrates to `end`, passes the motion to `segment`, as one [`Segment`] for each step or
    /// part of a step between events, and reports events to `occurred` after the segment that ends
    /// at their time.
    ///
    /// Only the last step is held in memory.
    ///
    /// # Errors
    /// As for [`run`](Integration::run); segments before the failure have been passed on.
    pub fn run_dense(
        &mut self,
        end: f64,
        segment: impl FnMut(Segment) -> ControlFlow<()>,
        occurred: impl FnMut(&Occurrence) -> ControlFlow<()>,
    ) -> Result<Ending, SolveError> {
        let observer = Observed::new(|_, _: &[f64]| ControlFlow::Continue(())).occurrences(occurred);
        self.run_dense_observed(end, segment, observer)
    }

    /// Like [`run_dense`](Integration::run_dense), but reports to an [`Observer`], which receives no output; the end of a
    /// step follows its segment.
    ///
    /// # Errors
    /// As for [`run_dense`](Integration::run_dense).
    pub fn run_dense_observed(
        &mut self,
        end: f64,
        mut segment: impl FnMut(Segment) -> ControlFlow<()>,
        mut observer: impl Observer,
    ) -> Result<Ending, SolveError> {
        self.run_in_pieces(end, &mut observer, &mut |integration, from, to| {
            Ok(segment(integration.segment(from, to)?))
        })
    }

    /// The same; `piece` receives the start and the end of a segment, with the states at these two
    /// times, while the integration is at that end.
    pub(crate) fn run_in_pieces(
        &mut self,
        end: f64,
        observer: &mut dyn Observer,
        piece: &mut Piece<'_, Self>,
    ) -> Result<Ending, SolveError> {
        self.check_times(&[end])?;
        let (mut steps, mut is_reported) = (0, true);
        loop {
            let (from, state) = (self.time(), self.state().to_vec());
            let next = if self.is_before_front(end) { end } else { self.front.t };
            if next != from {
                self.stand_at(next)?;
                let reached = self.state().to_vec();
                if piece(self, (from, &state), (next, &reached))?.is_break() {
                    return Ok(Ending::Stopped);
                }
                if !is_reported {
                    is_reported = true;
                    if self.report_step(observer).is_break() {
                        return Ok(Ending::Stopped);
                    }
                }
            } else if !self.due.is_empty() && from == self.front.t {
                if let Some(ending) = self.occur(&mut |occurrence| observer.occurred(occurrence))? {
                    return Ok(ending);
                }
            } else if from == end {
                return Ok(Ending::Completed);
            } else {
                self.check_steps(steps, end)?;
                self.go_on(end)?;
                (steps, is_reported) = (steps + 1, false);
            }
        }
    }

    /// The motion in the last step between two of its states.
    pub(crate) fn segment(
        &mut self,
        (start, from): (f64, &[f64]),
        (end, to): (f64, &[f64]),
    ) -> Result<Segment, SolveError> {
        // A part of a step that ends early is also expanded about its own end.
        let centre =
            if self.engine.centre() == self.engine.last_step().end { end } else { self.engine.centre() };
        let degree = self.engine.last_step().degree.unwrap_or(0);
        let (mut segment, closes) = if centre == end {
            (Segment::new((start, end), centre, to), (start, from))
        } else {
            let state = if centre == start { from } else { self.engine.interpolate(centre, 0)? };
            (Segment::new((start, end), centre, state), (end, to))
        };
        for k in 1..=degree {
            segment.push(k, self.engine.interpolate(centre, k)?);
        }
        segment.close(closes.0, closes.1);
        Ok(segment)
    }
}

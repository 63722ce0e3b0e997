//! What happens to the state at events.

use std::ops::ControlFlow;

use pc_expr::{Events, Failure, VectorField};

use super::{Ending, Hybrid};
use crate::error::{NonFinite, Reason, SolveError};
use crate::events::Occurrence;
use crate::inequality;

impl<F: VectorField, E: Events> Hybrid<F, E> {
    /// Deals with the events that occur at the front, and tells them to `occurred`; how the integration ends, if it does:
    /// by the first terminal event, else where `occurred` stops it.
    pub(super) fn occur(
        &mut self,
        occurred: &mut impl FnMut(&Occurrence) -> ControlFlow<()>,
    ) -> Result<Option<Ending>, SolveError> {
        let t = self.front.t;
        self.engine.time = t;
        let mut state = self.front_state.clone();
        let mut occurrences = Vec::with_capacity(self.due.len());
        for event in self.due.clone() {
            let state_before = state.clone();
            if self.events.events()[event].resets() {
                self.reset(event, t, &mut state)?;
            }
            let state_after = state.clone();
            occurrences.push(Occurrence { event, time: t, state_before, state_after });
        }
        if occurrences.iter().any(|occurrence| self.events.events()[occurrence.event].resets()) {
            let values = self.evaluate(t, &state)?;
            self.engine.restart(t, &state)?;
            self.engine.direction = self.direction;
            self.sides.jump(&values, std::mem::take(&mut self.noise));
            self.front.values = values;
            self.front_state = state;
        } else {
            self.sides.cross(&self.due, &self.front.values, &self.noise);
        }
        self.due.clear();

        let (mut terminal, mut stopped) = (None, None);
        for occurrence in &occurrences {
            if self.events.events()[occurrence.event].is_terminal() {
                terminal = terminal.or(Some(Ending::Event { event: occurrence.event }));
            }
            if occurred(occurrence).is_break() {
                stopped = Some(Ending::Stopped);
            }
        }
        let ending = terminal.or(stopped);
        for occurrence in &occurrences {
            let event = occurrence.event;
            let accumulates = self.histories[event].note(t, self.start, self.accumulation);
            if let (Some(t), None) = (accumulates, ending) {
                let occurrences = self.histories[event].occurrences;
                let reason = Reason::Accumulation { event: self.name(event), occurrences, t };
                return Err(self.failed(reason, None));
            }
        }
        Ok(ending)
    }

    /// y⁺ of one event, in the place of y⁻.
    fn reset(&mut self, event: usize, t: f64, state: &mut [f64]) -> Result<(), SolveError> {
        let mut result = self.events.reset(event, t, state);
        if let (Ok(()), Some(i)) = (&result, state.iter().position(|value| !value.is_finite())) {
            let component = self.field().component_name(i);
            let event = self.name(event);
            result = Err(Failure::fatal(NonFinite::Reset { event, component, value: state[i], t }));
        }
        if result.is_ok() {
            let allowed = inequality::check(self.field(), state, &self.engine.inequalities);
            result = allowed.map_err(Failure::fatal);
        }
        if let Err(failure) = result {
            let reason = Reason::Reset { event: self.name(event), t };
            return Err(self.failed(reason, Some(failure)));
        }
        let Some((field, _)) = self.engine.callbacks.projection() else { return Ok(()) };
        field.restart(t, state);
        match field.project(t, state) {
            Ok(()) => Ok(()),
            Err(failure) => Err(self.failed(Reason::Projection { t }, Some(failure))),
        }
    }
}

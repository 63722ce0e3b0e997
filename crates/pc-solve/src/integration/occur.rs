//! The effect of events on the state.

use std::collections::VecDeque;
use std::ops::ControlFlow;

use pc_expr::{Event, Events, Failure, VectorField};

use crate::error::{NonFinite, Reason, SolveError};
use crate::events::events::Occurrence;
use crate::events::root_finding::Sides;
use crate::integration::checks::check_inequalities;
use crate::integration::integration::{Ending, Integration};
use crate::integration::stepper::Stepper;

/// After a reset a function counts as near zero if it is at most this many times the change that
/// the tolerances of the state can make in it.
const TOLERANCES: f64 = 10.0;

/// An event that occurs more often than this at one time is taken to recur without end.
const MOST_AT_ONCE: usize = 100;

impl<S: Stepper, E: Events> Integration<S, E> {
    /// Applies the events at the front and reports them to `occurred`. Returns how the integration
    /// ends, if it does: at the first terminal event, or else because `occurred` stops it.
    ///
    /// If the reset of one event carries the function of another through zero in the direction of
    /// that other event, the other event occurs at the same time, after the events that are already
    /// due.
    pub(crate) fn occur(
        &mut self,
        occurred: &mut dyn FnMut(&Occurrence) -> ControlFlow<()>,
    ) -> Result<Option<Ending>, SolveError> {
        let t = self.front.t;
        self.engine.stand_at(t);
        let mut state = self.front_state.clone();
        let mut occurrences: Vec<Occurrence> = Vec::with_capacity(self.due.len());
        let mut matrix = self.sensitivities_before(t)?;
        let mut shifts = None;
        let moved = self.time_derivatives_of_due(t)?;
        let mut sides = self.sides.clone();
        sides.arrive(&self.due, &self.noise, &self.beyond);
        let mut values = None;
        let own = self.events.events().len();
        let reached: Vec<usize> = self.due.iter().filter_map(|&event| event.checked_sub(own)).collect();
        let mut queue: VecDeque<usize> = self.due.iter().copied().filter(|&event| event < own).collect();
        while let Some(event) = queue.pop_front() {
            self.check_cascade(event, t, &occurrences)?;
            let state_before = state.clone();
            let resets = self.events.events()[event].resets();
            if resets {
                let mut after = state.clone();
                self.reset(event, t, &mut after)?;
                if !matrix.is_empty() {
                    matrix = self.jump_of_sensitivities(event, t, (&state, &after), &matrix, &mut shifts)?;
                    // Resets of nearby states may have changed data kept in the field.
                    after.copy_from_slice(&state);
                    self.reset(event, t, &mut after)?;
                }
                state = after;
            }
            if self.has_columns() {
                // Those that a reset sets off occur when that one does.
                let own = moved.iter().find(|(known, _)| *known == event).map(|(_, shifts)| shifts.clone());
                let own = own.or_else(|| shifts.clone()).unwrap_or_default();
                self.time_derivatives.push(own);
            }
            let state_after = state.clone();
            occurrences.push(Occurrence { event, time: t, state_before, state_after });
            if resets {
                let reached = self.evaluate(t, &state)?;
                for carried in sides.carried(&reached).into_iter().filter(|&carried| carried < own) {
                    let is_new = carried != event && !queue.contains(&carried);
                    if is_new && self.stays_beyond(carried, t, &state, &reached, &sides, &matrix)? {
                        queue.push_back(carried);
                    }
                }
                let noise = self.noise_after_reset(t, &state, &reached, &occurrences);
                sides.jump(&reached, noise);
                values = Some(reached);
            }
        }
        match values {
            Some(values) => {
                self.engine.restart(t, &state, &matrix, self.direction)?;
                (self.restarted, self.jumped) = (true, true);
                self.sides = sides;
                self.front.values = values;
                self.front_state = state;
                self.held.are_known = false;
                self.begin_on_sides(self.direction.unwrap_or(1.0))?;
            }
            None => {
                self.sides.cross(&self.due, &self.front.values, &self.noise, &self.beyond);
                if !reached.is_empty() {
                    self.pass(&reached)?;
                }
            }
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
        for (k, occurrence) in occurrences.iter().enumerate() {
            let event = occurrence.event;
            if occurrences[..k].iter().any(|earlier| earlier.event == event) {
                continue; // its time is noted once
            }
            let mut limit = self.engine.limits().accumulation;
            if self.events.events()[event].settles() {
                limit.within = 0.0;
            }
            let accumulates = self.histories[event].note(t, limit);
            if let (Some(t), None) = (accumulates, ending) {
                let occurrences = self.histories[event].occurrences;
                let reason = Reason::Accumulation { event: self.name(event), occurrences, t };
                return Err(self.failed(reason, None));
            }
        }
        Ok(ending)
    }

    /// S⁻ at the front if a reset changes S; empty otherwise. Simultaneous resets are an error,
    /// since S⁺ is not defined there.
    fn sensitivities_before(&mut self, t: f64) -> Result<Vec<f64>, SolveError> {
        let events = self.events.events();
        let resets = self.due.iter().filter(|&&event| events.get(event).is_some_and(Event::resets)).count();
        if resets == 0 || self.engine.column_parameters().is_empty() {
            return Ok(Vec::new());
        }
        if resets > 1 {
            let own = self.due.iter().filter(|&&event| event < self.events.events().len());
            let events = own.map(|&event| self.name(event)).collect();
            return Err(self.failed(Reason::Together { events, t }, None));
        }
        self.engine.columns()
    }

    /// Returns an error if `event` has occurred too often at one time, since resets that set each
    /// other off go on for ever.
    fn check_cascade(&mut self, event: usize, t: f64, occurrences: &[Occurrence]) -> Result<(), SolveError> {
        let count = occurrences.iter().filter(|occurrence| occurrence.event == event).count();
        if count < MOST_AT_ONCE {
            return Ok(());
        }
        Err(self.failed(Reason::Cascade { event: self.name(event), occurrences: count, t }, None))
    }

    /// Whether a function that a reset has carried through zero, or exactly to zero, does not
    /// return at once to its original side along the motion from there, to first order in time.
    ///
    /// It is an error if sensitivities would require knowing whether nearby motions also arrive at
    /// zero.
    fn stays_beyond(
        &mut self,
        event: usize,
        t: f64,
        state: &[f64],
        values: &[f64],
        sides: &Sides,
        matrix: &[f64],
    ) -> Result<bool, SolveError> {
        if values[event] != 0.0 {
            return Ok(true);
        }
        let largest = |v: &[f64]| v.iter().fold(0.0, |size: f64, v| size.max(v.abs()));
        let mut rates = vec![f64::NAN; state.len()];
        if let Err(failure) = self.engine.field_mut().rhs(t, state, &mut rates) {
            return Err(self.failed(Reason::Rates { t }, Some(failure)));
        }
        let length = largest(&rates).max(1.0);
        let size = largest(state).max(t.abs()).max(self.engine.least_size());
        let step = f64::EPSILON.sqrt() * size / length * self.direction.unwrap_or(1.0);
        let moved: Vec<f64> = state.iter().zip(&rates).map(|(y, rate)| y + step * rate).collect();
        let next = self.evaluate(t + step, &moved)?[event];
        if next * sides.side(event) > 0.0 {
            return Ok(false);
        }
        if !matrix.is_empty() && self.events.events()[event].resets() {
            return Err(self.failed(Reason::Grazing { event: self.name(event), t }, None));
        }
        Ok(true)
    }

    /// The magnitude above which each function differs from zero after a reset. For a function whose
    /// event has occurred there and is near zero, |g| ≤ 10 Σᵢ |g(y + δᵢ) − g(y)| with the tolerances
    /// δᵢ = rtol |yᵢ| + atolᵢ of the state, the magnitude is 2 |g|. A function that has jumped
    /// there is on its other side, however close the state is to the jump.
    fn noise_after_reset(
        &mut self,
        t: f64,
        state: &[f64],
        values: &[f64],
        occurrences: &[Occurrence],
    ) -> Vec<f64> {
        let mut noise = self.noise.clone();
        let jumped = |event: &usize| self.due.contains(event) && self.noise[*event] == 0.0;
        let occurred = occurrences.iter().map(|occurrence| occurrence.event).filter(|event| !jumped(event));
        if occurred.clone().all(|event| values[event].abs() <= noise[event]) {
            return noise;
        }
        let mut moved = state.to_vec();
        let mut perturbation = vec![0.0; values.len()];
        let mut at = values.to_vec();
        let own = self.events.events().len();
        for i in 0..state.len() {
            moved[i] = state[i] + self.engine.tolerance(i, state[i]);
            // A state at which a function is undefined does not contribute.
            if self.events.evaluate(t, &moved, &mut at[..own]).is_ok() {
                let changes = perturbation.iter_mut().zip(at.iter().zip(values));
                changes.for_each(|(sum, (at, value))| *sum += (at - value).abs());
            }
            moved[i] = state[i];
        }
        for event in occurred {
            let value = values[event].abs();
            if value > noise[event] && value <= TOLERANCES * perturbation[event] {
                noise[event] = 2.0 * value;
            }
        }
        noise
    }

    /// Replaces y⁻ by the y⁺ of one event.
    pub(crate) fn reset(&mut self, event: usize, t: f64, state: &mut [f64]) -> Result<(), SolveError> {
        self.reset_alone(event, t, state)?;
        if !self.field().has_projection() {
            return Ok(());
        }
        let field = self.engine.field_mut();
        field.restart(t, state);
        match field.project(t, state) {
            Ok(()) => Ok(()),
            Err(failure) => Err(self.failed(Reason::Projection { t }, Some(failure))),
        }
    }

    /// The same, without the projection of the field.
    pub(crate) fn reset_alone(&mut self, event: usize, t: f64, state: &mut [f64]) -> Result<(), SolveError> {
        let mut result = self.events.reset(event, t, state);
        if let (Ok(()), Some(i)) = (&result, state.iter().position(|value| !value.is_finite())) {
            let component = self.field().component_name(i);
            let event = self.name(event);
            result = Err(Failure::fatal(NonFinite::Reset { event, component, value: state[i], t }));
        }
        if result.is_ok() {
            let allowed = check_inequalities(self.field(), state, &self.engine.limits().inequalities);
            result = allowed.map_err(Failure::fatal);
        }
        if let Err(failure) = result {
            let reason = Reason::Reset { event: self.name(event), t };
            return Err(self.failed(reason, Some(failure)));
        }
        Ok(())
    }
}

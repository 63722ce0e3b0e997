//! The effect of events on the state.

use std::ops::ControlFlow;

use pc_expr::{Events, Failure, VectorField};

use crate::error::{NonFinite, Reason, SolveError};
use crate::events::events::Occurrence;
use crate::integration::checks::check_inequalities;
use crate::integration::integration::{Ending, Integration};
use crate::integration::stepper::Stepper;

/// After a reset a function is near zero if it is at most this many times its change by the
/// tolerances of the state.
const TOLERANCES: f64 = 10.0;

impl<S: Stepper, E: Events> Integration<S, E> {
    /// Applies the events at the front and reports them to `occurred`. Returns how the integration
    /// ends, if it does: by the first terminal event, else because `occurred` stops it.
    pub(crate) fn occur(
        &mut self,
        occurred: &mut impl FnMut(&Occurrence) -> ControlFlow<()>,
    ) -> Result<Option<Ending>, SolveError> {
        let t = self.front.t;
        self.engine.stand_at(t);
        let mut state = self.front_state.clone();
        let mut occurrences = Vec::with_capacity(self.due.len());
        let mut matrix = self.sensitivities_before(t)?;
        for event in self.due.clone() {
            let state_before = state.clone();
            if self.events.events()[event].resets() {
                let mut after = state.clone();
                self.reset(event, t, &mut after)?;
                if !matrix.is_empty() {
                    matrix = self.jump_of_sensitivities(event, t, &state, &after, &matrix)?;
                    // Resets of nearby states may have changed data kept in the field.
                    after.copy_from_slice(&state);
                    self.reset(event, t, &mut after)?;
                }
                state = after;
            }
            let state_after = state.clone();
            occurrences.push(Occurrence { event, time: t, state_before, state_after });
        }
        if occurrences.iter().any(|occurrence| self.events.events()[occurrence.event].resets()) {
            let values = self.evaluate(t, &state)?;
            self.engine.restart(t, &state, &matrix, self.direction)?;
            (self.restarted, self.jumped) = (true, true);
            let noise = self.noise_after_reset(t, &state, &values);
            self.sides.jump(&values, noise);
            self.front.values = values;
            self.front_state = state;
        } else {
            self.sides.cross(&self.due, &self.front.values, &self.noise, &self.beyond);
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
            let accumulates = self.histories[event].note(t, self.engine.limits().accumulation);
            if let (Some(t), None) = (accumulates, ending) {
                let occurrences = self.histories[event].occurrences;
                let reason = Reason::Accumulation { event: self.name(event), occurrences, t };
                return Err(self.failed(reason, None));
            }
        }
        Ok(ending)
    }

    /// S⁻ at the front if a reset changes it; empty otherwise. An error for simultaneous resets,
    /// where S⁺ is not defined.
    fn sensitivities_before(&mut self, t: f64) -> Result<Vec<f64>, SolveError> {
        let resets = self.due.iter().filter(|&&event| self.events.events()[event].resets()).count();
        if resets == 0 || self.engine.column_parameters().is_empty() {
            return Ok(Vec::new());
        }
        if resets > 1 {
            let events = self.due.iter().map(|&event| self.name(event)).collect();
            return Err(self.failed(Reason::Together { events, t }, None));
        }
        self.engine.columns()
    }

    /// The magnitude above which each function differs from zero after a reset. For a function that
    /// caused it and is near zero, |g| ≤ 10 Σᵢ |g(y + δᵢ) − g(y)| with the tolerances
    /// δᵢ = rtol |yᵢ| + atolᵢ of the state, this is 2 |g|.
    fn noise_after_reset(&mut self, t: f64, state: &[f64], values: &[f64]) -> Vec<f64> {
        let mut noise = std::mem::take(&mut self.noise);
        if self.due.iter().all(|&event| values[event].abs() <= noise[event]) {
            return noise;
        }
        let mut moved = state.to_vec();
        let mut perturbation = vec![0.0; values.len()];
        let mut at = vec![0.0; values.len()];
        for i in 0..state.len() {
            moved[i] = state[i] + self.engine.tolerance(i, state[i]);
            // A state at which a function is undefined does not contribute.
            if self.events.evaluate(t, &moved, &mut at).is_ok() {
                let changes = perturbation.iter_mut().zip(at.iter().zip(values));
                changes.for_each(|(sum, (at, value))| *sum += (at - value).abs());
            }
            moved[i] = state[i];
        }
        for &event in &self.due {
            let value = values[event].abs();
            if value > noise[event] && value <= TOLERANCES * perturbation[event] {
                noise[event] = 2.0 * value;
            }
        }
        noise
    }

    /// Replaces y⁻ by y⁺ of one event.
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

    /// The same without the projection of the field.
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

//! Making checkpoints of an integration, and resuming from them.

use pc_expr::{Events, VectorField};

use crate::checkpoint::checkpoint::{Checkpoint, EventPast, Past};
use crate::error::{InputError, SolveError};
use crate::events::root_finding::Sides;
use crate::integration::integration::{Integration, directions};
use crate::integration::stepper::Stepper;

impl<S: Stepper, E: Events> Integration<S, E> {
    /// The current time, state, sensitivities and statistics of the integration, and the status of
    /// its events, for [`resume`](Integration::resume).
    ///
    /// Events that are due where an observer has stopped the integration are applied after the
    /// checkpoint.
    pub fn checkpoint(&self) -> Checkpoint {
        let at_front = self.time() == self.front.t;
        // Inside a step, `sides` belongs to the front, ahead of the checkpoint.
        let sides = if at_front { &self.sides } else { &self.sides_before };
        let known = sides.known().zip(&self.histories);
        let due = if at_front { self.due.as_slice() } else { &[] };
        let past = Past {
            events: known
                .map(|((side, noise), history)| EventPast { side, noise, history: history.clone() })
                .collect(),
            due: due
                .iter()
                .zip(&self.beyond)
                .filter(|&(&event, _)| event < self.histories.len())
                .map(|(&event, &side)| (event, self.noise[event], side))
                .collect(),
        };
        // Derivatives that are not available become NaN, which resuming refuses.
        let entries = self.field().dim() * self.engine.column_parameters().len();
        Checkpoint {
            statistics: self.statistics(),
            jumped: self.jumped,
            sensitivities: self.engine.columns().unwrap_or_else(|_| vec![f64::NAN; entries]),
            past: Some(past),
            ..Checkpoint::start(self.time(), self.state())
        }
    }
}

impl<S: Stepper> Integration<S> {
    /// Continues from a checkpoint with a method that has begun there.
    ///
    /// If the motion was [restarted](Integration::restart) before the checkpoint, so is [the
    /// field](VectorField::restart), which then conserves the values at the checkpoint.
    pub(crate) fn resumed(mut stepper: S, checkpoint: &Checkpoint) -> Self {
        if checkpoint.jumped {
            stepper.field_mut().restart(checkpoint.time, &checkpoint.state);
        }
        Integration { jumped: checkpoint.jumped, ..Integration::of(stepper) }
    }

    /// This integration, resumed at a checkpoint, with the events of the checkpoint.
    ///
    /// # Errors
    /// As for [`with_events`](Integration::with_events); [`InputError::EventCount`] if the
    /// checkpoint belongs to a motion with a different number of events.
    pub fn with_events_of<E: Events>(
        self,
        events: E,
        checkpoint: &Checkpoint,
    ) -> Result<Integration<S, E>, SolveError> {
        let mut integration = self.with_events(events)?;
        // As after a restart, the end may be too close for a step.
        integration.restarted = checkpoint.past.is_some();
        let Some(past) = &checkpoint.past else { return Ok(integration) };
        let (found, expected) = (past.events.len(), integration.histories.len());
        if found != expected {
            return Err(InputError::EventCount { expected, found }.into());
        }
        integration.histories = past.events.iter().map(|event| event.history.clone()).collect();
        let known = past.events.iter().map(|event| (event.side, event.noise));
        // Those of surfaces are found anew.
        let surfaces = std::iter::repeat_n((1.0, 0.0), integration.held.len());
        integration.sides =
            Sides::from_known(directions(&integration.events, &integration.held), known.chain(surfaces));
        if past.due.is_empty() {
            integration.sides.pass(&integration.front.values);
        } else {
            integration.noise = vec![0.0; expected + integration.held.len()];
            for &(event, noise, side) in &past.due {
                integration.due.push(event);
                integration.beyond.push(side);
                integration.noise[event] = noise;
            }
        }
        integration.sides_before = integration.sides.clone();
        Ok(integration)
    }
}

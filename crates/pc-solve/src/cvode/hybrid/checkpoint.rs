//! Where an integration with events can be taken up again.

use pc_expr::{Events, VectorField};

use crate::checkpoint::checkpoint::{Checkpoint, EventPast, Past};
use crate::cvode::cvode::Cvode;
use crate::cvode::hybrid::hybrid::{Hybrid, directions};
use crate::error::{InputError, SolveError};
use crate::events::root_finding::Sides;
use crate::integration::options::Options;
use crate::integration::statistics::Statistics;
use crate::sensitivity::options::Sensitivities;

impl<F: VectorField, E: Events> Hybrid<F, E> {
    /// Time, state and work where the integration stands, and what is known of its events, to be gone on from by
    /// [`resume`](Hybrid::resume).
    ///
    /// Events that are due where an observer has stopped it are dealt with after the checkpoint.
    pub fn checkpoint(&self) -> Checkpoint {
        let at_front = self.time() == self.front.t;
        // What the functions do between here and the front is not known here.
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
                .map(|(&event, &side)| (event, self.noise[event], side))
                .collect(),
        };
        let start = Checkpoint::start(self.time(), self.state());
        Checkpoint {
            statistics: self.statistics(),
            jumped: self.engine.jumped,
            sensitivities: self.engine.sensitivities_to_keep(),
            past: Some(past),
            ..start
        }
    }

    /// Begins anew at a checkpoint, which may be the start of a motion.
    ///
    /// Both the motion that was interrupted there and the one that was not go on from here with the same numbers, if
    /// `field`, `events` and `options` are the same; fields and events that
    /// remember earlier evaluations must be as they were when made. After a reset the field goes on to keep what it has in
    /// the state of the checkpoint, as in [`Cvode::resume`].
    ///
    /// # Errors
    /// As for [`Cvode::new`] and [`Cvode::with_events`]; [`InputError::EventCount`] if the checkpoint is of a motion with another
    /// number of events, and [`InputError::Sensitivities`] if it has sensitivities.
    pub fn resume(
        field: F,
        events: E,
        checkpoint: &Checkpoint,
        options: &Options,
    ) -> Result<Self, SolveError> {
        Hybrid::resume_with_sensitivities(field, events, checkpoint, options, &Sensitivities::new())
    }

    /// Begins anew at a checkpoint as [`resume`](Hybrid::resume) does, with the sensitivities that it has.
    ///
    /// # Errors
    /// As there, and as for [`Cvode::resume_with_sensitivities`].
    pub fn resume_with_sensitivities(
        field: F,
        events: E,
        checkpoint: &Checkpoint,
        options: &Options,
        sensitivities: &Sensitivities,
    ) -> Result<Self, SolveError> {
        let cvode = Cvode::resume_with_sensitivities(field, checkpoint, options, sensitivities)?;
        let mut hybrid = cvode.with_events(events)?;
        let Some(past) = &checkpoint.past else { return Ok(hybrid) };
        let (found, expected) = (past.events.len(), hybrid.histories.len());
        if found != expected {
            return Err(InputError::EventCount { expected, found }.into());
        }
        hybrid.histories = past.events.iter().map(|event| event.history.clone()).collect();
        let known = past.events.iter().map(|event| (event.side, event.noise));
        hybrid.sides = Sides::from_known(directions(&hybrid.events), known);
        if past.due.is_empty() {
            hybrid.sides.pass(&hybrid.front.values);
        } else {
            hybrid.noise = vec![0.0; expected];
            for &(event, noise, side) in &past.due {
                hybrid.due.push(event);
                hybrid.beyond.push(side);
                hybrid.noise[event] = noise;
            }
        }
        hybrid.sides_before = hybrid.sides.clone();
        // As after a restart, the end may be too near for a step.
        hybrid.engine.earlier = Statistics { current_time: checkpoint.time, ..Statistics::default() };
        hybrid.engine.restarted = true;
        Ok(hybrid)
    }
}

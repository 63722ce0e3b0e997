//! The events of a model, evaluated on the states that are integrated, for any form of the equations.

use std::sync::Arc;

use pc_expr::{Backend, Evaluator, Event, Events, Failure, Inputs, Program};
use pc_mech::{MechError, Motion, Signals};
use serde::{Deserialize, Serialize};

use crate::assembly::assembly::Assembly;
use crate::assembly::constraint_treatment::ConstraintFormulation;
use crate::diagnostics::error::ModelError;
use crate::flow::constrained_resets::ConstrainedResets;
use crate::flow::event_slopes::EventSlopes;
use crate::flow::impacts::Impacts;
use crate::flow::reading::{Reading, inputs};
use crate::model::model::Model;

/// The events of a model, compiled. Functions and resets are evaluated on (x, η) with all quasi-velocities.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct FlowEvents {
    events: Vec<Event>,
    reading: Reading,
    /// Inputs with tables.
    signals: Signals,
    functions: Evaluator,
    /// The reactions on which the functions depend.
    reactions: Option<Reactions>,
    resets: Vec<Reset>,
    /// The derivatives of functions and resets, if states are read and written by formulas.
    slopes: Option<EventSlopes>,
    /// The indices of inputs with tables.
    tables: Vec<usize>,
    /// The effect on resets of constraints enforced by multipliers.
    constraints: Option<ConstrainedResets>,
    /// The impacts among the events.
    impacts: Option<Impacts>,
    /// Storage for (x, η, z) with all η.
    room: Vec<f64>,
}

/// Components of (x, η, z) and their new values.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Reset {
    places: Vec<usize>,
    values: Evaluator,
}

/// Reactions of contacts, read from the observables of the motion.
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Reactions {
    motion: Motion,
    /// The index of each among the observables; `None` for the reaction of a constraint that was dropped.
    places: Vec<Option<usize>>,
    observed: Vec<f64>,
}

impl Reactions {
    /// Appends the reactions at a state of the motion to `room`.
    fn append(&mut self, t: f64, y: &[f64], room: &mut Vec<f64>) {
        self.motion.observe_to(t, y, &mut self.observed);
        room.extend(self.places.iter().map(|place| place.map_or(0.0, |place| self.observed[place])));
    }
}

#[derive(Debug, thiserror::Error)]
#[error("these events were not compiled with their derivatives")]
struct NoSlopes;

/// The error for sensitivities with respect to a function of time.
#[derive(Debug, thiserror::Error)]
#[error("there is no derivative by parameter {parameter} (from 0): it is an input with a table")]
struct OfTable {
    parameter: usize,
}

impl FlowEvents {
    /// The events of a model whose states are converted by `reading`; `watch` is the motion in all
    /// quasi-velocities if there are multipliers, and `motion` that of the form.
    ///
    /// # Errors
    /// [`ModelError`] if the events cannot be compiled.
    pub(super) fn new(
        model: &Model,
        assembly: &Assembly<'_>,
        reading: &Reading,
        (watch, motion): (&Motion, &Motion),
        slopes: Option<EventSlopes>,
    ) -> Result<FlowEvents, ModelError> {
        let system = &assembly.system;
        let of_state = inputs(system, &system.state());
        let compiled_in = |inputs: &Inputs<'_>, values: &[_]| {
            let program = Program::new(system.graph(), inputs, values);
            let program = assembly.placed(program.map_err(MechError::from))?;
            Ok(Evaluator::new(program, Backend::Interpreter))
        };
        let compiled = |values: &[_]| compiled_in(&of_state, values);
        let declared = &assembly.events;
        let functions: Vec<_> = declared.iter().map(|event| event.when).collect();
        let forces = assembly.forces_of_contacts();
        let places = forces.iter().map(|(name, _)| motion.observable_names().iter().position(|n| n == name));
        let reactions = assembly.has_events_on_reactions().then(|| Reactions {
            motion: motion.clone().without_kept(),
            places: places.collect(),
            observed: vec![f64::NAN; motion.observable_names().len()],
        });
        let symbols: Vec<_> =
            forces.iter().map(|&(_, symbol)| symbol).filter(|_| reactions.is_some()).collect();
        let with_reactions = inputs(system, &[system.state(), symbols].concat());
        let resets = declared.iter().map(|event| {
            let (places, values): (Vec<_>, Vec<_>) = event.resets.iter().copied().unzip();
            Ok(Reset { places, values: compiled(&values)? })
        });
        let constraints = match assembly.constraints.formulation() {
            ConstraintFormulation::Multipliers(held) if !declared.is_empty() => {
                Some(ConstrainedResets::new(watch, &held.multipliers, assembly.declared))
            }
            _ => None,
        };
        Ok(FlowEvents {
            events: declared.iter().map(event).collect(),
            reading: reading.clone(),
            signals: model.signals(),
            functions: compiled_in(&with_reactions, &functions)?,
            reactions,
            resets: resets.collect::<Result<_, ModelError>>()?,
            slopes,
            tables: model.parameter_values().tables().iter().map(|&(place, _)| place).collect(),
            constraints,
            impacts: Impacts::new(assembly)?,
            room: Vec::new(),
        })
    }

    /// Gives all parameters new values, in the order of declaration.
    ///
    /// # Panics
    /// Panics if the number of values is not that of the parameters.
    pub fn set_parameters(&mut self, parameters: &[f64]) {
        self.reading.set_parameters(parameters);
        if let Some(constraints) = &mut self.constraints {
            constraints.set_parameters(parameters);
        }
        if let Some(impacts) = &mut self.impacts {
            impacts.set_parameters(parameters);
        }
        if let Some(reactions) = &mut self.reactions {
            reactions.motion.parameters_mut()[..parameters.len()].copy_from_slice(parameters);
        }
    }

    /// Computes ∂g/∂pⱼ and, in `reset`, ∂R/∂pⱼ by central difference quotients, accurate to ten digits. This
    /// is used for momenta, and for velocities that constraints determine.
    fn quotient_by_parameter(
        &mut self,
        event: usize,
        j: usize,
        t: f64,
        y: &[f64],
        reset: &mut [f64],
    ) -> Result<f64, Failure> {
        let held = self.reading.parameters().to_vec();
        let size = Some(held[j].abs()).filter(|size| *size > 0.0).unwrap_or(1.0);
        let step = f64::EPSILON.cbrt() * size; // truncation and rounding errors are equal
        let mut at = |value: f64| {
            let mut moved = held.clone();
            moved[j] = value;
            self.set_parameters(&moved);
            let (mut values, mut after) = (vec![f64::NAN; self.events.len()], y.to_vec());
            self.evaluate(t, y, &mut values)?;
            if self.events[event].resets() {
                self.reset(event, t, &mut after)?;
            }
            Ok((values[event], after))
        };
        let ends = (at(held[j] + step), at(held[j] - step));
        self.set_parameters(&held);
        let ((ahead, after_ahead), (behind, after_behind)) = (ends.0?, ends.1?);
        let length = (held[j] + step) - (held[j] - step);
        for (slope, (ahead, behind)) in reset.iter_mut().zip(after_ahead.iter().zip(&after_behind)) {
            *slope = (ahead - behind) / length;
        }
        Ok((ahead - behind) / length)
    }

    /// Whether there are no events.
    pub fn is_empty(&self) -> bool {
        self.events.is_empty()
    }
}

fn event(event: &crate::assembly::event::Event<'_>) -> Event {
    let changes = event.changes_state();
    let settles = event.impact.is_some();
    let made = Event::new(&event.name).direction(event.direction).terminal(event.terminal);
    made.resetting(changes).settling(settles)
}

impl Events for FlowEvents {
    fn events(&self) -> &[Event] {
        &self.events
    }

    fn evaluate(&mut self, t: f64, y: &[f64], values: &mut [f64]) -> Result<(), Failure> {
        self.reading.read_in(t, y, &mut self.room).map_err(Failure::recoverable)?;
        self.signals.show(t, self.reading.parameters_mut()).map_err(Failure::fatal)?;
        if let Some(reactions) = &mut self.reactions {
            reactions.append(t, y, &mut self.room);
        }
        self.functions.eval(t, &self.room, self.reading.parameters(), values);
        Ok(())
    }

    /// The program of the functions, if states are read without conversion, and there are no tables and no reactions.
    fn program(&self) -> Option<(&Arc<Program>, &[f64])> {
        let plain = self.reading.is_plain() && self.signals.is_empty() && self.reactions.is_none();
        let plain = plain && !self.events.is_empty();
        plain.then(|| (self.functions.program(), self.reading.parameters()))
    }

    /// All new values are functions of the state before the event, or follow from an impulse.
    fn reset(&mut self, event: usize, t: f64, y: &mut [f64]) -> Result<(), Failure> {
        let mut all = self.reading.read(t, y).map_err(Failure::fatal)?;
        if let Some(impacts) = &mut self.impacts
            && impacts.strike(event, t, &mut all, self.reading.parameters())?
        {
            y.copy_from_slice(&self.reading.write(t, &all).map_err(Failure::fatal)?);
            return Ok(());
        }
        let before = all.clone();
        let Reset { places, values } = &mut self.resets[event];
        let mut new = vec![0.0; places.len()];
        self.signals.show(t, self.reading.parameters_mut()).map_err(Failure::fatal)?;
        values.eval(t, &all, self.reading.parameters(), &mut new);
        for (&place, value) in places.iter().zip(new) {
            all[place] = value;
        }
        if let Some(constraints) =
            self.constraints.as_mut().filter(|_| all.iter().all(|value| value.is_finite()))
        {
            constraints.settle(t, &before, places, &mut all)?;
        }
        y.copy_from_slice(&self.reading.write(t, &all).map_err(Failure::fatal)?);
        Ok(())
    }

    fn has_parameter_derivatives(&self) -> bool {
        true
    }

    fn by_parameter(
        &mut self,
        event: usize,
        parameter: usize,
        t: f64,
        y: &[f64],
        reset: &mut [f64],
    ) -> Result<f64, Failure> {
        reset.fill(0.0);
        if self.tables.contains(&parameter) {
            return Err(Failure::fatal(OfTable { parameter }));
        }
        // Events do not depend on external forces.
        if parameter >= self.reading.parameters().len() {
            return Ok(0.0);
        }
        self.signals.show(t, self.reading.parameters_mut()).map_err(Failure::fatal)?;
        match &mut self.slopes {
            Some(slopes) => {
                let slopes = slopes.at(event, t, y, self.reading.parameters());
                slopes.resets(|row| row.by_parameter(parameter)).for_each(|(i, slope)| reset[i] = slope);
                Ok(slopes.function().by_parameter(parameter))
            }
            None => self.quotient_by_parameter(event, parameter, t, y, reset),
        }
    }

    /// False if inputs have tables, since the rates of tables are not expressions.
    fn has_derivatives(&self) -> bool {
        self.slopes.is_some() && self.tables.is_empty()
    }

    fn gradient(&mut self, event: usize, t: f64, y: &[f64], by_state: &mut [f64]) -> Result<f64, Failure> {
        let slopes = self.slopes.as_mut().ok_or_else(|| Failure::fatal(NoSlopes))?;
        let slopes = slopes.at(event, t, y, self.reading.parameters());
        by_state.copy_from_slice(slopes.function().by_state());
        Ok(slopes.function().by_time())
    }

    fn reset_along(
        &mut self,
        event: usize,
        t: f64,
        y: &[f64],
        (in_time, v): (f64, &[f64]),
        change: &mut [f64],
    ) -> Result<(), Failure> {
        let slopes = self.slopes.as_mut().ok_or_else(|| Failure::fatal(NoSlopes))?;
        change.copy_from_slice(v);
        let slopes = slopes.at(event, t, y, self.reading.parameters());
        slopes.resets(|row| row.along(in_time, v)).for_each(|(i, slope)| change[i] = slope);
        Ok(())
    }
}

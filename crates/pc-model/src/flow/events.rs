//! The events of a model on the states that are integrated, whatever their form.

use pc_expr::{Backend, Evaluator, Event, Events, Failure, Program};
use pc_mech::{MechError, Motion, Signals, VectorField};

use crate::assembly::assembly::Assembly;
use crate::assembly::constraint_treatment::ConstraintFormulation;
use crate::diagnostics::error::ModelError;
use crate::flow::reading::{Reading, inputs};
use crate::model::model::Model;

/// A reset that misses a constraint on coordinates by more than this displacement, absolute or relative whichever is
/// larger, is no rounding.
const OFF: f64 = 1e-8;

/// The events of a model, compiled. Functions and resets see (x, η) with all quasi-velocities.
#[derive(Clone, Debug)]
pub struct FlowEvents {
    events: Vec<Event>,
    reading: Reading,
    /// Inputs with tables.
    signals: Signals,
    functions: Evaluator,
    resets: Vec<Reset>,
    /// The motion under constraints, which knows where they are satisfied.
    constraints: Option<Motion>,
    /// The quasi-velocities that determine the others, and keep the values that resets give them.
    determining: Vec<usize>,
}

/// Components of (x, η, z) and their new values.
#[derive(Clone, Debug)]
struct Reset {
    places: Vec<usize>,
    values: Evaluator,
}

/// A reset to where constraints do not allow the system to be.
#[derive(Debug, thiserror::Error)]
#[error("its reset leaves the constraints: {coordinate} would have to be {allowed}, not {given}")]
struct OffConstraints {
    coordinate: String,
    given: f64,
    allowed: f64,
}

impl FlowEvents {
    /// The events of a model whose states are read in this way; `watch` is the motion of all quasi-velocities where there
    /// are multipliers.
    ///
    /// # Errors
    /// [`ModelError`] if they cannot be compiled.
    pub(super) fn new(
        model: &Model,
        assembly: &Assembly<'_>,
        reading: &Reading,
        watch: &Motion,
    ) -> Result<FlowEvents, ModelError> {
        let system = &assembly.system;
        let inputs = inputs(system, &system.state());
        let compiled = |values: &[_]| {
            let program = Program::new(system.graph(), &inputs, values);
            let program = assembly.placed(program.map_err(MechError::from))?;
            Ok(Evaluator::new(program, Backend::Interpreter))
        };
        let declared = &assembly.events;
        let functions: Vec<_> = declared.iter().map(|event| event.when).collect();
        let resets = declared.iter().map(|event| {
            let (places, values): (Vec<_>, Vec<_>) = event.resets.iter().copied().unzip();
            Ok(Reset { places, values: compiled(&values)? })
        });
        let held = matches!(assembly.constraints.formulation(), ConstraintFormulation::Multipliers(_))
            && !declared.is_empty();
        // Those declared, where others complete them to a frame and follow from them.
        let bound =
            assembly.constraints.multipliers().map_or(0, |multipliers| multipliers.constraints().len());
        let follow = bound > 0 && assembly.declared + bound == system.quasi_velocities().len();
        Ok(FlowEvents {
            determining: if follow { (0..assembly.declared).collect() } else { Vec::new() },
            events: declared.iter().map(event).collect(),
            reading: reading.clone(),
            signals: model.signals(),
            functions: compiled(&functions)?,
            resets: resets.collect::<Result<_, ModelError>>()?,
            constraints: held.then(|| watch.clone().without_kept()),
        })
    }

    /// Gives all parameters other values, in the order of declaration.
    ///
    /// # Panics
    /// Unless there are as many values as parameters.
    pub fn set_parameters(&mut self, parameters: &[f64]) {
        self.reading.set_parameters(parameters);
        if let Some(motion) = &mut self.constraints {
            motion.parameters_mut()[..parameters.len()].copy_from_slice(parameters);
        }
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.events.is_empty()
    }
}

fn event(event: &crate::assembly::event::Event<'_>) -> Event {
    let resets = !event.resets.is_empty();
    Event::new(&event.name).direction(event.direction).terminal(event.terminal).resetting(resets)
}

impl Events for FlowEvents {
    fn events(&self) -> &[Event] {
        &self.events
    }

    fn evaluate(&mut self, t: f64, y: &[f64], values: &mut [f64]) -> Result<(), Failure> {
        let all = self.reading.read(t, y).map_err(Failure::recoverable)?;
        self.signals.show(t, self.reading.parameters_mut()).map_err(Failure::fatal)?;
        self.functions.eval(t, &all, self.reading.parameters(), values);
        Ok(())
    }

    /// The new values all come of the state before; velocities are then moved to where constraints allow them. Coordinates
    /// stay where they are unless the reset says otherwise: the state is at the event, and no rounding may take it back.
    fn reset(&mut self, event: usize, t: f64, y: &mut [f64]) -> Result<(), Failure> {
        let mut all = self.reading.read(t, y).map_err(Failure::fatal)?;
        let Reset { places, values } = &mut self.resets[event];
        let mut new = vec![0.0; places.len()];
        self.signals.show(t, self.reading.parameters_mut()).map_err(Failure::fatal)?;
        values.eval(t, &all, self.reading.parameters(), &mut new);
        for (&place, value) in places.iter().zip(new) {
            all[place] = value;
        }
        if let Some(motion) = self.constraints.as_mut().filter(|_| all.iter().all(|value| value.is_finite()))
        {
            if places.iter().all(|&place| place >= motion.coordinates()) {
                motion.project_velocities(t, &mut all)?;
                y.copy_from_slice(&self.reading.write(t, &all).map_err(Failure::fatal)?);
                return Ok(());
            }
            let given = all.clone();
            match self.determining.as_slice() {
                [] => motion.project(t, &mut all)?,
                determining => motion.project_holding(t, &mut all, &[], determining)?,
            }
            for i in 0..motion.coordinates() {
                let (given, allowed) = (given[i], all[i]);
                if (given - allowed).abs() > OFF * given.abs().max(1.0) {
                    let coordinate = motion.component_name(i);
                    return Err(Failure::fatal(OffConstraints { coordinate, given, allowed }));
                }
            }
        }
        y.copy_from_slice(&self.reading.write(t, &all).map_err(Failure::fatal)?);
        Ok(())
    }
}

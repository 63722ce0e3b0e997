//! The vector field that is integrated, what happens on its way, and what a table shows of its states.

use pc_expr::{Backend, Evaluator, Expr, Program};
use pc_mech::{LegendreTransform, MechError, Motion};

use crate::assembly::assembly::Assembly;
use crate::assembly::constraint_treatment::ConstraintFormulation;
use crate::diagnostics::error::ModelError;
use crate::flow::event_slopes::EventSlopes;
use crate::flow::events::FlowEvents;
use crate::flow::reading::{Reading, inputs};
use crate::flow::variables::Variables;
use crate::model::model::Model;

/// Equations of motion of a model, compiled and tried at the start, with what is read off their states.
#[derive(Clone, Debug)]
pub struct Flow {
    /// The vector field.
    pub motion: Motion,
    /// Its state at the start.
    pub start: Vec<f64>,
    /// Coordinates, declared quasi-velocities and first-order states, the columns of a table whatever the form.
    pub names: Vec<String>,
    /// What happens where; none in most models.
    pub events: FlowEvents,
    pub(super) reading: Reading,
}

impl Flow {
    /// The equations in these variables.
    ///
    /// # Errors
    /// [`ModelError`] if there are none, or nothing can be evaluated at the start.
    pub fn new(model: &Model, assembly: &Assembly<'_>, variables: Variables) -> Result<Flow, ModelError> {
        match variables {
            Variables::QuasiVelocities => {
                let compiled = model.compile(assembly)?;
                let all = assembly.system.quasi_velocities().iter().copied();
                let free: Vec<Expr<'_>> =
                    all.filter(|eta| compiled.0.names().contains(&eta.to_string())).collect();
                Flow::of(model, assembly, &free, compiled, None)
            }
            Variables::Momenta => {
                let mut transform = assembly.legendre_transform(variables)?;
                let system = match assembly.constraints.formulation() {
                    ConstraintFormulation::Multipliers(_) => assembly.system.clone(),
                    ConstraintFormulation::Free | ConstraintFormulation::Vanishing(_) => {
                        assembly.system_in(variables)?
                    }
                };
                let start = assembly.start_of(&system.state());
                let start = transform.to_momenta(assembly.t_start, &start);
                let start = start.map_err(|error| assembly.document.derivation_error(error))?;
                let motion = match assembly.constraints.formulation() {
                    ConstraintFormulation::Multipliers(held) => {
                        model.compile_in_momenta(&held.multipliers, assembly, &start)?
                    }
                    ConstraintFormulation::Free | ConstraintFormulation::Vanishing(_) => {
                        let canonical = assembly.canonical_in(variables)?;
                        model.compile_canonical(&canonical, assembly.t_start, &start)?
                    }
                };
                Flow::of(model, assembly, system.quasi_velocities(), (motion, start), Some(transform))
            }
        }
    }

    /// The flow of a motion whose state has, or whose momenta have, these free quasi-velocities.
    fn of<'g>(
        model: &Model,
        assembly: &Assembly<'g>,
        free: &[Expr<'g>],
        (motion, start): (Motion, Vec<f64>),
        transform: Option<LegendreTransform>,
    ) -> Result<Flow, ModelError> {
        let system = &assembly.system;
        let motion = assembly.placed(motion.within_chart(system))?;
        let x = system.frame().coordinates();
        let declared = &system.quasi_velocities()[..assembly.declared];
        let all = assembly.quasi_velocities_of(free)?;
        let eta = system.quasi_velocities();
        let free_places = free.iter().filter_map(|free| eta.iter().position(|eta| eta == free)).collect();
        let states: Vec<Expr<'g>> = system.states().iter().map(|&(z, _)| z).collect();
        let inputs = inputs(system, &[x, free, &states].concat());
        let program = Program::new(system.graph(), &inputs, &all).map_err(MechError::from);
        let program = assembly.placed(program)?;
        let reading = Reading {
            coordinates: x.len(),
            quasi_velocities: Evaluator::new(program, Backend::Interpreter),
            free: free_places,
            parameters: system.parameters().iter().map(|&(_, value)| value).collect(),
            transform,
            room: Vec::new(),
        };
        let explicit = reading.transform.is_none()
            && !matches!(assembly.constraints.formulation(), ConstraintFormulation::Multipliers(_));
        let slopes = (explicit && model.differentiates_by_parameters())
            .then(|| EventSlopes::new(model, assembly, free, &all))
            .transpose()?;
        Ok(Flow {
            events: FlowEvents::new(model, assembly, &reading, motion.in_quasi_velocities(), slopes)?,
            motion,
            start,
            names: x.iter().chain(declared).chain(&states).map(ToString::to_string).collect(),
            reading,
        })
    }

    /// The same equations in quasi-velocities with other values of the parameters, at another start.
    pub fn with_values(&self, parameters: &[f64], start: Vec<f64>) -> Flow {
        let mut motion = self.motion.clone();
        motion.parameters_mut()[..parameters.len()].copy_from_slice(parameters);
        let (mut events, mut reading) = (self.events.clone(), self.reading.clone());
        events.set_parameters(parameters);
        reading.set_parameters(parameters);
        Flow { motion, start, names: self.names.clone(), events, reading }
    }

    /// Coordinates, all quasi-velocities and first-order states of a state. Where momenta have no quasi-velocities, these are no numbers.
    fn shown(&mut self, t: f64, state: &[f64]) -> Vec<f64> {
        let n = self.motion.coordinates();
        self.reading.read(t, state).unwrap_or_else(|_| {
            let mut free = state.to_vec();
            let states = free.len() - self.motion.states();
            free[n..states].fill(f64::NAN);
            let mut all = Vec::new();
            self.reading.complete(t, &free, &mut all);
            all
        })
    }

    /// Coordinates, declared quasi-velocities and first-order states of a state, then the observables.
    pub fn row(&mut self, t: f64, state: &[f64]) -> Vec<f64> {
        let mut row = self.shown(t, state);
        row.extend(self.motion.observe(t, state));
        let declared = self.names.len() - self.motion.states();
        row.drain(
            declared..self.motion.coordinates() + self.reading.quasi_velocities.program().outputs_len(),
        );
        row
    }

    /// The state of coordinates and all quasi-velocities of the system, of which those that are not free are not looked at.
    ///
    /// # Errors
    /// [`MechError`] where the quasi-velocities have no momenta.
    pub fn state_of(&mut self, t: f64, all: &[f64]) -> Result<Vec<f64>, MechError> {
        self.reading.write(t, all)
    }

    /// The places, among all quasi-velocities of the system, of the free ones: those of the state, or of its momenta.
    pub fn free_quasi_velocities(&self) -> &[usize] {
        &self.reading.free
    }

    /// Whether the state has momenta.
    pub fn has_momenta(&self) -> bool {
        self.reading.transform.is_some()
    }

    /// Names of the constraints held by multipliers, and of those solved for velocities.
    pub fn constraint_names(&self) -> Vec<String> {
        self.motion.constraint_names().to_vec()
    }

    /// What should be zero of each of these.
    pub fn constraint_residuals(&mut self, t: f64, state: &[f64]) -> Vec<f64> {
        self.motion.constraint_residuals(t, state)
    }

    /// Number of quasi-velocities.
    pub fn quasi_velocities(&self) -> usize {
        self.names.len() - self.motion.coordinates() - self.motion.states()
    }
}

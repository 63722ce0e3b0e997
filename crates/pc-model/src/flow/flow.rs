//! The vector field to be integrated, its events, and the columns of a table of its states.

use pc_mech::{LegendreTransform, MechError, Motion};
use serde::{Deserialize, Serialize};

use crate::assembly::assembly::Assembly;
use crate::assembly::constraint_treatment::ConstraintFormulation;
use crate::diagnostics::error::ModelError;
use crate::flow::event_slopes::EventSlopes;
use crate::flow::events::FlowEvents;
use crate::flow::free_form::FreeForm;
use crate::flow::reading::Reading;
use crate::model::model::Model;
use crate::variables::Variables;

/// Equations of motion of a model, compiled and evaluated at the start, with the columns of a table.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Flow {
    /// The vector field.
    pub motion: Motion,
    /// Its state at the start.
    pub start: Vec<f64>,
    /// The names of the coordinates of the form, of the declared quasi-velocities (for any form), and of the
    /// first-order states.
    pub names: Vec<String>,
    /// The events; none in most models.
    pub events: FlowEvents,
    pub(super) reading: Reading,
}

impl Flow {
    /// The equations in these variables.
    ///
    /// # Errors
    /// [`ModelError`] if there are no such equations, if a function has [no value](Model::require_values), or if
    /// they cannot be evaluated at the start.
    pub fn new(model: &Model, assembly: &Assembly<'_>, variables: Variables) -> Result<Flow, ModelError> {
        model.require_values()?;
        Flow::with_stand_ins(model, assembly, variables)
    }

    /// The equations in these variables, with each undetermined function replaced by its
    /// [stand-in](pc_expr::StandIn): for comparisons that hold for every function.
    ///
    /// # Errors
    /// As for [`new`](Flow::new), but for functions without a value.
    pub fn with_stand_ins(
        model: &Model,
        assembly: &Assembly<'_>,
        variables: Variables,
    ) -> Result<Flow, ModelError> {
        let refused = |error| assembly.document.derivation_error(error);
        if matches!(variables, Variables::Momenta | Variables::ReducedMomenta) {
            let held = if assembly.system.is_held_at_rest() {
                Some("its joints are held at rest by stops or stiction")
            } else if assembly.rolls_by_friction() {
                Some("its bodies roll where dry friction suffices")
            } else {
                None
            };
            if let Some(held) = held {
                let message = format!("{held}, but this form has momenta");
                return Err(assembly.no_form(message, "use a form in velocities, such as poincare"));
            }
        }
        match (variables, assembly.constraints.held()) {
            (Variables::QuasiVelocities, Some(_)) => {
                let compiled = model.compile(assembly)?;
                Flow::of(model, assembly, &FreeForm::all(assembly), compiled, None)
            }
            (Variables::Momenta, Some(held)) => {
                let mut transform = assembly.legendre_transform(variables)?;
                let form = FreeForm::all(assembly);
                let start = assembly.start_of(&form.system.state());
                let start = transform.to_momenta(assembly.t_start, &start).map_err(refused)?;
                let motion = model.compile_in_momenta(held, assembly, &start)?;
                Flow::of(model, assembly, &form, (motion, start), Some(transform))
            }
            (_, Some(_)) => {
                let message =
                    "its constraints are held by multipliers, but this form needs independent velocities";
                let help = "choose these with --independent, or use the form poincare or canonical";
                Err(assembly.no_form(message.to_owned(), help))
            }
            (Variables::Momenta | Variables::ReducedMomenta, None) => {
                let form = assembly.free_form(variables)?;
                let mut transform = assembly.legendre_transform(variables)?;
                let start =
                    transform.to_momenta(assembly.t_start, &assembly.start_in(&form)?).map_err(refused)?;
                let canonical = assembly.canonical_in(variables)?;
                let motion = model.compile_canonical(&canonical, assembly.t_start, &start)?;
                Flow::of(model, assembly, &form, (motion, start), Some(transform))
            }
            (_, None) => {
                let (equations, form) = assembly.equations_of(variables)?;
                let start = assembly.start_in(&form)?;
                let compiled = model.compile_equations(&equations, assembly.t_start, start)?;
                Flow::of(model, assembly, &form, compiled, None)
            }
        }
    }

    /// The flow of a motion whose state contains the quasi-velocities of a form, or the momenta that belong
    /// to them.
    fn of<'g>(
        model: &Model,
        assembly: &Assembly<'g>,
        form: &FreeForm<'g>,
        (motion, start): (Motion, Vec<f64>),
        transform: Option<LegendreTransform>,
    ) -> Result<Flow, ModelError> {
        let (system, free) = (&assembly.system, form.independent.as_slice());
        let motion = assembly.within_chart(motion, form)?;
        let x = form.system.frame().coordinates();
        if x.len() < system.frame().coordinates().len() && !assembly.events.is_empty() {
            let message = "its events use all coordinates, but this form has fewer".to_owned();
            return Err(assembly.no_form(message, "use another form: poincare or canonical"));
        }
        let declared = &system.quasi_velocities()[..assembly.declared];
        let all = assembly.quasi_velocities_of(free)?;
        let reading = Reading::new(assembly, form, &all, transform, model.signals())?;
        let explicit = reading.transform.is_none() && form.matrix.is_none() && !assembly.has_multipliers();
        let is_plain = assembly.events.iter().all(|event| event.impact.is_none());
        let explicit = explicit && is_plain && !assembly.has_events_on_reactions();
        let slopes = (explicit && model.differentiates_by_parameters())
            .then(|| EventSlopes::new(model, assembly, free, &all))
            .transpose()?;
        // Eliminated multipliers still determine where a reset may lead.
        let watch = match assembly.constraints.formulation() {
            ConstraintFormulation::Multipliers(held)
                if assembly.constraints.held().is_none() && !assembly.events.is_empty() =>
            {
                Some(model.compile_multipliers(&held.multipliers, assembly)?.0)
            }
            _ => None,
        };
        let watch = watch.as_ref().unwrap_or_else(|| motion.in_quasi_velocities());
        Ok(Flow {
            events: FlowEvents::new(model, assembly, &reading, (watch, &motion), slopes)?,
            names: x
                .iter()
                .chain(declared)
                .copied()
                .chain(system.states().iter().map(|&(z, _)| z))
                .map(|name| name.to_string())
                .collect(),
            motion,
            start,
            reading,
        })
    }

    /// The same equations in quasi-velocities, with other values of the parameters and another start.
    pub fn with_values(&self, parameters: &[f64], start: Vec<f64>) -> Flow {
        let mut flow = Flow { start, ..self.clone() };
        flow.set_parameters(parameters);
        flow
    }

    /// Gives the first parameters these values, which the motion, the events and the rows then use.
    pub fn set_parameters(&mut self, parameters: &[f64]) {
        self.motion.parameters_mut()[..parameters.len()].copy_from_slice(parameters);
        self.events.set_parameters(parameters);
        self.reading.set_parameters(parameters);
    }

    /// The coordinates, all quasi-velocities and the first-order states of a state. Quasi-velocities that
    /// momenta do not determine are NaN.
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

    /// The names of the columns of each [row](Flow::row). They depend on the form: a reduced form has fewer
    /// coordinates.
    pub fn columns(&self) -> Vec<String> {
        self.names.iter().chain(self.motion.observable_names()).cloned().collect()
    }

    /// The coordinates, declared quasi-velocities and first-order states of a state, then the observables;
    /// [`columns`](Flow::columns) gives their names.
    pub fn row(&mut self, t: f64, state: &[f64]) -> Vec<f64> {
        let observed = self.motion.observe(t, state);
        self.row_with(observed, t, state)
    }

    /// The same row, but with the observables [of one side](Motion::observe_beside) where the motion slides along a
    /// surface.
    pub fn row_beside(&mut self, t: f64, state: &[f64]) -> Vec<f64> {
        let observed = self.motion.observe_beside(t, state);
        self.row_with(observed, t, state)
    }

    fn row_with(&mut self, observed: Vec<f64>, t: f64, state: &[f64]) -> Vec<f64> {
        let mut row = self.shown(t, state);
        row.extend(observed);
        let declared = self.names.len() - self.motion.states();
        row.drain(
            declared..self.motion.coordinates() + self.reading.quasi_velocities.program().outputs_len(),
        );
        row
    }

    /// The rates of all quasi-velocities of the system when the state changes at these `rates`; `None` if the
    /// state itself contains quasi-velocities of the system, since their rates are then in `rates`.
    pub fn rates_of_quasi_velocities(&mut self, t: f64, state: &[f64], rates: &[f64]) -> Option<Vec<f64>> {
        self.reading.rates(t, state, rates)
    }

    /// The state for given coordinates, all quasi-velocities of the system and first-order states;
    /// quasi-velocities that are not free are ignored.
    ///
    /// # Errors
    /// [`MechError`] if the quasi-velocities have no momenta.
    pub fn state_of(&mut self, t: f64, all: &[f64]) -> Result<Vec<f64>, MechError> {
        self.reading.write(t, all)
    }

    /// The indices, among all quasi-velocities of the system, of the free ones: those in the state, or those to
    /// which its momenta belong.
    pub fn free_quasi_velocities(&self) -> &[usize] {
        &self.reading.free
    }

    /// Whether the quasi-velocities of the state, or those to which its momenta belong, are quasi-velocities
    /// of the system.
    pub fn has_own_variables(&self) -> bool {
        !self.reading.is_changed()
    }

    /// Whether the state has momenta.
    pub fn has_momenta(&self) -> bool {
        self.reading.transform.is_some()
    }

    /// The names of the constraints enforced by multipliers, and of those solved for velocities.
    pub fn constraint_names(&self) -> Vec<String> {
        self.motion.constraint_names().to_vec()
    }

    /// The residual of each of these constraints.
    pub fn constraint_residuals(&mut self, t: f64, state: &[f64]) -> Vec<f64> {
        self.motion.constraint_residuals(t, state)
    }

    /// Number of quasi-velocities.
    pub fn quasi_velocities(&self) -> usize {
        self.names.len() - self.motion.coordinates() - self.motion.states()
    }
}

//! The mechanical system of a model, its constraints and its start.

use std::sync::Arc;

use pc_expr::SymbolPlaces;
use pc_mech::{Equations, Expr, System};
use pc_nonholo::{NonholoError, Redundant};

use crate::assembly::action::Action;
use crate::assembly::constraint_treatment::{ConstraintFormulation, ConstraintTreatment};
use crate::assembly::event::Event;
use crate::diagnostics::error::ModelError;
use crate::diagnostics::meaning::MeaningError;
use crate::document::{Contact, Document};
use crate::names::scope::Scope;

/// The system of a model, with the state from which its motion starts.
pub struct Assembly<'g> {
    /// The system, without its constraints. The quasi-velocities of the system are the declared ones and
    /// those defined by constraints.
    pub system: System<'g>,
    /// Its constraints.
    pub constraints: ConstraintTreatment<'g>,
    /// Start time.
    pub t_start: f64,
    /// The start state: coordinates, quasi-velocities, first-order states.
    pub start: Vec<f64>,
    /// The start state as written, if it was moved onto the constraints.
    pub written_start: Option<Vec<f64>>,
    /// The number of declared quasi-velocities, which come first, or the number of velocities if none is
    /// declared.
    pub declared: usize,
    /// The events, in the order in which simultaneous events are handled.
    pub events: Vec<Event<'g>>,
    /// The definitions of the text, with ẋ = b η + b_0 substituted, except definitions that have different
    /// meanings in different places.
    pub definitions: Vec<(String, Expr<'g>)>,
    /// The quasi-velocities given in addition to those of the text, as linear forms in those of the system.
    pub given: Vec<(Expr<'g>, Expr<'g>)>,
    /// The solution of Hamilton–Jacobi's equation in the text, if there is one.
    pub action: Option<Action<'g>>,
    /// The bodies whose masses change with time or first-order states: they obey D_t (m v) = F, so that the
    /// mass that they lose or take up is at rest.
    pub changing_masses: Vec<String>,
    /// The text of the model, in which errors are located.
    pub(crate) document: Arc<Document>,
}

impl<'g> Assembly<'g> {
    /// Values of time, coordinates and quasi-velocities at the start.
    pub fn at_start(&self) -> Vec<(Expr<'g>, f64)> {
        let frame = self.system.frame();
        let state = self.system.state().into_iter();
        state.zip(self.start.iter().copied()).chain([(frame.time(), self.t_start)]).collect()
    }

    /// The forces of contacts: the names of the outputs that contain them, with the symbols λ of the reactions.
    pub fn forces_of_contacts(&self) -> Vec<(String, Expr<'g>)> {
        let forces = self.document.contacts.iter().flat_map(Contact::reactions);
        let graph = self.system.graph();
        forces.map(|(force, constraint)| (force, graph.symbol(&format!("λ_{constraint}")))).collect()
    }

    /// The constraints that were dropped, except those on the slip of a body that has no motion in that direction.
    pub fn dropped_constraints(&self) -> impl Iterator<Item = &Redundant> {
        let contacts = self.document.contacts.iter();
        let slips: Vec<String> = contacts
            .flat_map(|contact| contact.reactions().into_iter().skip(1))
            .map(|(_, label)| label)
            .collect();
        let is_plain = move |dropped: &&Redundant| {
            !(dropped.follows_from.is_empty() && slips.contains(&dropped.constraint))
        };
        self.constraints.redundant().iter().filter(is_plain)
    }

    /// Whether dry friction holds a body at a contact, so that it rolls.
    pub fn rolls_by_friction(&self) -> bool {
        self.document.contacts.iter().any(Contact::sticks)
    }

    /// Whether an event depends on the force of a contact.
    pub fn has_events_on_reactions(&self) -> bool {
        let forces = self.forces_of_contacts();
        self.events.iter().any(|event| forces.iter().any(|&(_, force)| event.when.depends_on(force)))
    }

    /// The names of the functions without a value, which stand for any smooth functions.
    pub fn undetermined_functions(&self) -> Vec<String> {
        self.document.undetermined_functions().map(|function| function.name.text.clone()).collect()
    }

    /// The result of a derivation from this system; an error is located at the entry of the file that causes it.
    ///
    /// # Errors
    /// [`ModelError`], made from the error of the derivation.
    pub fn placed<T>(&self, derived: Result<T, impl Into<NonholoError>>) -> Result<T, ModelError> {
        derived.map_err(|error| self.document.constraint_error(error.into()))
    }

    /// Checks that everything derived from this system so far is complete.
    ///
    /// # Errors
    /// [`ErrorKind::Spent`](crate::ErrorKind::Spent) if the [limits](crate::Model::limit) were reached.
    pub fn within_limits(&self) -> Result<(), ModelError> {
        self.document.stage(self.system.graph(), "what was asked for", || Ok(()))
    }

    /// Runs `work` on this system. If the [limits](crate::Model::limit) are reached before or during `work`,
    /// the result is an error that names this stage, whatever `work` returns.
    ///
    /// # Errors
    /// [`ErrorKind::Spent`](crate::ErrorKind::Spent), and the errors of `work`.
    pub fn stage<T, E: From<ModelError>>(
        &self,
        name: &'static str,
        work: impl FnOnce() -> Result<T, E>,
    ) -> Result<T, E> {
        self.document
            .stage(self.system.graph(), name, || Ok(work()))
            .unwrap_or_else(|error| Err(error.into()))
    }

    /// The error for something that could not be derived from this system, located at the energy if no other
    /// entry causes it.
    pub fn not_derived(&self, message: String) -> ModelError {
        self.document.error(&self.document.energy_place(), MeaningError::Derivation { message })
    }

    /// The equations of motion in independent quasi-velocities.
    ///
    /// # Errors
    /// [`ModelError`] if the equations cannot be derived.
    pub fn equations(&self) -> Result<Equations<'g>, ModelError> {
        let equations = || self.placed(self.constraints.equations(&self.system, &self.at_start()));
        self.document.stage(self.system.graph(), "the equations of motion", equations)
    }

    /// The conditions f(t, x) = 0 enforced by multipliers, each with the name of its constraint.
    pub fn held_positions(&self) -> Vec<(String, Expr<'g>)> {
        let ConstraintFormulation::Multipliers(held) = self.constraints.formulation() else {
            return Vec::new();
        };
        let positions = held.multipliers.constraints().iter().filter(|c| c.is_holonomic(&self.system));
        positions.map(|c| (c.name().to_owned(), c.expression())).collect()
    }

    /// The system of the independent quasi-velocities whose equations (9) are the equations of motion.
    ///
    /// # Errors
    /// [`ModelError`] if the system cannot be derived.
    pub fn free_system(&self) -> Result<System<'g>, ModelError> {
        self.placed(self.constraints.free_system(&self.system, &self.at_start()))
    }

    /// Each quasi-velocity of the system as a function of time, coordinates and the `free` quasi-velocities,
    /// which are either those of a [free system](Assembly::free_system) or all.
    ///
    /// # Errors
    /// [`ModelError`] if the `free` quasi-velocities do not determine the others.
    pub fn quasi_velocities_of(&self, free: &[Expr<'g>]) -> Result<Vec<Expr<'g>>, ModelError> {
        self.placed(self.constraints.quasi_velocities_of(self.system.quasi_velocities(), free))
    }

    /// Whether it is proved that the motion conserves its energy (that of all velocities if multipliers
    /// enforce constraints, otherwise that of the free ones): dH/dt = X_0 H + c_0r^m η_r y_m + Q_s η_s
    /// vanishes where the constraints hold, and the constraints are homogeneous in the velocities, so that
    /// their reactions do no work.
    pub fn keeps_energy(&self) -> bool {
        let (system, graph) = (&self.system, self.system.graph());
        match self.constraints.formulation() {
            ConstraintFormulation::Multipliers(held) => {
                let mut constraints = held.multipliers.constraints().iter();
                system.energy_rate().is_zero() && constraints.all(|c| c.is_workless(system))
            }
            ConstraintFormulation::Free => system.energy_rate().is_zero(),
            ConstraintFormulation::Vanishing(constrained) => {
                let zeros: Vec<_> = constrained.vanishing().iter().map(|&eta| (eta, Expr::ZERO)).collect();
                graph.substitute(&[system.energy_rate()], &zeros)[0].is_zero()
            }
        }
    }

    /// The symbols x' with their values b η + b_0.
    pub(crate) fn velocities_of_coordinates(&self) -> Vec<(Expr<'g>, Expr<'g>)> {
        let (system, graph) = (&self.system, self.system.graph());
        let velocities = system.frame().velocities(system.quasi_velocities());
        Scope::new(graph, &self.document).velocities().into_iter().zip(velocities).collect()
    }

    /// The quasi-velocities of the system at the start.
    pub fn start_velocities(&self) -> Vec<f64> {
        self.start_of(self.system.quasi_velocities())
    }

    /// The start state of a motion whose state consists of these components: coordinates and some of the
    /// quasi-velocities.
    pub fn start_of(&self, components: &[Expr<'g>]) -> Vec<f64> {
        let at = self.at_start();
        let known = SymbolPlaces::of(&at.iter().map(|&(symbol, _)| symbol).collect::<Vec<_>>());
        components.iter().map(|&x| known.get(x).map_or(f64::NAN, |place| at[place].1)).collect()
    }
}

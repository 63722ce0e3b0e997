//! The dry friction of contacts, whose normal forces are functions of the state.

use pc_expr::Direction;
use pc_mech::{ConstraintFriction, Expr, FrictionForces, System};
use pc_nonholo::ConstraintClassification;

use crate::assembly::assembler::Assembler;
use crate::assembly::constraints::Written;
use crate::assembly::event::Event;
use crate::diagnostics::error::ModelError;
use crate::diagnostics::meaning::MeaningError;
use crate::document::{Contact, Expression};
use crate::names::stage::Stage;

impl<'g> Assembler<'g, '_> {
    /// The system with the friction of contacts among its forces, and with these forces in its outputs, and the events at which
    /// contacts jam; `at` are the values of all symbols at the start.
    pub(super) fn with_friction_of_contacts(
        &mut self,
        system: System<'g>,
        written: &[Written<'g>],
        x_dot: &[(Expr<'g>, Expr<'g>)],
        at: &[(Expr<'g>, f64)],
    ) -> Result<(System<'g>, Vec<Event<'g>>), ModelError> {
        let document = self.model.document();
        if document.contacts.iter().all(|contact| contact.friction.is_none()) {
            return Ok((system, Vec::new()));
        }
        let constraints = self.in_quasi_velocities(written, x_dot);
        let classification = ConstraintClassification::new(&system, &constraints, at);
        let classification = classification.map_err(|error| document.constraint_error(error))?;
        let binding = classification.multipliers();
        let (mut frictions, mut symbols) = (Vec::new(), Vec::new());
        for (number, contact) in document.contacts.iter().enumerate() {
            let Some(friction) = &contact.friction else { continue };
            let names = binding.iter().flat_map(|held| held.constraints());
            let Some(constraint) = names.into_iter().position(|c| c.name() == contact.name.text) else {
                let message = format!(
                    "the normal force of `{}`, to which its friction is proportional, is not determined",
                    contact.name.text
                );
                let help = "leave the height of the body a coordinate, and give a body one contact";
                return Err(document.error(&contact.name.place, MeaningError::OfJoint { message, help }));
            };
            let coefficient = self.scope.resolve(&friction.coefficient, Stage::Joint)?;
            let creep = friction.creep.as_ref().map(|creep| self.scope.resolve(creep, Stage::Joint));
            let creep = creep.transpose()?;
            self.check_friction(contact, (coefficient, creep), at)?;
            let both = self.graph.substitute(&self.scope.slips(number)?, x_dot);
            let both = self.graph.shorten(&both, &self.scope.coordinates());
            // A body that moves in a plane has one velocity of slip.
            let moves = |&(_, slip): &(String, Expr<'g>)| self.graph.generic_rank(&[vec![slip]]) > 0;
            let (slipping, still): (Vec<_>, Vec<_>) =
                contact.friction_forces().into_iter().zip(both).partition(moves);
            if slipping.is_empty() {
                let message =
                    format!("the body of `{}` cannot slip, and friction does nothing", contact.name.text);
                let place = friction.coefficient.whole();
                let help = "leave `friction` out";
                return Err(document.error(&place, MeaningError::OfJoint { message, help }));
            }
            symbols.push(slipping.iter().map(|(name, _)| self.graph.symbol(name)).collect::<Vec<_>>());
            symbols.push(still.iter().map(|(name, _)| self.graph.symbol(name)).collect());
            let slips = slipping.into_iter().map(|(_, slip)| slip).collect();
            frictions.push(ConstraintFriction { constraint, coefficient, slips, creep });
        }
        let Some(binding) = binding else { return Ok((system, Vec::new())) };
        let found = binding.friction_forces(&frictions);
        let FrictionForces { forces, margins, without } =
            found.map_err(|error| document.constraint_error(error.into()))?;
        let jams = self.jams(&margins, &without, at)?;
        let on_velocities = binding.friction_on_quasi_velocities(&frictions, &forces);
        let values = forces.into_iter().flat_map(|forces| [forces, vec![Expr::ZERO; 2]]);
        let known: Vec<(Expr<'g>, Expr<'g>)> = symbols
            .into_iter()
            .zip(values)
            .flat_map(|(symbols, values)| symbols.into_iter().zip(values))
            .collect();
        let system = system.with_observed(&known).with_added_forces(&on_velocities);
        Ok((system.map_err(|error| document.derivation_error(error))?, jams))
    }

    /// The events at which contacts jam, checked at the start.
    fn jams(
        &self,
        margins: &[Expr<'g>],
        without: &[Expr<'g>],
        at: &[(Expr<'g>, f64)],
    ) -> Result<Vec<Event<'g>>, ModelError> {
        let document = self.model.document();
        let value = |of: Expr<'g>| self.graph.evaluate(&[of], at).ok().and_then(|list| list.first().copied());
        let mut jams = Vec::new();
        let contacts = document.contacts.iter().filter(|contact| contact.friction.is_some());
        for (contact, (&when, &normal_force)) in contacts.zip(margins.iter().zip(without)) {
            let name = &contact.name.text;
            let refused = |message: String, help| {
                Err(document.error(&contact.name.place, MeaningError::OfJoint { message, help }))
            };
            if value(when).is_some_and(|margin| margin <= 0.0) {
                let message = format!(
                    "with this friction the normal force of `{name}` has no value (Painlevé's paradox)"
                );
                return refused(message, "give a smaller coefficient of friction, or another start");
            }
            if let Some(force) = value(normal_force).filter(|force| *force < 0.0) {
                let message = format!(
                    "the ground would have to pull at the start: `{name}` has the normal force {force}"
                );
                return refused(message, "start with a body that presses on the ground");
            }
            if self.graph.symbols_of(&[when]).is_empty() {
                continue;
            }
            let event = format!("{name}_jams");
            if let Some(other) = document.events.iter().find(|known| known.name.text == event) {
                let message = format!("`{event}` is the event at which the contact `{name}` jams");
                let help = "give this event another name";
                return Err(document.error(&other.place, MeaningError::OfJoint { message, help }));
            }
            jams.push(Event {
                name: event,
                when,
                direction: Direction::Falling,
                terminal: true,
                resets: Vec::new(),
                impact: None,
            });
        }
        Ok(jams)
    }

    /// Checks the coefficient of friction and the velocity of creep at the start.
    fn check_friction(
        &self,
        contact: &Contact,
        (coefficient, creep): (Expr<'g>, Option<Expr<'g>>),
        at: &[(Expr<'g>, f64)],
    ) -> Result<(), ModelError> {
        let Some(friction) = &contact.friction else { return Ok(()) };
        let value = |of: Expr<'g>| self.graph.evaluate(&[of], at).ok().and_then(|list| list.first().copied());
        let refused = |entry: &Expression, message: String, help: &'static str| {
            Err(self.model.document().error(&entry.whole(), MeaningError::OfJoint { message, help }))
        };
        if let Some(value) = value(coefficient).filter(|value| *value < 0.0) {
            let message = format!("a coefficient of friction is not negative, as {value} is");
            return refused(&friction.coefficient, message, "0.1 to 1 are usual");
        }
        if let (Some(entry), Some(value)) = (&friction.creep, creep.and_then(value))
            && value <= 0.0
        {
            let message = format!("a velocity of creep is positive, and not {value}");
            let help = "choose it far below the velocities of interest";
            return refused(entry, message, help);
        }
        Ok(())
    }
}

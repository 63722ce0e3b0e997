//! The dry friction of contacts, whose normal forces are functions of the state.

use pc_mech::{ConstraintFriction, Expr, System};
use pc_nonholo::ConstraintClassification;

use crate::assembly::assembler::Assembler;
use crate::assembly::constraints::Written;
use crate::diagnostics::error::ModelError;
use crate::diagnostics::meaning::MeaningError;
use crate::document::{Contact, Expression};
use crate::names::stage::Stage;

impl<'g> Assembler<'g, '_> {
    /// The system with the friction of contacts among its forces, and with these forces in its outputs; `at` are the values
    /// of all symbols at the start.
    pub(super) fn with_friction_of_contacts(
        &mut self,
        system: System<'g>,
        written: &[Written<'g>],
        x_dot: &[(Expr<'g>, Expr<'g>)],
        at: &[(Expr<'g>, f64)],
    ) -> Result<System<'g>, ModelError> {
        let document = self.model.document();
        if document.contacts.iter().all(|contact| contact.friction.is_none()) {
            return Ok(system);
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
            symbols.push(slipping.iter().map(|(name, _)| self.graph.symbol(name)).collect::<Vec<_>>());
            symbols.push(still.iter().map(|(name, _)| self.graph.symbol(name)).collect());
            let slips = slipping.into_iter().map(|(_, slip)| slip).collect();
            frictions.push(ConstraintFriction { constraint, coefficient, slips, creep });
        }
        let Some(binding) = binding else { return Ok(system) };
        let forces = binding.friction_forces(&frictions);
        let forces = forces.map_err(|error| document.constraint_error(error.into()))?;
        let on_velocities = binding.friction_on_quasi_velocities(&frictions, &forces);
        let values = forces.into_iter().flat_map(|forces| [forces, vec![Expr::ZERO; 2]]);
        let known: Vec<(Expr<'g>, Expr<'g>)> = symbols
            .into_iter()
            .zip(values)
            .flat_map(|(symbols, values)| symbols.into_iter().zip(values))
            .collect();
        let system = system.with_observed(&known).with_added_forces(&on_velocities);
        system.map_err(|error| document.derivation_error(error))
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

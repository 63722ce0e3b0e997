//! The section `[events.NAME]`.

use pc_expr::{Direction, Expr};

use crate::assembly::assembler::Assembler;
use crate::assembly::constraint_treatment::ConstraintTreatment;
use crate::assembly::event::Event;
use crate::diagnostics::error::ModelError;
use crate::diagnostics::meaning::MeaningError;
use crate::document;
use crate::document::NamedExpression;
use crate::names::scope::entry;
use crate::names::stage::Stage;

impl<'g> Assembler<'g, '_> {
    /// The functions whose zeros are the events, with ẋ = b η + b_0 substituted, in the order of the file.
    pub(super) fn crossings(&mut self, x_dot: &[(Expr<'g>, Expr<'g>)]) -> Result<Vec<Expr<'g>>, ModelError> {
        let events = &self.model.document().events;
        events.iter().map(|event| self.at_event(&event.when, x_dot)).collect()
    }

    /// The events whose functions are `crossings`, with their resets; the new values need not be defined
    /// before the event. First-order states begin at component `first_state` of the state.
    pub(super) fn events(
        &mut self,
        crossings: Vec<Expr<'g>>,
        x_dot: &[(Expr<'g>, Expr<'g>)],
        constraints: &ConstraintTreatment<'g>,
        first_state: usize,
    ) -> Result<Vec<Event<'g>>, ModelError> {
        let mut events = Vec::with_capacity(crossings.len());
        for (event, when) in self.model.document().events.iter().zip(crossings) {
            let mut resets = Vec::with_capacity(event.reset.len());
            for reset in &event.reset {
                let place = self.reset_place(reset, constraints, first_state)?;
                let value = self.at_event(&reset.expression, x_dot)?;
                self.check_without_reactions(&reset.expression, value)?;
                resets.push((place, value));
            }
            events.push(Event {
                name: event.name.text.clone(),
                when,
                direction: event.direction.as_ref().map_or(Direction::Both, |direction| direction.value),
                terminal: event.terminal.as_ref().is_some_and(|terminal| terminal.value),
                resets,
                impact: None,
            });
        }
        Ok(events)
    }

    fn at_event(
        &mut self,
        expression: &document::Expression,
        x_dot: &[(Expr<'g>, Expr<'g>)],
    ) -> Result<Expr<'g>, ModelError> {
        let value = self.scope.resolve(expression, Stage::Event)?;
        Ok(self.graph.substitute(&[value], x_dot)[0])
    }

    /// Checks that a new value does not depend on the forces of contacts, which jump where the state does.
    fn check_without_reactions(
        &self,
        text: &document::Expression,
        value: Expr<'g>,
    ) -> Result<(), ModelError> {
        let contacts = &self.model.document().contacts;
        let mut forces = contacts.iter().flat_map(document::Contact::reactions);
        let on = forces.find(|(_, label)| value.depends_on(self.graph.symbol(&format!("λ_{label}"))));
        let Some((name, _)) = on else { return Ok(()) };
        let (place, allowed) = ("the reset of an event", "declared names other than forces");
        Err(self.scope.error(text, text.ast.span, |_| MeaningError::NotHere { name, place, allowed }))
    }

    /// The component of (x, η, z) to which a reset gives a new value.
    fn reset_place(
        &self,
        reset: &NamedExpression,
        constraints: &ConstraintTreatment<'g>,
        first_state: usize,
    ) -> Result<usize, ModelError> {
        let document = self.model.document();
        let name = reset.name.text.as_str();
        let n = document.coordinates.len();
        let place_of = |name: &str| document.coordinates.iter().position(|x| x.name.text == name);
        let refuse = |fault| Err(self.model.document().error(&reset.name.place, fault));
        let declared = document.quasi_velocities.iter().position(|eta| eta.name.text == name);
        if let Some(coordinate) = name.strip_suffix('\'').filter(|_| declared.is_none()) {
            let Some(place) = place_of(coordinate) else {
                let mut name = reset.name.clone();
                name.text = coordinate.to_owned();
                return Err(self.not_a_coordinate(&name));
            };
            let vanishes = vanishes(constraints, self.graph.symbol(name));
            return match self.is_lagrangian_form() {
                true if vanishes => {
                    refuse(self.not_reset(name, "a velocity that a constraint keeps at zero", constraints))
                }
                true => Ok(n + place),
                false => refuse(self.not_reset(name, "a velocity that quasi-velocities give", constraints)),
            };
        }
        if let Some(place) = place_of(name) {
            return Ok(place);
        }
        if let Some(place) = declared {
            return match vanishes(constraints, self.graph.symbol(name)) {
                true => refuse(self.not_reset(
                    name,
                    "a quasi-velocity that a constraint keeps at zero",
                    constraints,
                )),
                false => Ok(n + place),
            };
        }
        if let Some(place) = document.states.iter().position(|state| state.name.text == name) {
            return Ok(first_state + place);
        }
        let what = match () {
            () if name == "t" => "time",
            () if document.parameters.iter().any(|parameter| parameter.name.text == name) => "a parameter",
            () if document.inputs.iter().any(|input| input.name.text == name) => "an input",
            () if entry(&document.definitions, name).is_some() => "a definition",
            () if entry(&document.integrals, name).is_some() => "an integral",
            () if entry(&document.outputs, name).is_some() => "an output",
            () => "declared nowhere",
        };
        refuse(self.not_reset(name, what, constraints))
    }

    fn not_reset(
        &self,
        name: &str,
        what: &'static str,
        constraints: &ConstraintTreatment<'g>,
    ) -> MeaningError {
        let document = self.model.document();
        let coordinates = document.coordinates.iter().map(|x| x.name.text.clone());
        let states = document.states.iter().map(|state| state.name.text.clone());
        let moving = |name: &String| !vanishes(constraints, self.graph.symbol(name));
        let velocities: Vec<String> = match self.is_lagrangian_form() {
            true => document.coordinates.iter().map(|x| format!("{}'", x.name.text)).filter(moving).collect(),
            false => {
                let moving = |name: &&String| moving(name);
                document.quasi_velocities.iter().map(|eta| &eta.name.text).filter(moving).cloned().collect()
            }
        };
        MeaningError::NotReset {
            name: name.to_owned(),
            what,
            known: coordinates.chain(velocities).chain(states).collect(),
        }
    }
}

/// Whether a constraint only says that this quasi-velocity vanishes.
fn vanishes<'g>(constraints: &ConstraintTreatment<'g>, eta: Expr<'g>) -> bool {
    let constraints = constraints.multipliers().map_or(&[][..], |multipliers| multipliers.constraints());
    constraints.iter().any(|constraint| constraint.expression() == eta)
}

//! Conditions that involve several sections: each name has one meaning, something moves, and there is an
//! energy.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use crate::diagnostics::error::ModelError;
use crate::diagnostics::error_kind::{ErrorKind, Role};
use crate::diagnostics::meaning::MeaningError;
use crate::document::contents::{Body, Document, Orientation};
use crate::document::expression::{Located, Name, NamedExpression};

/// Checks that the energy is given by `[lagrangian]` or `[bodies]`.
pub(super) fn require_energy(document: &Document) -> Result<(), ModelError> {
    if !document.bodies.is_empty() || !document.tree.is_empty() {
        return Ok(());
    }
    match &document.lagrangian {
        None => Err(document.source.error(&document.end(), ErrorKind::NoLagrangian)),
        Some(given) if given.kinetic.is_none() && given.lagrangian.is_none() => {
            let example = "kinetic = \"…\"";
            Err(document.source.error(&given.place, ErrorKind::Missing { key: "kinetic", example }))
        }
        Some(_) => Ok(()),
    }
}

/// Checks that gravity acts on something.
pub(super) fn require_bodies(document: &Document) -> Result<(), ModelError> {
    match &document.gravity {
        Some(gravity) if document.bodies.is_empty() && document.tree.is_empty() => {
            let (key, example) = ("[gravity]".to_owned(), "[bodies.NAME]");
            let kind = ErrorKind::NoEffect { key, without: "bodies", example };
            Err(document.source.error(&gravity.place, kind))
        }
        _ => Ok(()),
    }
}

/// Checks that something moves: a coordinate, or a quasi-velocity.
pub(super) fn require_motion(document: &Document) -> Result<(), ModelError> {
    if document.coordinates.is_empty() && document.quasi_velocities.is_empty() {
        return Err(document.source.error(&document.end(), ErrorKind::NothingMoves));
    }
    Ok(())
}

/// Checks that absolute tolerances are given only for components of the state.
pub(super) fn check_tolerances(document: &Document) -> Result<(), ModelError> {
    let Some(given) = &document.simulation.atol else { return Ok(()) };
    let known = document.start_names();
    match given.value.each.iter().find(|(name, _)| !known.contains(name)) {
        Some((name, _)) => {
            let kind = MeaningError::UnknownComponent { name: name.clone(), known };
            Err(document.error(&given.place, kind))
        }
        None => Ok(()),
    }
}

impl Document {
    /// The names that have a start value: coordinates, quasi-velocities (or velocities x' if none is declared), and
    /// first-order states.
    pub(crate) fn start_names(&self) -> Vec<String> {
        let coordinates = self.coordinates.iter().map(|x| x.name.text.clone());
        let quasi_velocities = self.quasi_velocities.iter().map(|eta| eta.name.text.clone());
        let mut names: Vec<String> = coordinates.chain(quasi_velocities).collect();
        if self.quasi_velocities.is_empty() {
            names.extend(self.coordinates.iter().map(|x| format!("{}'", x.name.text)));
        }
        names.extend(self.states.iter().map(|state| state.name.text.clone()));
        names
    }

    /// The names in the single namespace of the model, each with its role.
    pub(crate) fn declared_names(&self) -> Vec<(&Name, Role)> {
        let quasi = self.quasi_velocities.iter().map(|quasi| (&quasi.name, Role::QuasiVelocity));
        let inputs = self.inputs.iter().map(|input| (&input.name, Role::Input));
        let states = self.states.iter().map(|state| (&state.name, Role::State));
        let functions = self.functions.iter().map(|function| (&function.name, Role::Function));
        let action = self.hamilton_jacobi.iter().flat_map(|action| &action.constants);
        let constants = action.map(|(name, _)| (name, Role::Constant));
        let points = self.points.iter().flat_map(|point| &point.components).map(|name| (name, Role::Point));
        // Coordinates of points of contact are among the coordinates.
        let contacts = self.contacts.iter().flat_map(|contact| {
            contact.components.iter().filter(|name| contact.component(&name.text).is_some())
        });
        let contacts = contacts.map(|name| (name, Role::Contact));
        let mut names: Vec<(&Name, Role)> = quasi
            .chain(states)
            .chain(functions)
            .chain(inputs)
            .chain(constants)
            .chain(points)
            .chain(contacts)
            .collect();
        for (entries, role) in [
            (&self.parameters, Role::Parameter),
            (&self.definitions, Role::Definition),
            (&self.coordinates, Role::Coordinate),
            (&self.integrals, Role::Integral),
        ] {
            names.extend(entries.iter().map(|entry| (&entry.name, role)));
        }
        // The coordinate of a joint that follows another is a definition and an output.
        let is_defined =
            |output: &&NamedExpression| self.definitions.iter().any(|known| known.name == output.name);
        let outputs = self.outputs.iter().filter(|output| !is_defined(output));
        names.extend(outputs.map(|output| (&output.name, Role::Output)));
        names.extend(self.simulation.hamel.iter().map(|given| (&given.name, Role::QuasiVelocity)));
        names
    }
}

/// What a drawing hides has to be there.
pub(super) fn check_hidden(document: &Document) -> Result<(), ModelError> {
    let bodies = document.bodies.iter().map(|body| &body.name);
    let on_joints = document.tree.iter().map(|body| &body.name);
    let points = document.points.iter().map(|point| &point.name);
    let known: Vec<String> = bodies.chain(on_joints).chain(points).map(|name| name.text.clone()).collect();
    match document.drawing.hide.iter().find(|hidden| !known.contains(&hidden.value)) {
        None => Ok(()),
        Some(stray) => {
            let kind = ErrorKind::NothingToHide { name: stray.value.clone(), known };
            Err(document.source.error(&stray.place, kind))
        }
    }
}

/// A body in whose axes something is drawn has to be there.
pub(super) fn check_carriers(document: &Document) -> Result<(), ModelError> {
    let bodies = document.bodies.iter().map(|body| &body.name);
    let known: Vec<String> =
        bodies.chain(document.tree.iter().map(|body| &body.name)).map(|name| name.text.clone()).collect();
    let is_turned = |body: &Body| matches!(body.orientation, Some(Orientation::AngularVelocity(_)));
    for Located { value: name, place } in document.draw.iter().filter_map(|draw| draw.body.as_ref()) {
        if !known.contains(name) {
            return Err(document.source.error(place, ErrorKind::NoSuchBody { name: name.clone(), known }));
        }
        if document.bodies.iter().any(|body| body.name.text == *name && is_turned(body)) {
            return Err(document.source.error(place, ErrorKind::NoAxes { body: name.clone() }));
        }
    }
    Ok(())
}

/// Checks that a name has only one meaning.
pub(super) fn check_names(document: &Document) -> Result<(), ModelError> {
    let mut names = document.declared_names();
    names.sort_by_key(|(name, _)| name.place.span.start);
    let mut seen = HashMap::new();
    for (name, role) in names {
        match seen.entry(name.text.as_str()) {
            Entry::Vacant(vacant) => {
                vacant.insert((name, role));
            }
            Entry::Occupied(occupied) => {
                let (first, role) = *occupied.get();
                let line = document.source.position(first.place.span.start).line;
                let kind = ErrorKind::NameTaken { name: name.text.clone(), first: role, line };
                return Err(document.source.error(&name.place, kind));
            }
        }
    }
    Ok(())
}

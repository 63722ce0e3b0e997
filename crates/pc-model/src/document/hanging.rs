//! The coordinates and quasi-velocities that joints add to those of the model, and checks of the tree of
//! bodies.

use std::collections::{HashMap, HashSet};

use pc_expr::parse::{AstKind, Declared};

use crate::diagnostics::error::ModelError;
use crate::diagnostics::error_kind::{ErrorKind, Role};
use crate::diagnostics::meaning::MeaningError;
use crate::document::contents::{Constraint, Document, QuasiVelocity};
use crate::document::expression::{Expression, Located, Name, NamedExpression};
use crate::document::following;
use crate::document::joints::{TreeBody, WORLD, prime};
use crate::document::loops::Loop;

/// Adds what joints and loops declare to the document.
///
/// # Errors
/// If a body is attached to one that does not exist, or the motion of a joint is also given elsewhere.
pub(super) fn declare(
    document: &mut Document,
    loops: Vec<Loop>,
    functions: &[Declared],
) -> Result<(), ModelError> {
    check_parents(document)?;
    following::declare(document, functions)?;
    check_masses(document)?;
    close(document, loops)?;
    for point in &document.points {
        check_body(document, &point.body)?;
    }
    let tree = std::mem::take(&mut document.tree);
    let declared = if tree.is_empty() { Ok(()) } else { declare_motions(document, &tree) };
    document.tree = tree;
    declared
}

/// Checks that a body belongs to the tree, or is the world.
fn check_body(document: &Document, body: &Located<String>) -> Result<(), ModelError> {
    if body.value == WORLD || document.tree.iter().any(|known| known.name.text == body.value) {
        return Ok(());
    }
    let known = document.tree.iter().map(|body| body.name.text.clone()).collect();
    let kind = ErrorKind::NotInTree { name: body.value.clone(), known };
    Err(document.source.error(&body.place, kind))
}

/// Checks that each body is attached to an existing body, and that every body is ultimately attached to the
/// world.
fn check_parents(document: &Document) -> Result<(), ModelError> {
    for parent in document.tree.iter().filter_map(|body| body.parent.as_ref()) {
        check_body(document, parent)?;
    }
    let bodies: HashMap<&str, &TreeBody> =
        document.tree.iter().map(|body| (body.name.text.as_str(), body)).collect();
    let mut on_world: HashSet<&str> = HashSet::new();
    for body in &document.tree {
        let mut below: Vec<&str> = Vec::new();
        let mut next = Some(body.name.text.as_str());
        while let Some(name) = next.filter(|name| !on_world.contains(name)) {
            if let Some(first) = below.iter().position(|known| *known == name) {
                let bodies: Vec<String> = below[first..].iter().map(|name| (*name).to_owned()).collect();
                let place = document.tree.iter().find(|body| body.name.text == name);
                let place = place.and_then(|body| body.parent.as_ref()).map(|parent| &parent.place);
                let kind = ErrorKind::CircularParents { bodies };
                return Err(document.source.error(place.unwrap_or(&body.place), kind));
            }
            below.push(name);
            next = bodies.get(name).and_then(|body| body.parent());
        }
        on_world.extend(below);
    }
    Ok(())
}

/// Checks that each moving body, or one that moves with it, has mass, unless `[lagrangian]` adds energy. The bodies
/// attached to a body move with it, and so do those whose joints follow its joint.
fn check_masses(document: &Document) -> Result<(), ModelError> {
    if document.lagrangian.as_ref().is_some_and(|own| own.kinetic.is_some() || own.lagrangian.is_some()) {
        return Ok(());
    }
    let is_zero = |mass: &Expression| matches!(mass.ast.kind, AstKind::Number(0.0));
    let has_mass =
        |body: &&TreeBody| body.inertia.is_some() || body.mass.as_ref().is_some_and(|mass| !is_zero(mass));
    let place = |name: &str| document.tree.iter().position(|body| body.name.text == name);
    let mut carries = vec![false; document.tree.len()];
    for body in document.tree.iter().filter(has_mass) {
        let mut open: Vec<usize> = place(&body.name.text).into_iter().collect();
        while let Some(body) = open.pop() {
            if !std::mem::replace(&mut carries[body], true) {
                let body = &document.tree[body];
                let followed = body.joint.follows.as_ref().map(|following| following.body.value.as_str());
                open.extend([body.parent(), followed].into_iter().flatten().filter_map(place));
            }
        }
    }
    let moves = |body: &TreeBody| !body.joint.coordinates.is_empty();
    match document.tree.iter().zip(carries).find(|(body, carries)| moves(body) && !carries) {
        None => Ok(()),
        Some((body, _)) => {
            let fault = MeaningError::Massless { body: body.name.text.clone() };
            Err(document.source.error(&body.name.place, fault))
        }
    }
}

/// Adds the points and constraints of loops to the document.
fn close(document: &mut Document, loops: Vec<Loop>) -> Result<(), ModelError> {
    for Loop { name, points, constraints } in loops {
        document.points.extend(points);
        for (number, expression) in (1..).zip(constraints) {
            let label = format!("{}_{number}", name.text);
            if let Some(taken) = document.constraints.iter().find(|known| known.name.text == label) {
                let line = document.source.position(taken.name.place.span.start).line;
                let kind = ErrorKind::NameTaken { name: label, first: Role::Constraint, line };
                return Err(document.source.error(&name.place, kind));
            }
            let name = Name { text: label, place: name.place.clone() };
            document.constraints.push(Constraint { name, expression, kind: None });
        }
    }
    Ok(())
}

/// The body, if any, whose joint has this coordinate.
fn of_joint<'d>(tree: &'d [TreeBody], coordinate: &str) -> Option<&'d TreeBody> {
    tree.iter().find(|body| body.joint.coordinates.iter().any(|x| x.text == coordinate))
}

fn declare_motions(document: &mut Document, tree: &[TreeBody]) -> Result<(), ModelError> {
    let said_elsewhere = |document: &Document, name: &Name, body: &TreeBody| {
        let kind = ErrorKind::OfJoint { name: name.text.clone(), body: body.name.text.clone() };
        document.source.error(&name.place, kind)
    };
    for entry in &document.kinematics {
        if let Some(body) = of_joint(tree, &entry.name.text) {
            return Err(said_elsewhere(document, &entry.name, body));
        }
    }
    let mut coordinates = Vec::new();
    for body in tree {
        let scalar = body.joint.kind.quaternion();
        for (i, name) in body.joint.coordinates.iter().enumerate() {
            let given = document.coordinates.iter().position(|x| x.name.text == name.text);
            coordinates.push(match given {
                Some(place) => document.coordinates.remove(place),
                None => {
                    let start = if Some(i) == scalar { "1" } else { "0" };
                    let expression = Expression::following(&document.source, start.to_owned(), &name.place)?;
                    NamedExpression { name: name.clone(), expression }
                }
            });
        }
    }
    let of_joints = coordinates.len();
    coordinates.append(&mut document.coordinates);
    document.coordinates = coordinates;

    let mut quasi_velocities = Vec::new();
    for body in tree {
        for name in &body.joint.quasi_velocities {
            let given = document.quasi_velocities.iter().position(|eta| eta.name.text == name.text);
            let given = given.map(|place| document.quasi_velocities.remove(place));
            if let Some(given) = given.as_ref().filter(|given| given.is.is_some()) {
                return Err(said_elsewhere(document, &given.name, body));
            }
            let name = given.as_ref().map_or(name, |given| &given.name).clone();
            quasi_velocities.push(QuasiVelocity {
                name,
                is: None,
                start: given.and_then(|given| given.start),
            });
        }
    }
    let own = &document.quasi_velocities;
    let is_plain = tree.iter().all(|body| body.joint.is_plain());
    if is_plain && own.is_empty() && document.kinematics.is_empty() {
        return Ok(()); // all velocities are x'
    }
    match own.iter().find(|eta| eta.is.is_some()) {
        Some(defined) => {
            if let Some(body) = tree.iter().find(|body| !body.joint.kind.is_of_velocities()) {
                let kind = ErrorKind::DefinedBesideTurning { body: body.name.text.clone() };
                return Err(document.source.error(&defined.name.place, kind));
            }
            for (eta, x) in quasi_velocities.iter_mut().zip(&document.coordinates) {
                eta.is = Some(Expression::following(&document.source, prime(&x.name.text), &eta.name.place)?);
            }
        }
        None if own.is_empty() && document.kinematics.is_empty() => {
            for x in &document.coordinates[of_joints..] {
                let name = Name { text: prime(&x.name.text), place: x.name.place.clone() };
                quasi_velocities.push(QuasiVelocity { name, is: None, start: None });
            }
        }
        None => {}
    }
    // The start velocity of a coordinate is the start value of the quasi-velocity that equals it.
    for eta in &mut quasi_velocities {
        let given = document.start_velocities.iter().position(|x| prime(&x.name.text) == eta.name.text);
        if let Some(place) = given {
            eta.start = Some(document.start_velocities.remove(place).expression);
        }
    }
    quasi_velocities.append(&mut document.quasi_velocities);
    document.quasi_velocities = quasi_velocities;
    Ok(())
}

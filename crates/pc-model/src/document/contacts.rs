//! The section of contacts, and the coordinates, constraints and events that they declare.

use pc_expr::Direction;

use super::reader::{Item, Table};
use crate::diagnostics::error::ModelError;
use crate::diagnostics::error_kind::{ErrorKind, Role};
use crate::diagnostics::source::Place;
use crate::document::contact::{Contact, ContactFriction, ContactShape};
use crate::document::contents::{Constraint, Document, Event, Orientation, QuasiVelocity};
use crate::document::expression::{Expression, Located, Name, NamedExpression};
use crate::document::following::mentions;
use crate::document::joints::prime;
use crate::document::tree::direction;

const KEYS: &[&str] = &[
    "body",
    "shape",
    "radius",
    "axis",
    "semi_axes",
    "at",
    "attitude",
    "motion",
    "friction",
    "creep",
    "normal",
    "through",
    "height",
    "keeps",
];
const RADIUS: &str = "radius = \"r\"";
const SEMI_AXES: &str = "semi_axes = [\"a\", \"b\", \"c\"]";
const AXIS: &str = "axis = [0, 0, 1]";
const AT: &str = "at = [0, 0, 0]";
const NORMAL: &str = "normal = [0, 0, 1]";
const FRICTION: &str = "friction = \"mu\"";
const ATTITUDE: &str = "attitude = [1, 0, 0, 0, 1, 0, 0, 0, 1]";

/// The shapes.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    Disc,
    Sphere,
    Ellipsoid,
}

/// `[contacts.NAME]`
pub(super) fn contacts(table: &Table<'_>) -> Result<Vec<Contact>, ModelError> {
    table.items().map(|item| contact(&item)).collect()
}

fn contact(item: &Item<'_>) -> Result<Contact, ModelError> {
    let name = item.new_name()?;
    let table = item.section(&format!("contacts.{}", name.text), "[contacts.NAME]")?;
    let (mut body, mut kind, mut motion) = (None, None, None);
    let (mut radius, mut axis, mut semi_axes) = (None, None, None);
    let (mut at, mut attitude, mut keeps) = (None, None, None);
    let (mut normal, mut through, mut height) = (None, None, None);
    let (mut friction, mut creep) = (None, None);
    for part in table.items() {
        match part.key() {
            "body" => body = Some(part.text()?),
            "shape" => {
                let kinds = [("disc", Kind::Disc), ("sphere", Kind::Sphere), ("ellipsoid", Kind::Ellipsoid)];
                kind = Some(part.choice(&kinds)?.value);
            }
            "radius" => radius = Some((part.clone(), part.expression()?)),
            "axis" => axis = Some((part.clone(), direction(&part, AXIS)?)),
            "semi_axes" => semi_axes = Some((part.clone(), part.array("3 expressions", SEMI_AXES)?)),
            "at" => at = Some(part.array("3 expressions", AT)?),
            "attitude" => attitude = Some(part.located(Box::new(part.array("9 expressions", ATTITUDE)?))),
            "motion" => motion = Some(part.choice(&[("rolls", true), ("slides", false)])?.value),
            "friction" => friction = Some((part.clone(), part.expression()?)),
            "creep" => creep = Some(part.expression()?),
            "normal" => normal = Some(part.array("3 expressions", NORMAL)?),
            "through" => through = Some(part.array("3 expressions", "through = [0, 0, 0]")?),
            "height" => height = Some((part.clone(), part.expression()?)),
            "keeps" => keeps = Some(part.boolean()?.value),
            _ => return Err(part.unknown(KEYS)),
        }
    }
    let missing = |key, example| table.error(ErrorKind::Missing { key, example });
    let kind = kind.ok_or_else(|| missing("shape", "shape = \"sphere\""))?;
    let stray = |part: Option<&Item<'_>>, example| match part {
        Some(part) => Err(part.key_error(ErrorKind::OfOtherShapes { key: part.key().to_owned(), example })),
        None => Ok(()),
    };
    if kind == Kind::Ellipsoid {
        stray(radius.as_ref().map(|(part, _)| part), SEMI_AXES)?;
    } else {
        stray(semi_axes.as_ref().map(|(part, _)| part), RADIUS)?;
    }
    if kind != Kind::Disc {
        stray(axis.as_ref().map(|(part, _)| part), "shape = \"disc\"")?;
    }
    let radius = radius.map(|(_, radius)| radius).ok_or_else(|| missing("radius", RADIUS));
    let shape = match kind {
        Kind::Disc => {
            let (_, axis) = axis.ok_or_else(|| missing("axis", AXIS))?;
            ContactShape::Disc { radius: radius?, axis }
        }
        Kind::Sphere => ContactShape::Sphere { radius: radius? },
        Kind::Ellipsoid => {
            let (_, semi_axes) = semi_axes.ok_or_else(|| missing("semi_axes", SEMI_AXES))?;
            ContactShape::Ellipsoid { semi_axes: Box::new(semi_axes) }
        }
    };
    if let (Some((part, _)), true) = (&height, normal.is_some() || through.is_some()) {
        return Err(part.key_error(ErrorKind::Exclusive {
            first: "height",
            second: if normal.is_some() { "normal" } else { "through" },
            help: "write `normal` and `through` for a plane, and `height` for uneven ground",
        }));
    }
    let height = height.map(|(_, height)| height);
    if let (Some((part, _)), Some(true)) = (&friction, motion) {
        return Err(part.key_error(ErrorKind::OfSliding { key: "friction", because: "motion = \"rolls\"" }));
    }
    if let (Some((part, _)), Some(true)) = (&friction, keeps) {
        return Err(part.key_error(ErrorKind::OfSliding { key: "friction", because: "keeps = true" }));
    }
    if creep.is_some() && friction.is_none() {
        return Err(missing("friction", FRICTION));
    }
    let friction = friction.map(|(_, coefficient)| ContactFriction { coefficient, creep });
    let changes = |axis: &usize| {
        let coordinate = format!("{}_{}", name.text, ["x", "y"][*axis]);
        height.as_ref().is_some_and(|height| mentions(&height.ast, &coordinate))
    };
    let along: Vec<usize> = [0, 1].into_iter().filter(changes).collect();
    let component = |end| item.derived_name(format!("{}_{end}", name.text));
    Ok(Contact {
        body: body.ok_or_else(|| missing("body", "body = \"…\""))?,
        rolls: motion.ok_or_else(|| missing("motion", "motion = \"rolls\""))?,
        components: Contact::ends(&along).map(component).collect::<Result<_, _>>()?,
        keeps: keeps.unwrap_or(false),
        name,
        shape,
        at,
        attitude,
        friction,
        normal,
        through,
        height,
        along,
        found: Vec::new(),
    })
}

/// Adds the coordinates of points of contact with uneven ground, with their velocities where `[kinematics]` gives those of the
/// other coordinates.
pub(super) fn declare_coordinates(document: &mut Document) -> Result<(), ModelError> {
    let mut contacts = std::mem::take(&mut document.contacts);
    for contact in &mut contacts {
        let known = |name: &Name, list: &[NamedExpression]| list.iter().any(|x| x.name.text == name.text);
        let is_given = |axis: &usize| {
            contact.components.get(*axis).is_none_or(|name| known(name, &document.coordinates))
        };
        contact.found = contact.along.iter().copied().filter(|axis| !is_given(axis)).collect();
        for name in contact.coordinates() {
            if !known(name, &document.coordinates) {
                let expression = Expression::following(&document.source, "0".to_owned(), &name.place)?;
                document.coordinates.push(NamedExpression { name: name.clone(), expression });
            }
            if !document.kinematics.is_empty() && !known(name, &document.kinematics) {
                let name = Name { text: prime(&name.text), place: name.place.clone() };
                document.quasi_velocities.push(QuasiVelocity { name, is: None, start: None });
            }
        }
    }
    document.contacts = contacts;
    Ok(())
}

/// Adds the constraints, the outputs and the events of contacts to the document.
pub(super) fn declare(document: &mut Document) -> Result<(), ModelError> {
    for contact in &document.contacts {
        check_body(document, contact)?;
    }
    for contact in document.contacts.clone() {
        let place = &contact.name.place;
        let following =
            |document: &Document, text: String| Expression::following(&document.source, text, place);
        for component in &contact.components[Contact::COMMON..] {
            check_label(document, &component.text, place)?;
            let expression = following(document, component.text.clone())?;
            document.constraints.push(Constraint { name: component.clone(), expression, kind: None });
        }
        let ends = Contact::GAP..Contact::GAP + if contact.rolls { 3 } else { 1 };
        for (component, (force, label)) in ends.zip(contact.reactions()) {
            check_label(document, &label, place)?;
            let expression = following(document, contact.components[component].text.clone())?;
            let reaction = following(document, format!("λ_{label}"))?;
            let named = |text: String| Name { text, place: place.clone() };
            document.outputs.push(NamedExpression { name: named(force), expression: reaction });
            document.constraints.push(Constraint { name: named(label), expression, kind: None });
        }
        for force in contact.friction_forces() {
            let expression = following(document, force.clone())?;
            let name = Name { text: force, place: place.clone() };
            document.outputs.push(NamedExpression { name, expression });
        }
        if !contact.keeps {
            document.events.push(Event {
                name: Name { text: format!("{}_lift_off", contact.name.text), place: place.clone() },
                place: place.clone(),
                when: following(document, format!("N_{}", contact.name.text))?,
                direction: Some(Located { value: Direction::Falling, place: place.clone() }),
                terminal: Some(Located { value: true, place: place.clone() }),
                reset: Vec::new(),
            });
        }
    }
    Ok(())
}

/// Checks that no constraint has this name.
fn check_label(document: &Document, label: &str, place: &Place) -> Result<(), ModelError> {
    let Some(taken) = document.constraints.iter().find(|known| known.name.text == label) else {
        return Ok(());
    };
    let line = document.source.position(taken.name.place.span.start).line;
    let kind = ErrorKind::NameTaken { name: label.to_owned(), first: Role::Constraint, line };
    Err(document.source.error(place, kind))
}

/// Checks that the body of a contact exists, and that its attitude is known.
fn check_body(document: &Document, contact: &Contact) -> Result<(), ModelError> {
    let Contact { body, attitude, .. } = contact;
    let refuse = |place, kind: ErrorKind| Err(document.source.error(place, kind));
    let placed = document.bodies.iter().find(|known| known.name.text == body.value);
    match (placed.map(|placed| &placed.orientation), attitude) {
        (Some(Some(Orientation::AngularVelocity(_))), Some(_)) => Ok(()),
        (Some(Some(Orientation::AngularVelocity(_))), None) => {
            refuse(&contact.name.place, ErrorKind::Missing { key: "attitude", example: ATTITUDE })
        }
        (_, Some(attitude)) => {
            let (key, example) = ("attitude".to_owned(), "angular_velocity = [\"w1\", \"w2\", \"w3\"]");
            refuse(&attitude.place, ErrorKind::NoEffect { key, without: "angular_velocity", example })
        }
        (Some(Some(Orientation::Rotation(_))), None) => Ok(()),
        (Some(None), None) => refuse(&body.place, ErrorKind::Pointlike { body: body.value.clone() }),
        (None, None) if document.tree.iter().any(|known| known.name.text == body.value) => Ok(()),
        (None, None) => {
            let placed = document.bodies.iter().map(|body| body.name.text.clone());
            let known = placed.chain(document.tree.iter().map(|body| body.name.text.clone())).collect();
            refuse(&body.place, ErrorKind::NoSuchBody { name: body.value.clone(), known })
        }
    }
}

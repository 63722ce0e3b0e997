//! The sections of rigid bodies and mass points, and of gravity.

use super::reader::{Item, Table};
use crate::diagnostics::error::ModelError;
use crate::diagnostics::error_kind::ErrorKind;
use crate::document::contents::{Body, Gravity, Orientation};
use crate::document::inertia::Inertia;

const KEYS: &[&str] = &["mass", "position", "inertia", "rotation", "angular_velocity", "force", "torque"];
const INERTIA: &str = "inertia = [\"Ixx\", \"Iyy\", \"Izz\"]";
const POSITION: &str = "position = [\"x\", \"y\", \"z\"]";

/// A body with a position.
pub(super) fn body(item: &Item<'_>, table: &Table<'_>) -> Result<Body, ModelError> {
    let name = item.new_label()?;
    let (mut mass, mut position, mut inertia, mut force, mut torque) = (None, None, None, None, None);
    let (mut orientation, mut turning) = (None, None);
    for part in table.items() {
        match part.key() {
            "mass" => mass = Some(part.expression()?),
            "position" => position = Some(part.array("3 expressions", POSITION)?),
            "inertia" => inertia = Some(self::inertia(&part)?),
            "force" => force = Some(part.array("3 expressions", "force = [\"0\", \"0\", \"-m*g\"]")?),
            "torque" => torque = Some(part.array("3 expressions", "torque = [\"0\", \"0\", \"M\"]")?),
            "rotation" | "angular_velocity" => {
                let this = self::orientation(&part)?;
                turning = Some(part.clone());
                if orientation.replace(this).is_some() {
                    return Err(part.key_error(ErrorKind::Exclusive {
                        first: "rotation",
                        second: "angular_velocity",
                        help: "the angular velocity follows from `rotation`; give one of them",
                    }));
                }
            }
            _ => return Err(part.unknown(KEYS)),
        }
    }
    let missing = |key, example| table.error(ErrorKind::Missing { key, example });
    let mass = mass.ok_or_else(|| missing("mass", "mass = 1.0"))?;
    let position = position.ok_or_else(|| missing("position", POSITION))?;
    if orientation.is_none() && (inertia.is_some() || torque.is_some()) {
        return Err(missing("angular_velocity", "angular_velocity = [\"w1\", \"w2\", \"w3\"]"));
    }
    if let Some(turning) = turning.filter(|_| inertia.is_none() && torque.is_none()) {
        let key = turning.key().to_owned();
        return Err(turning.key_error(ErrorKind::NoEffect { key, without: "inertia", example: INERTIA }));
    }
    Ok(Body { name, place: table.place.clone(), mass, position, inertia, orientation, force, torque })
}

pub(super) fn gravity(table: &Table<'_>) -> Result<Gravity, ModelError> {
    const ACCELERATION: &str = "acceleration = [0, 0, -9.81]";
    let mut acceleration = None;
    for item in table.items() {
        match item.key() {
            "acceleration" => acceleration = Some(item.array("3 expressions", ACCELERATION)?),
            _ => return Err(item.unknown(&["acceleration"])),
        }
    }
    match acceleration {
        Some(acceleration) => Ok(Gravity { place: table.place.clone(), acceleration }),
        None => Err(table.error(ErrorKind::Missing { key: "acceleration", example: ACCELERATION })),
    }
}

pub(super) fn inertia(item: &Item<'_>) -> Result<Inertia, ModelError> {
    let (expected, example) = ("3 or 6 expressions", INERTIA);
    let list = item.list(&[3, 6], expected, example)?;
    let list = match <[_; 3]>::try_from(list) {
        Ok(principal) => return Ok(Inertia::Principal(Box::new(principal))),
        Err(list) => list,
    };
    <[_; 6]>::try_from(list)
        .map(|entries| Inertia::Full(Box::new(entries)))
        .map_err(|list| item.error(ErrorKind::WrongLength { expected, found: list.len(), example }))
}

fn orientation(item: &Item<'_>) -> Result<Orientation, ModelError> {
    if item.key() == "rotation" {
        let example =
            "rotation = [\"R11\", \"R12\", \"R13\", \"R21\", \"R22\", \"R23\", \"R31\", \"R32\", \"R33\"]";
        return Ok(Orientation::Rotation(Box::new(item.array("9 expressions", example)?)));
    }
    let example = "angular_velocity = [\"w1\", \"w2\", \"w3\"]";
    Ok(Orientation::AngularVelocity(Box::new(item.array("3 expressions", example)?)))
}

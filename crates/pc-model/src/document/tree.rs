//! The sections of bodies, including those on joints, and of points of bodies.

use super::reader::{Item, Table};
use crate::diagnostics::error::ModelError;
use crate::diagnostics::error_kind::ErrorKind;
use crate::diagnostics::meaning::MeaningError;
use crate::document::bodies::{body, inertia};
use crate::document::contents::Body;
use crate::document::expression::Name;
use crate::document::joints::{
    Drive, Following, Joint, JointKind, JointRotation, Point, TreeBody, WORLD, prime,
};

const KEYS: &[&str] = &["parent", "joint", "mass", "center", "inertia", "force", "torque"];
const JOINT_KEYS: &[&str] = &[
    "kind",
    "axis",
    "axes",
    "pitch",
    "at",
    "rotation",
    "turns",
    "coordinates",
    "quasi_velocities",
    "follows",
    "ratio",
    "offset",
    "armature",
    "stiffness",
    "rest",
    "damping",
    "friction",
    "stiction",
    "limits",
    "restitution",
    "stop_stiffness",
    "stop_damping",
];
const LIMITS: &str = "limits = [-1.5, 1.5]";
/// The entries of joints with one coordinate.
const OF_SINGLE: &[&str] = &[
    "follows",
    "armature",
    "stiffness",
    "rest",
    "damping",
    "friction",
    "stiction",
    "limits",
    "restitution",
    "stop_stiffness",
    "stop_damping",
];
pub(super) const JOINT: &str = "joint = { kind = \"revolute\", axis = [0, 0, 1], at = [0, 0, 0] }";
const AXIS: &str = "axis = [0, 0, 1]";
const AXES: &str = "axes = [[1, 0, 0], [0, 1, 0]]";
const AT: &str = "at = [0, 0, 0]";
const TURNS: &str = "turns = [[\"z\", \"pi/2\"], [\"x\", \"a\"]]";

/// A few times the rounding error of a number near 1.
pub(crate) const ROUNDING: f64 = 1e-15;

/// The bodies with a position, and those with a joint.
pub(super) fn bodies(table: &Table<'_>) -> Result<(Vec<Body>, Vec<TreeBody>), ModelError> {
    let (mut placed, mut hanging) = (Vec::new(), Vec::new());
    for item in table.items() {
        let table = item.section(&format!("bodies.{}", item.new_label()?.text), "[bodies.NAME]")?;
        match table.has("joint") || table.has("parent") || table.has("center") {
            true => hanging.push(hung(&item, &table)?),
            false => placed.push(body(&item, &table)?),
        }
    }
    Ok((placed, hanging))
}

/// A body with an entry `joint`.
fn hung(item: &Item<'_>, table: &Table<'_>) -> Result<TreeBody, ModelError> {
    let name = item.new_label()?;
    if name.text == WORLD {
        return Err(item.key_error(ErrorKind::Reserved { name: name.text }));
    }
    let (mut parent, mut hangs, mut mass, mut center) = (None, None, None, None);
    let (mut moments, mut force, mut torque) = (None, None, None);
    for part in table.items() {
        match part.key() {
            "parent" => parent = Some(part.text()?),
            "joint" => hangs = Some(joint(&part, item)?),
            "mass" => mass = Some(part.expression()?),
            "center" => center = Some(part.array("3 expressions", "center = [0, 0, \"l/2\"]")?),
            "inertia" => moments = Some(inertia(&part)?),
            "force" => force = Some(part.array("3 expressions", "force = [\"0\", \"0\", \"-m*g\"]")?),
            "torque" => torque = Some(part.array("3 expressions", "torque = [\"0\", \"0\", \"M\"]")?),
            "position" => return Err(placed_twice(&part, "position")),
            "rotation" => return Err(placed_twice(&part, "rotation")),
            "angular_velocity" => return Err(placed_twice(&part, "angular_velocity")),
            _ => return Err(part.unknown(KEYS)),
        }
    }
    let joint = hangs.ok_or_else(|| table.error(ErrorKind::Missing { key: "joint", example: JOINT }))?;
    Ok(TreeBody {
        name,
        place: table.place.clone(),
        parent,
        joint,
        mass,
        center,
        inertia: moments,
        force,
        torque,
    })
}

/// Checks that the entries are there without which this one of a drive has no effect, and none that excludes it.
fn check_companions(part: &Item<'_>, drive: &Drive) -> Result<(), ModelError> {
    let has_stops = drive.restitution.is_some() || drive.stop_stiffness.is_some();
    let (without, example, is_there) = match part.key() {
        "rest" => ("stiffness", "stiffness = 10.0", drive.stiffness.is_some()),
        "stiction" => ("friction", "friction = 1.0", drive.friction.is_some()),
        "limits" => ("restitution` or `stop_stiffness", "restitution = 0.5", has_stops),
        "restitution" | "stop_stiffness" => ("limits", LIMITS, drive.limits.is_some()),
        "stop_damping" if drive.restitution.is_none() => ("limits", LIMITS, drive.limits.is_some()),
        "stop_damping" => ("stop_stiffness", "stop_stiffness = 1e4", drive.stop_stiffness.is_some()),
        _ => return Ok(()),
    };
    if !is_there {
        return Err(part.key_error(ErrorKind::NoEffect { key: part.key().to_owned(), without, example }));
    }
    if part.key() == "restitution" && drive.stop_stiffness.is_some() {
        return Err(part.key_error(ErrorKind::Exclusive {
            first: "restitution",
            second: "stop_stiffness",
            help: "`restitution` makes the stops rigid, `stop_stiffness` springs; give one of them",
        }));
    }
    Ok(())
}

fn placed_twice(part: &Item<'_>, second: &'static str) -> ModelError {
    part.key_error(ErrorKind::Exclusive {
        first: "joint",
        second,
        help: "a body with a joint has its place and its attitude from that: `at` and `rotation` are the joint's",
    })
}

/// The joint at `item` of the body at `body`.
fn joint(item: &Item<'_>, body: &Item<'_>) -> Result<Joint, ModelError> {
    let table = item.table("a table", "{ kind = \"revolute\", axis = [0, 0, 1] }")?;
    let (mut kind, mut axes, mut pitch, mut at, mut rotation) = (None, None, None, None, None);
    let (mut coordinates, mut quasi_velocities) = (None, None);
    let (mut follows, mut ratio, mut offset) = (None, None, None);
    let (mut drive, mut driven) = (Drive::default(), Vec::new());
    for part in table.items() {
        match part.key() {
            "kind" => kind = Some(part.choice(JointKind::ALL)?),
            "axis" => axes = Some((part.clone(), vec![direction(&part, AXIS)?])),
            "axes" => {
                let both = part.parts(&[2], "2 axes", AXES)?;
                let both = both.iter().map(|axis| direction(axis, AXES));
                axes = Some((part.clone(), both.collect::<Result<_, _>>()?));
            }
            "pitch" => pitch = Some((part.clone(), part.expression()?)),
            "at" => at = Some(part.array("3 expressions", AT)?),
            "rotation" | "turns" => {
                let this = self::rotation(&part)?;
                if rotation.replace(this).is_some() {
                    return Err(part.key_error(ErrorKind::Exclusive {
                        first: "rotation",
                        second: "turns",
                        help: "`rotation` has the nine entries of a matrix, `turns` angles about axes; give one of them",
                    }));
                }
            }
            "coordinates" => coordinates = Some(part),
            "quasi_velocities" => quasi_velocities = Some(part),
            "follows" => follows = Some(part),
            "ratio" => ratio = Some(part),
            "offset" => offset = Some(part),
            "limits" => {
                drive.limits = Some(part.array("2 expressions", LIMITS)?);
                driven.push(part);
            }
            "armature" | "stiffness" | "rest" | "damping" | "friction" | "stiction" | "restitution"
            | "stop_stiffness" | "stop_damping" => {
                let value = Some(part.expression()?);
                match part.key() {
                    "armature" => drive.armature = value,
                    "stiffness" => drive.stiffness = value,
                    "rest" => drive.rest = value,
                    "damping" => drive.damping = value,
                    "friction" => drive.friction = value,
                    "stiction" => drive.stiction = value,
                    "restitution" => drive.restitution = value,
                    "stop_stiffness" => drive.stop_stiffness = value,
                    _ => drive.stop_damping = value,
                }
                driven.push(part);
            }
            _ => return Err(part.unknown(JOINT_KEYS)),
        }
    }
    let missing = |key, example| table.error(ErrorKind::Missing { key, example });
    let kind = kind.ok_or_else(|| missing("kind", "kind = \"revolute\""))?.value;
    let axes = match (kind.axes(), axes) {
        (0, None) => Vec::new(),
        (1, None) => return Err(missing("axis", AXIS)),
        (_, None) => return Err(missing("axes", AXES)),
        (1, Some((part, list))) if list.len() == 1 => {
            check_normal(kind, &part, list[0])?;
            list
        }
        (2, Some((_, list))) if list.len() == 2 => list,
        (_, Some((part, _))) => return Err(without_effect(&part, kind)),
    };
    let pitch = match (kind, pitch) {
        (JointKind::Screw, None) => return Err(missing("pitch", "pitch = 0.01")),
        (JointKind::Screw, Some((_, pitch))) => Some(pitch),
        (_, Some((part, _))) => return Err(without_effect(&part, kind)),
        (_, None) => None,
    };
    if let Some(part) = driven.first().filter(|_| !kind.is_single()) {
        return Err(without_effect(part, kind));
    }
    driven.iter().try_for_each(|part| check_companions(part, &drive))?;
    let coordinates = names(coordinates.as_ref(), body, kind.coordinates(body.key(), &axes))?;
    let gear = Gear { follows, ratio, offset };
    if let Some(follows) = gear.following(kind, &coordinates, quasi_velocities.as_ref())? {
        let (coordinates, quasi_velocities) = (Vec::new(), Vec::new());
        let (place, follows) = (item.place(), Some(follows));
        return Ok(Joint {
            place,
            kind,
            axes,
            pitch,
            at,
            rotation,
            coordinates,
            quasi_velocities,
            follows,
            drive,
        });
    }
    let own: Vec<String> = coordinates.iter().map(|name| name.text.clone()).collect();
    let usual = kind.quasi_velocities(body.key(), &own);
    let quasi_velocities = match &quasi_velocities {
        None if kind.is_of_velocities() => {
            let velocity = |x: &Name| Name { text: prime(&x.text), place: x.place.clone() };
            coordinates.iter().map(velocity).collect()
        }
        given => names(given.as_ref(), body, usual)?,
    };
    let (place, follows) = (item.place(), None);
    Ok(Joint { place, kind, axes, pitch, at, rotation, coordinates, quasi_velocities, follows, drive })
}

/// The entries of a joint that gear it to another.
struct Gear<'a> {
    follows: Option<Item<'a>>,
    ratio: Option<Item<'a>>,
    offset: Option<Item<'a>>,
}

impl Gear<'_> {
    /// How the joint follows another, if it does; `names` are those that its coordinates would have.
    fn following(
        self,
        kind: JointKind,
        names: &[Name],
        quasi_velocities: Option<&Item<'_>>,
    ) -> Result<Option<Following>, ModelError> {
        let Gear { follows, ratio, offset } = self;
        let Some(follows) = follows else {
            return match ratio.or(offset) {
                None => Ok(None),
                Some(part) => {
                    let (key, example) = (part.key().to_owned(), "follows = \"…\"");
                    Err(part.key_error(ErrorKind::NoEffect { key, without: "follows", example }))
                }
            };
        };
        let [name] = names else { return Err(without_effect(&follows, kind)) };
        if let Some(part) = quasi_velocities {
            return Err(part.key_error(ErrorKind::Exclusive {
                first: "follows",
                second: "quasi_velocities",
                help: "a joint that follows another has no quasi-velocity of its own: leave `quasi_velocities` out",
            }));
        }
        let expression = |part: Option<Item<'_>>| part.map(|part| part.expression()).transpose();
        let (ratio, offset) = (expression(ratio)?, expression(offset)?);
        Ok(Some(Following { body: follows.text()?, ratio, offset, name: name.clone() }))
    }
}

/// The components of a direction. A component that is only rounding error relative to the largest, such as
/// cos(π/2) in axes written by a program, is set to 0: otherwise a loop could restrict directions that
/// parallel axes leave free.
pub(super) fn direction(item: &Item<'_>, example: &'static str) -> Result<[f64; 3], ModelError> {
    let components = item.parts(&[3], "3 numbers", example)?;
    let mut direction = [0.0; 3];
    for (value, component) in direction.iter_mut().zip(&components) {
        *value = component.number()?.value;
    }
    let largest = direction.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    match largest == 0.0 {
        true => Err(item.error(MeaningError::ZeroAxis)),
        false => Ok(direction.map(|value| if value.abs() <= ROUNDING * largest { 0.0 } else { value })),
    }
}

/// Checks that the normal of a planar joint is one of the joint axes: the translations are along the joint
/// axes that follow it.
fn check_normal(kind: JointKind, part: &Item<'_>, normal: [f64; 3]) -> Result<(), ModelError> {
    if kind != JointKind::Planar
        || (0..3).any(|i| normal[i] > 0.0 && normal[(i + 1) % 3] == 0.0 && normal[(i + 2) % 3] == 0.0)
    {
        return Ok(());
    }
    let found = format!("[{}, {}, {}]", normal[0], normal[1], normal[2]);
    Err(part.error(ErrorKind::OutOfRange {
        expected: "[1, 0, 0], [0, 1, 0] or [0, 0, 1] as the normal of a planar joint, whose axes `rotation` or `turns` can turn",
        found,
        example: AXIS,
    }))
}

/// The error for an entry that joints of this kind do not have.
fn without_effect(part: &Item<'_>, kind: JointKind) -> ModelError {
    let example = match kind.axes() {
        _ if OF_SINGLE.contains(&part.key()) => "kind = \"revolute\"",
        0 => "kind = \"revolute\"",
        1 if part.key() == "axes" => AXIS,
        1 => "kind = \"screw\"",
        _ => AXES,
    };
    part.key_error(ErrorKind::OfOtherJoints { key: part.key().to_owned(), example })
}

/// The names listed in an entry, or the default names.
fn names(list: Option<&Item<'_>>, body: &Item<'_>, usual: Vec<String>) -> Result<Vec<Name>, ModelError> {
    let Some(list) = list else {
        return usual.into_iter().map(|name| body.derived_name(name)).collect();
    };
    let (expected, example) = match (usual.len(), list.key()) {
        (0, _) => ("no names", "kind = \"fixed\""),
        (1, "coordinates") => ("1 name", "coordinates = [\"x\"]"),
        (2, "coordinates") => ("2 names", "coordinates = [\"x\", \"y\"]"),
        (3, "coordinates") => ("3 names", "coordinates = [\"x\", \"y\", \"z\"]"),
        (4, "coordinates") => ("4 names", "coordinates = [\"q0\", \"q1\", \"q2\", \"q3\"]"),
        (_, "coordinates") => {
            ("7 names", "coordinates = [\"x\", \"y\", \"z\", \"q0\", \"q1\", \"q2\", \"q3\"]")
        }
        (1, _) => ("1 name", "quasi_velocities = [\"u\"]"),
        (2, _) => ("2 names", "quasi_velocities = [\"u\", \"v\"]"),
        (3, _) => ("3 names", "quasi_velocities = [\"p\", \"q\", \"r\"]"),
        (_, _) => ("6 names", "quasi_velocities = [\"u\", \"v\", \"w\", \"p\", \"q\", \"r\"]"),
    };
    list.parts(&[usual.len()], expected, example)?.iter().map(Item::value_as_name).collect()
}

fn rotation(part: &Item<'_>) -> Result<JointRotation, ModelError> {
    if part.key() == "rotation" {
        let example = "rotation = [1, 0, 0, 0, 1, 0, 0, 0, 1]";
        return Ok(JointRotation::Matrix(Box::new(part.array("9 expressions", example)?)));
    }
    let turns = part.parts(&[1, 2, 3], "1 to 3 turns", TURNS)?;
    let turn = |turn: &Item<'_>| {
        let parts = turn.parts(&[2], "an axis and an angle", TURNS)?;
        let axis = parts[0].choice(&[("x", 0), ("y", 1), ("z", 2)])?;
        Ok((axis.value, parts[1].expression()?))
    };
    Ok(JointRotation::Turns(turns.iter().map(turn).collect::<Result<_, ModelError>>()?))
}

/// `[points.NAME]`
pub(super) fn points(table: &Table<'_>) -> Result<Vec<Point>, ModelError> {
    table.items().map(|item| point(&item)).collect()
}

fn point(item: &Item<'_>) -> Result<Point, ModelError> {
    let name = item.new_name()?;
    let table = item.section(&format!("points.{}", name.text), "[points.NAME]")?;
    let (mut body, mut at) = (None, None);
    for part in table.items() {
        match part.key() {
            "body" => body = Some(part.text()?),
            "at" => at = Some(part.array("3 expressions", AT)?),
            _ => return Err(part.unknown(&["body", "at"])),
        }
    }
    let body =
        body.ok_or_else(|| table.error(ErrorKind::Missing { key: "body", example: "body = \"…\"" }))?;
    Ok(Point::new(name, body, at))
}

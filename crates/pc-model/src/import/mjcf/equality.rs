//! Equality constraints of an MJCF file.

use roxmltree::Node;

use crate::import::error::UrdfError;
use crate::import::mjcf::bodies::{Bodies, Body};
use crate::import::mjcf::defaults::{Defaults, Element};
use crate::import::pose::{Pose, of_quaternion};
use crate::import::robot::{Closing, Closure, Coupling, Kind, Mimic, Robot, WORLD};

/// Adds a constraint to the robot.
pub(super) fn read<'d>(
    defaults: &Defaults<'_, 'd>,
    bodies: &Bodies<'_, '_, 'd>,
    node: Node<'d, 'd>,
    robot: &mut Robot,
) -> Result<(), UrdfError> {
    let element = defaults.element(node, None)?;
    let kind = node.tag_name().name();
    let called = node.attribute("name").map(|name| format!(" `{name}`")).unwrap_or_default();
    if element.text("active") == Some("false") {
        robot.notes.push(format!("the inactive <{kind}>{called} is left out"));
        return Ok(());
    }
    let by_sites = element.source("site1").is_some();
    match kind {
        "connect" | "weld" if !by_sites => {
            let [one, two] = ends(defaults, bodies, &element)?;
            let count = robot.loops.len() + 1;
            let name = node.attribute("name").map_or_else(|| format!("{kind}_{count}"), str::to_owned);
            // The pose of the second body in the first one.
            let relative = one.in_world.inverse().then(&two.in_world);
            let closure = match kind {
                "connect" => {
                    let anchor = defaults.xml.vector(node, "anchor")?.ok_or_else(|| {
                        defaults.xml.wrong(node, "it has no `anchor`", "write <connect anchor=\"x y z\">")
                    })?;
                    let (one_place, place) = (Pose::at(anchor), relative.inverse().then(&Pose::at(anchor)));
                    closed(name, Closing::Point, &one, &two, one_place, place)
                }
                _ => {
                    let relative = welded(defaults, &element)?.unwrap_or(relative);
                    closed(name, Closing::Weld, &one, &two, relative, Pose::default())
                }
            };
            robot.loops.push(closure);
            Ok(())
        }
        "joint" => coupled(defaults, &element, robot),
        _ => {
            let by = if by_sites { " between sites" } else { "" };
            robot.notes.push(format!("the <{kind}>{called}{by} is left out"));
            Ok(())
        }
    }
}

fn closed(name: String, kind: Closing, one: &Body, two: &Body, at_one: Pose, at_two: Pose) -> Closure {
    Closure {
        name,
        kind,
        links: [one.link.clone(), two.link.clone()],
        places: [one.in_link.then(&at_one), two.in_link.then(&at_two)],
    }
}

fn ends<'d>(
    defaults: &Defaults<'_, 'd>,
    bodies: &Bodies<'_, '_, 'd>,
    element: &Element<'_, '_, 'd>,
) -> Result<[Body; 2], UrdfError> {
    let find = |key: &str| {
        let name = match (element.text(key), key) {
            (Some(name), _) => name,
            (None, "body2") => WORLD,
            (None, _) => {
                return Err(defaults.xml.wrong(element.node, "it has no `body1`", "name two bodies"));
            }
        };
        let body = bodies.named.get(name).cloned();
        body.ok_or_else(|| element.wrong(key, format!("there is no body `{name}`"), "name one that is there"))
    };
    Ok([find("body1")?, find("body2")?])
}

/// The pose of the second body in the first one that `relpose` gives; none if it gives none.
fn welded(defaults: &Defaults<'_, '_>, element: &Element<'_, '_, '_>) -> Result<Option<Pose>, UrdfError> {
    match element.list("relpose")?.as_deref() {
        Some(&[x, y, z, w, a, b, c]) if [w, a, b, c] != [0.0; 4] => {
            Ok(Some(Pose::new([x, y, z], &of_quaternion([a, b, c, w]))))
        }
        None | Some(&[_, _, _, 0.0, 0.0, 0.0, 0.0]) => Ok(None),
        Some(_) => {
            let help = "write seven numbers, a position and a quaternion";
            Err(defaults.xml.wrong_value(element.node, "relpose", "this is no pose", help))
        }
    }
}

/// q_1 = a_0 + a_1 q_2 + a_2 q_2² + …, each coordinate from the position of the file.
fn coupled(
    defaults: &Defaults<'_, '_>,
    element: &Element<'_, '_, '_>,
    robot: &mut Robot,
) -> Result<(), UrdfError> {
    let find = |robot: &Robot, key: &str| {
        let Some(name) = element.text(key) else { return Ok(None) };
        match robot.joints.iter().position(|joint| joint.name == name && joint.kind.is_single()) {
            Some(joint) => Ok(Some(joint)),
            None => {
                let message = format!("there is no hinge or slide `{name}`");
                Err(element.wrong(key, message, "name one that is there"))
            }
        }
    };
    let Some(one) = find(robot, "joint1")? else {
        return Err(defaults.xml.wrong(element.node, "it has no `joint1`", "name two joints"));
    };
    let two = find(robot, "joint2")?;
    let given = element.list("polycoef")?.unwrap_or_else(|| vec![0.0, 1.0]);
    let mut coefficients = [0.0; 5];
    coefficients.iter_mut().zip(&given).for_each(|(own, given)| *own = *given);
    let joints = &mut robot.joints;
    match two.map(|two| joints[two].name.clone()) {
        Some(other)
            if coefficients[2..] == [0.0; 3]
                && joints[one].mimic.is_none()
                && joints[one].kind != Kind::Fixed
                && !follows(joints, &other, &joints[one].name) =>
        {
            let [offset, multiplier, ..] = coefficients;
            joints[one].mimic = Some(Mimic { joint: other, multiplier, offset });
        }
        other => {
            let joint = joints[one].name.clone();
            robot.couplings.push(Coupling { joint, other, coefficients });
        }
    }
    Ok(())
}

/// Whether a joint mimics another, or is that one.
fn follows(joints: &[crate::import::robot::Joint], joint: &str, other: &str) -> bool {
    let mut next = joint;
    loop {
        if next == other {
            return true;
        }
        match joints.iter().find(|known| known.name == next).and_then(|known| known.mimic.as_ref()) {
            Some(mimic) => next = &mimic.joint,
            None => return false,
        }
    }
}

//! Writes a model as a robot in URDF.

use std::fmt::Write;

use pc_mech::Graph;

use crate::diagnostics::error::ModelError;
use crate::diagnostics::source::{Place, Source};
use crate::document::{Document, Expression, Following, JointKind, TreeBody, WORLD};
use crate::export::constants::Constants;
use crate::import::UrdfError;
use crate::import::pose::Pose;
use crate::model::model::Model;

/// The limit that is written where URDF requires one and a model has none.
const UNLIMITED: &str = "1e9";

/// The acceleration of gravity that programs assume.
const STANDARD: [f64; 3] = [0.0, 0.0, -9.81];

/// The text of a robot in URDF that moves like the model, and notes on what was left out.
///
/// Bodies become links, joints keep the names of their coordinates, dampers and dry friction become `<dynamics>`, stops
/// `<limit>`, and joints that follow others mimic them. A link
/// `world` carries the bodies unless one of them is fixed at the origin and carries all others.
///
/// # Errors
/// [`UrdfError`], which gives the line and column in the model, at the first part that URDF cannot express.
pub fn urdf_of_model(model: &Model) -> Result<(String, Vec<String>), UrdfError> {
    let document = model.document();
    let source = &document.source;
    refuse_other_parts(document)?;
    let graph = Graph::new();
    let mut constants = Constants::of(&graph, model);
    let mut text = format!("<?xml version=\"1.0\"?>\n<robot name=\"{}\">\n", escaped(model.title()));
    let dampings = dampings(source, &mut constants)?;
    let root = root(&mut constants)?;
    if root.is_none() {
        text += "  <link name=\"world\"/>\n";
    }
    for (body, damping) in document.tree.iter().zip(&dampings) {
        text += &link(&mut constants, body)?;
        if root != Some(body.name.text.as_str()) {
            text += &joint(source, &mut constants, body, *damping)?;
        }
    }
    text += "</robot>\n";
    let mut notes = Vec::new();
    let gravity = document.gravity.as_ref().map(|gravity| constants.gravity(&gravity.acceleration));
    match gravity.transpose().map_err(|error| shown(&error))? {
        Some(Some([x, y, z])) if [x, y, z] != STANDARD => {
            notes.push(format!("the acceleration of gravity, ({x}, {y}, {z}), is not a part of URDF"));
        }
        Some(Some(_)) => {}
        Some(None) => notes.push("gravity, which is not constant, is not a part of URDF".to_owned()),
        None => notes.push("that there is no gravity is not a part of URDF".to_owned()),
    }
    if !starts_at_zero(&mut constants)? {
        notes.push("the start is not a part of URDF".to_owned());
    }
    if !document.events.is_empty() {
        notes.push("events are not a part of URDF".to_owned());
    }
    let drives = || document.tree.iter().map(|body| &body.joint.drive);
    if drives().any(|drive| drive.limits.is_some()) {
        notes.push("how stops push back or rebound is not a part of URDF".to_owned());
    }
    if drives().any(|drive| drive.stiction.is_some()) {
        notes.push("stiction is not a part of URDF".to_owned());
    }
    if document
        .tree
        .iter()
        .any(|body| body.joint.kind == JointKind::Prismatic && body.joint.drive.limits.is_none())
    {
        notes.push(format!("prismatic joints have the limits {UNLIMITED}, for URDF requires some"));
    }
    Ok((text, notes))
}

/// An error of the model as one of the export.
fn shown(error: &ModelError) -> UrdfError {
    UrdfError { rendered: error.to_string() }
}

/// Refuses a model with anything but bodies on joints.
fn refuse_other_parts(document: &Document) -> Result<(), UrdfError> {
    let names = |names: Vec<&crate::document::Name>, what: &'static str| {
        names.first().map(|name| (name.place.clone(), what))
    };
    let of_joints: usize = document.tree.iter().map(|body| body.joint.coordinates.len()).sum();
    let energies = document.lagrangian.iter().flat_map(|energy| {
        [&energy.kinetic, &energy.potential, &energy.lagrangian, &energy.dissipation].into_iter().flatten()
    });
    let found = [
        names(document.bodies.iter().map(|body| &body.name).collect(), "a body without a joint"),
        names(
            document.coordinates.iter().skip(of_joints).map(|x| &x.name).collect(),
            "a coordinate that belongs to no joint",
        ),
        names(document.constraints.iter().map(|constraint| &constraint.name).collect(), "a constraint"),
        names(document.states.iter().map(|state| &state.name).collect(), "a state"),
        names(document.inputs.iter().map(|input| &input.name).collect(), "an input"),
        energies
            .into_iter()
            .next()
            .map(|energy| (energy.whole(), "an energy besides that of bodies and weight")),
        document.tree.iter().find_map(|body| {
            let armature = body.joint.drive.armature.as_ref()?;
            Some((armature.whole(), "a rotor of a joint"))
        }),
        document.tree.iter().find_map(|body| {
            let stiffness = body.joint.drive.stiffness.as_ref()?;
            Some((stiffness.whole(), "a spring of a joint"))
        }),
        document.tree.iter().find_map(|body| {
            let force = body.force.as_ref().or(body.torque.as_ref())?;
            Some((force[0].whole(), "a force on a body"))
        }),
    ];
    let source = &document.source;
    let help = "URDF has bodies on joints with dampers, friction and limits; leave the rest out";
    if let Some((place, what)) = found.into_iter().flatten().next() {
        let message = format!("{what} has no place in URDF");
        return Err(UrdfError::at(source, place.span, place.entry, message, help));
    }
    if document.tree.is_empty() {
        let message = "the model has no bodies on joints";
        return Err(UrdfError::at(
            source,
            0..0,
            "",
            message,
            "a robot has links, which are bodies, and joints",
        ));
    }
    Ok(())
}

/// The body that becomes the root: it is fixed at the origin, and all others hang on it.
fn root<'d>(constants: &mut Constants<'_, 'd>) -> Result<Option<&'d str>, UrdfError> {
    let document = constants.document;
    let mut roots = document.tree.iter().filter(|body| body.parent().is_none());
    let (Some(first), None) = (roots.next(), roots.next()) else { return Ok(None) };
    let is_root = first.joint.kind == JointKind::Fixed
        && constants.pose(&first.joint).map_err(|error| shown(&error))? == Pose::default();
    Ok(is_root.then_some(first.name.text.as_str()))
}

/// The damping of the velocities of each joint.
fn dampings(source: &Source, constants: &mut Constants<'_, '_>) -> Result<Vec<f64>, UrdfError> {
    let document = constants.document;
    let mut all = vec![Vec::new(); document.tree.len()];
    for force in &document.forces {
        let found = document.tree.iter().enumerate().find_map(|(body, hung)| {
            let is_plain = hung.joint.is_plain();
            let velocities = hung.joint.quasi_velocities.iter().enumerate();
            let mut velocities = velocities.filter(|(place, velocity)| {
                let coordinate = hung.joint.coordinates.get(*place).filter(|_| is_plain);
                velocity.text == force.name.text || coordinate.is_some_and(|x| x.text == force.name.text)
            });
            velocities.next().map(|(place, velocity)| (body, place, velocity))
        });
        let damping = match found {
            Some((_, _, velocity)) => {
                constants.damping(&force.expression, &velocity.text).map_err(|error| shown(&error))?
            }
            None => None,
        };
        let (Some((body, place, _)), Some(damping)) = (found, damping) else {
            let message = format!("the force on `{}` is not that of a damper", force.name.text);
            let Place { entry, span } = force.expression.whole();
            let help = "URDF has dampers of joints only, such as \"-0.1*x'\" on `x`";
            return Err(UrdfError::at(source, span, entry, message, help));
        };
        let own: &mut Vec<f64> = &mut all[body];
        own.resize(document.tree[body].joint.quasi_velocities.len(), 0.0);
        own[place] += damping;
    }
    for (own, body) in all.iter_mut().zip(&document.tree) {
        if let Some(damping) = &body.joint.drive.damping {
            own.resize(1, 0.0);
            own[0] += constants.number(damping).map_err(|error| shown(&error))?;
        }
        if own.iter().any(|damping| *damping != own[0]) {
            let message = format!("the velocities of `{}` are damped differently", body.name.text);
            let Place { entry, span } = body.joint.place.clone();
            return Err(UrdfError::at(source, span, entry, message, "a joint of URDF has one damping"));
        }
    }
    Ok(all.iter().map(|own| own.first().copied().unwrap_or_default()).collect())
}

fn starts_at_zero(constants: &mut Constants<'_, '_>) -> Result<bool, UrdfError> {
    let document = constants.document;
    let mut at = 0;
    for body in &document.tree {
        for place in 0..body.joint.coordinates.len() {
            let start =
                constants.number(&document.coordinates[at].expression).map_err(|error| shown(&error))?;
            let default = if body.joint.kind.quaternion() == Some(place) { 1.0 } else { 0.0 };
            if start != default {
                return Ok(false);
            }
            at += 1;
        }
    }
    let velocities = document.quasi_velocities.iter().any(|velocity| velocity.start.is_some());
    Ok(!velocities && document.start_velocities.is_empty())
}

fn link(constants: &mut Constants<'_, '_>, body: &TreeBody) -> Result<String, UrdfError> {
    let name = escaped(&body.name.text);
    let mass =
        body.mass.as_ref().map(|mass| constants.number(mass)).transpose().map_err(|error| shown(&error))?;
    let mass = mass.unwrap_or_default();
    let inertia = constants.inertia(body.inertia.as_ref()).map_err(|error| shown(&error))?;
    if mass == 0.0 && inertia == [0.0; 6] {
        return Ok(format!("  <link name=\"{name}\"/>\n"));
    }
    let center = constants.vector(body.center.as_ref()).map_err(|error| shown(&error))?;
    let [xx, yy, zz, xy, yz, xz] = inertia;
    let mut text = format!("  <link name=\"{name}\">\n    <inertial>\n");
    let _ = writeln!(text, "      <origin xyz=\"{}\"/>", spaced(center));
    let _ = writeln!(text, "      <mass value=\"{mass:?}\"/>");
    let entries = [("ixx", xx), ("ixy", xy), ("ixz", xz), ("iyy", yy), ("iyz", yz), ("izz", zz)];
    let entries = entries.map(|(key, entry)| format!("{key}=\"{entry:?}\""));
    let _ = writeln!(text, "      <inertia {}/>", entries.join(" "));
    Ok(text + "    </inertial>\n  </link>\n")
}

fn joint(
    source: &Source,
    constants: &mut Constants<'_, '_>,
    body: &TreeBody,
    damping: f64,
) -> Result<String, UrdfError> {
    let joint = &body.joint;
    let word = match joint.kind {
        JointKind::Fixed => "fixed",
        JointKind::Revolute if joint.drive.limits.is_some() => "revolute",
        JointKind::Revolute => "continuous",
        JointKind::Prismatic => "prismatic",
        JointKind::Planar => "planar",
        JointKind::Free => "floating",
        JointKind::Screw | JointKind::Cylindrical | JointKind::Universal | JointKind::Spherical => {
            let message = format!("the joint of `{}` has no place in URDF", body.name.text);
            let help = "its joints are fixed, revolute, prismatic, planar and free";
            let Place { entry, span } = joint.place.clone();
            return Err(UrdfError::at(source, span, entry, message, help));
        }
    };
    let name = joint_name(body);
    let pose = constants.pose(joint).map_err(|error| shown(&error))?;
    let parent = escaped(body.parent().unwrap_or(WORLD));
    let mut text = format!(
        "  <joint name=\"{name}\" type=\"{word}\">\n    <origin xyz=\"{}\" rpy=\"{}\"/>\n    \
         <parent link=\"{parent}\"/>\n    <child link=\"{}\"/>\n",
        spaced(pose.xyz),
        spaced(pose.rpy),
        escaped(&body.name.text)
    );
    if let [axis] = joint.axes.as_slice() {
        let _ = writeln!(text, "    <axis xyz=\"{}\"/>", spaced(*axis));
    }
    let ends = match &joint.drive.limits {
        Some(ends) => {
            let [lower, upper] =
                [0, 1].map(|end| constants.number(&ends[end]).map_err(|error| shown(&error)));
            Some([lower?, upper?].map(|end| format!("{end:?}")))
        }
        None => (joint.kind == JointKind::Prismatic).then(|| [format!("-{UNLIMITED}"), UNLIMITED.to_owned()]),
    };
    if let Some([lower, upper]) = ends {
        let most = format!("effort=\"{UNLIMITED}\" velocity=\"{UNLIMITED}\"");
        let _ = writeln!(text, "    <limit lower=\"{lower}\" upper=\"{upper}\" {most}/>");
    }
    if let Some(Following { body: followed, ratio, offset, .. }) = &joint.follows {
        let other = constants.document.tree.iter().find(|body| body.name.text == followed.value);
        let mut number = |part: &Option<Expression>, default: f64| {
            part.as_ref().map_or(Ok(default), |part| constants.number(part).map_err(|error| shown(&error)))
        };
        let (ratio, offset) = (number(ratio, 1.0)?, number(offset, 0.0)?);
        let other = other.map(joint_name).unwrap_or_default(); // it exists
        let _ =
            writeln!(text, "    <mimic joint=\"{other}\" multiplier=\"{ratio:?}\" offset=\"{offset:?}\"/>");
    }
    let friction = joint.drive.friction.as_ref().map(|friction| constants.number(friction));
    let friction = friction.transpose().map_err(|error| shown(&error))?.unwrap_or_default();
    let dynamics =
        [("damping", damping), ("friction", friction)].into_iter().filter(|(_, value)| *value != 0.0);
    let dynamics: Vec<String> = dynamics.map(|(key, value)| format!("{key}=\"{value:?}\"")).collect();
    if !dynamics.is_empty() {
        let _ = writeln!(text, "    <dynamics {}/>", dynamics.join(" "));
    }
    text += "  </joint>\n";
    Ok(text)
}

/// The name of the joint of a body: that of its coordinate, if it has exactly one.
fn joint_name(body: &TreeBody) -> String {
    match (&body.joint.follows, body.joint.coordinates.as_slice()) {
        (Some(following), _) => escaped(&following.name.text),
        (None, [coordinate]) => escaped(&coordinate.text),
        (None, _) => format!("{}_joint", escaped(&body.name.text)),
    }
}

fn spaced(numbers: [f64; 3]) -> String {
    numbers.map(|number| if number == 0.0 { "0".to_owned() } else { format!("{number:?}") }).join(" ")
}

/// The text as the value of an attribute.
fn escaped(text: &str) -> String {
    let text = text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;");
    text.replace(char::is_control, " ")
}

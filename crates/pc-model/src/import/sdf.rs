//! Reads the text of an SDF file, the format of Gazebo, as a robot.
//!
//! Links that hang on nothing move freely, as links of SDF do. Of several joints that have the same child,
//! one carries it, and the others close loops. The origin of a link of the robot is the place of its joint.

mod content;
mod frames;
mod joints;

use std::collections::HashMap;

use roxmltree::{Document, Node};

use crate::diagnostics::source::Source;
use crate::import::error::UrdfError;
use crate::import::pose::Pose;
use crate::import::robot::{Closing, Closure, Inertial, Joint, Kind, Link, Robot, WORLD};
use crate::import::sdf::content::Content;
use crate::import::sdf::frames::Frames;
use crate::import::sdf::joints::{Parsed, joint};
use crate::import::xml::{Reader, child};

/// Elements of a model or world that have no effect on the motion of bodies on joints.
const IDLE: &[&str] = &[
    "name",
    "static",
    "self_collide",
    "allow_auto_disable",
    "enable_wind",
    "pose",
    "frame",
    "scene",
    "physics",
    "light",
    "gui",
    "audio",
    "magnetic_field",
    "spherical_coordinates",
    "gravity",
    "link",
    "joint",
    "model",
];

/// Reads a robot.
///
/// # Errors
/// [`UrdfError`] at the first invalid element or attribute.
pub(crate) fn read(source: &Source, document: &Document<'_>) -> Result<Robot, UrdfError> {
    let (xml, root) = (Content { xml: Reader { source } }, document.root_element());
    xml.check_version(root)?;
    if let Some(node) = root.descendants().find(|node| node.has_tag_name("include")) {
        let help = "write the file with what it includes first: `gz sdf -p robot.sdf`";
        return Err(xml.xml.wrong(node, "the contents of another file belong here", help));
    }
    let mut robot = Robot { format: "SDF", links: vec![Link::world()], ..Robot::default() };
    let mut models: Vec<Node<'_, '_>> = Vec::new();
    for outer in root.children().filter(Node::is_element) {
        match outer.tag_name().name() {
            "model" => models.push(outer),
            "world" => {
                let gravity = child(outer, "gravity").map(|node| xml.vector(node)).transpose()?;
                robot.gravity = Some(gravity.unwrap_or([0.0, 0.0, -9.8]));
                models.extend(outer.children().filter(|node| node.has_tag_name("model")));
                leave_out(outer, &mut robot);
            }
            other => robot.leave_out(other),
        }
    }
    let Some(first) = models.first() else {
        return Err(xml.xml.wrong(
            root,
            "there is no <model>",
            "a file has models, in a <world> or by themselves",
        ));
    };
    robot.name = xml.xml.text(*first, "name")?;
    for model in &models {
        leave_out(*model, &mut robot);
        Model::of(&xml, *model, models.len() > 1)?.add(&mut robot)?;
    }
    robot.tidy();
    Ok(robot)
}

fn leave_out(node: Node<'_, '_>, robot: &mut Robot) {
    for part in node.children().filter(Node::is_element) {
        let name = part.tag_name().name();
        if !IDLE.contains(&name) {
            robot.leave_out(name);
        }
    }
}

/// A model of the file.
struct Model<'e, 'a, 'd> {
    xml: &'e Content<'a>,
    node: Node<'d, 'd>,
    frames: Frames<'e, 'a, 'd>,
    /// What comes before the names of its links and joints.
    prefix: String,
    is_static: bool,
    place: Pose,
}

impl<'e, 'a, 'd> Model<'e, 'a, 'd> {
    fn of(
        xml: &'e Content<'a>,
        node: Node<'d, 'd>,
        has_prefix: bool,
    ) -> Result<Model<'e, 'a, 'd>, UrdfError> {
        for (name, what) in [("model", "a model inside a model"), ("placement_frame", "a placement frame")] {
            let attribute = node.attribute_node(name).filter(|_| name != "model");
            if let Some(inner) = child(node, name) {
                return Err(xml.xml.wrong(
                    inner,
                    format!("{what} has no place here"),
                    "write its links themselves",
                ));
            }
            if attribute.is_some() {
                return Err(xml.xml.wrong_value(
                    node,
                    name,
                    format!("{what} has no place here"),
                    "leave it out",
                ));
            }
        }
        let name = xml.xml.text(node, "name")?;
        let (place, relative) = xml.pose(node)?;
        if let Some(frame) = relative.filter(|frame| *frame != WORLD) {
            let pose = child(node, "pose").unwrap_or(node);
            let message = format!("the pose of a model in `{frame}` is not known here");
            return Err(xml.xml.wrong_value(pose, "relative_to", message, "give it in the world"));
        }
        Ok(Model {
            xml,
            node,
            frames: Frames::of(xml, node)?,
            prefix: if has_prefix { format!("{name}::") } else { String::new() },
            is_static: child(node, "static").is_some_and(|node| xml.is_true(node)),
            place,
        })
    }

    /// Adds the links and joints to a robot.
    fn add(&self, robot: &mut Robot) -> Result<(), UrdfError> {
        let links: Vec<Node<'d, 'd>> =
            self.node.children().filter(|node| node.has_tag_name("link")).collect();
        let joints = self.node.children().filter(|node| node.has_tag_name("joint"));
        let joints: Vec<Parsed> =
            joints.map(|node| joint(self.xml, &self.frames, node)).collect::<Result<_, _>>()?;
        // The pose of the origin of each link of the robot in the model.
        let mut origins: HashMap<String, Pose> = HashMap::new();
        let mut carriers: Vec<Option<usize>> = Vec::new();
        for node in &links {
            let name = self.xml.xml.text(*node, "name")?;
            let carrier = carrier(&joints, &name);
            let origin = match carrier {
                Some(joint) => joints[joint].place,
                None => self.frames.pose(&name, *node)?,
            };
            origins.insert(name, origin);
            carriers.push(carrier);
        }
        let origin = |link: &str| match link {
            WORLD => self.place.inverse(),
            link => origins[link],
        };
        for (node, carrier) in links.iter().zip(&carriers) {
            let name = self.xml.xml.text(*node, "name")?;
            let pose = self.frames.pose(&name, *node)?;
            self.link(robot, *node, &origin(&name).inverse().then(&pose))?;
            let full = format!("{}{name}", self.prefix);
            match carrier {
                None => robot.joints.push(Joint {
                    name: format!("{full}::{}", if self.is_static { "static" } else { "free" }),
                    span: self.xml.xml.tag(*node),
                    kind: if self.is_static { Kind::Fixed } else { Kind::Floating },
                    parent: WORLD.to_owned(),
                    child: full,
                    origin: self.place.then(&pose),
                    ..Joint::default()
                }),
                Some(index) => {
                    let parsed = &joints[*index];
                    let relative = origin(&parsed.parent).inverse().then(&parsed.place);
                    self.hang(robot, parsed, relative);
                }
            }
        }
        for (index, parsed) in joints.iter().enumerate() {
            if carriers.contains(&Some(index)) {
                continue;
            }
            let kind = match (parsed.axes.first().map(|axis| axis.axis), parsed.kind) {
                (_, Kind::Spherical) => Closing::Point,
                (_, Kind::Fixed) => Closing::Weld,
                (Some(axis), Kind::Revolute | Kind::Continuous) if parsed.axes.len() == 1 => {
                    Closing::Revolute(axis)
                }
                _ => {
                    let message =
                        format!("it closes a loop, for `{}` hangs on another joint already", parsed.child);
                    let help = "revolute, ball and fixed joints can close loops";
                    return Err(self.xml.xml.error(
                        parsed.span.clone(),
                        parsed.node(self.node),
                        message,
                        help,
                    ));
                }
            };
            if parsed.axes.iter().any(|axis| axis.damping != 0.0 || axis.stiffness != 0.0) {
                let note = format!(
                    "the damping and the spring of the joint `{}`, which closes a loop, are left out",
                    parsed.name
                );
                robot.notes.push(note);
            }
            let ends = [&parsed.parent, &parsed.child];
            robot.loops.push(Closure {
                name: format!("{}{}", self.prefix, parsed.name),
                kind,
                links: ends.map(|link| self.full(link)),
                places: ends.map(|link| origin(link).inverse().then(&parsed.place)),
            });
        }
        Ok(())
    }

    /// The name of a link in the robot.
    fn full(&self, link: &str) -> String {
        if link == WORLD { WORLD.to_owned() } else { format!("{}{link}", self.prefix) }
    }

    /// Adds a joint; one with two axes becomes two joints, with a link without mass between them.
    fn hang(&self, robot: &mut Robot, parsed: &Parsed, origin: Pose) {
        let full = format!("{}{}", self.prefix, parsed.name);
        let (parent, child) = (self.full(&parsed.parent), self.full(&parsed.child));
        let plain =
            Joint { span: parsed.span.clone(), kind: parsed.kind, pitch: parsed.pitch, ..Joint::default() };
        match parsed.axes.as_slice() {
            [first, second] => {
                let between = format!("{full}::cross");
                robot.links.push(Link::empty(&between, parsed.span.clone()));
                let ends = [
                    (1, first, parent, between.clone(), origin),
                    (2, second, between, child, Pose::default()),
                ];
                for (number, axis, parent, child, origin) in ends {
                    let name = format!("{full}_{number}");
                    robot
                        .joints
                        .push(axis.on(Joint { name, parent, child, origin, ..plain.clone() }, &self.prefix));
                }
            }
            axes => {
                let joint = Joint { name: full, parent, child, origin, ..plain };
                robot.joints.push(match axes.first() {
                    Some(axis) => axis.on(joint, &self.prefix),
                    None => joint,
                });
            }
        }
    }

    /// Adds a link, whose frame in the file has this pose in the link of the robot.
    fn link(&self, robot: &mut Robot, node: Node<'d, 'd>, pose: &Pose) -> Result<(), UrdfError> {
        let name = format!("{}{}", self.prefix, self.xml.xml.text(node, "name")?);
        if robot.links.iter().any(|known| known.name == name) {
            let message = format!("there are two links called `{name}`");
            return Err(self.xml.xml.wrong(node, message, "rename one of them"));
        }
        let own = match child(node, "inertial") {
            Some(inertial) => self.inertial(inertial)?,
            None => {
                robot
                    .notes
                    .push(format!("the link `{name}` has the mass 1 and the moments 1, the defaults of SDF"));
                Inertial { origin: Pose::default(), mass: 1.0, inertia: [1.0, 1.0, 1.0, 0.0, 0.0, 0.0] }
            }
        };
        for (key, what, idle) in [
            ("gravity", "that gravity does not act on", "true"),
            ("kinematic", "that only kinematics move", "false"),
        ] {
            let is_true = idle == "true";
            if child(node, key).is_some_and(|switch| self.xml.is_true(switch) != is_true) {
                robot.notes.push(format!("{what} the link `{name}` is left out"));
            }
        }
        let mut meshes: Vec<String> = Vec::new();
        for uri in
            node.descendants().filter(|node| node.has_tag_name("mesh")).filter_map(|mesh| child(mesh, "uri"))
        {
            let file = uri.text().unwrap_or_default().trim().to_owned();
            if !meshes.contains(&file) {
                meshes.push(file);
            }
        }
        let inertial = Some(Inertial { origin: pose.then(&own.origin), ..own });
        robot.links.push(Link { inertial, meshes, ..Link::empty(&name, self.xml.xml.tag(node)) });
        Ok(())
    }

    fn inertial(&self, node: Node<'d, 'd>) -> Result<Inertial, UrdfError> {
        if node.attribute("auto") == Some("true") {
            let help = "write its mass and its moments";
            return Err(self.xml.xml.wrong_value(node, "auto", "the mass of shapes is not known here", help));
        }
        if let Some(added) = child(node, "fluid_added_mass") {
            let message = "the mass of a surrounding fluid has no place in a model";
            return Err(self.xml.xml.wrong(added, message, "leave it out"));
        }
        let mass = child(node, "mass").map_or(Ok(1.0), |mass| self.xml.number(mass))?;
        if mass < 0.0 {
            let node = child(node, "mass").unwrap_or(node);
            return Err(self.xml.xml.wrong(node, format!("the mass is {mass}"), "a mass is not negative"));
        }
        let mut inertia = [1.0, 1.0, 1.0, 0.0, 0.0, 0.0];
        if let Some(moments) = child(node, "inertia") {
            for (entry, name) in inertia.iter_mut().zip(["ixx", "iyy", "izz", "ixy", "iyz", "ixz"]) {
                if let Some(moment) = child(moments, name) {
                    *entry = self.xml.number(moment)?;
                }
            }
        }
        let (origin, relative) = self.xml.pose(node)?;
        if let Some(frame) = relative {
            let message = format!("the pose of a mass centre in `{frame}` is not known here");
            let pose = child(node, "pose").unwrap_or(node);
            return Err(self.xml.xml.wrong_value(pose, "relative_to", message, "give it in the link"));
        }
        Ok(Inertial { origin, mass, inertia })
    }
}

/// The joint that carries a link: of several, the first that cannot close a loop, or else the first.
fn carrier(joints: &[Parsed], link: &str) -> Option<usize> {
    let mut candidates = joints.iter().enumerate().filter(|(_, joint)| joint.child == link);
    let first = candidates.clone().next();
    candidates.find(|(_, joint)| !joint.can_close()).or(first).map(|(index, _)| index)
}

//! Reads the text of a URDF file as a robot.

use roxmltree::{Document, Node};

use crate::diagnostics::source::Source;
use crate::import::error::UrdfError;
use crate::import::leftover;
use crate::import::pose::{Pose, of_quaternion};
use crate::import::robot::{Inertial, Joint, Kind, Link, Mimic, Robot, Visual};
use crate::import::xml::{Reader, child};

/// Reads a robot.
///
/// # Errors
/// [`UrdfError`] at the first invalid element or attribute.
pub(crate) fn read(source: &Source, document: &Document<'_>) -> Result<Robot, UrdfError> {
    let xml = Reader { source };
    leftover::check(&xml, document)?;
    Urdf { xml }.robot(document.root_element())
}

struct Urdf<'a> {
    xml: Reader<'a>,
}

impl Urdf<'_> {
    fn robot(&self, root: Node<'_, '_>) -> Result<Robot, UrdfError> {
        if root.tag_name().name() != "robot" {
            let found = root.tag_name().name();
            return Err(self.xml.wrong(
                root,
                format!("the root is <{found}>"),
                "the root of URDF is <robot>, that of MJCF <mujoco>, that of SDF <sdf>",
            ));
        }
        let mut robot = Robot {
            format: "URDF",
            name: root.attribute("name").unwrap_or_default().to_owned(),
            ..Robot::default()
        };
        for node in root.children().filter(Node::is_element) {
            match node.tag_name().name() {
                "link" => {
                    let link = self.link(node)?;
                    if robot.links.iter().any(|known| known.name == link.name) {
                        return Err(self.xml.wrong(
                            node,
                            format!("there are two links called `{}`", link.name),
                            "rename one of them",
                        ));
                    }
                    robot.links.push(link);
                }
                "joint" => {
                    let joint = self.joint(node)?;
                    if robot.joints.iter().any(|known| known.name == joint.name) {
                        return Err(self.xml.wrong(
                            node,
                            format!("there are two joints called `{}`", joint.name),
                            "rename one of them",
                        ));
                    }
                    robot.joints.push(joint);
                }
                "material" => {}
                other => robot.leave_out(other),
            }
        }
        if robot.links.is_empty() {
            return Err(self.xml.wrong(
                root,
                "there is no <link>",
                "a robot has links and joints between them",
            ));
        }
        Ok(robot)
    }

    fn link(&self, node: Node<'_, '_>) -> Result<Link, UrdfError> {
        let name = self.xml.text(node, "name")?;
        let shapes =
            node.children().filter(|child| matches!(child.tag_name().name(), "visual" | "collision"));
        let meshes = shapes.flat_map(|shape| shape.descendants().collect::<Vec<_>>());
        let meshes = meshes
            .filter(|child| child.tag_name().name() == "mesh")
            .filter_map(|mesh| mesh.attribute("filename"));
        let mut files: Vec<String> = Vec::new();
        for file in meshes {
            if !files.iter().any(|known| known == file) {
                files.push(file.to_owned());
            }
        }
        let visuals = node.children().filter(|child| child.tag_name().name() == "visual");
        let visuals =
            visuals.filter_map(|visual| self.visual(visual).transpose()).collect::<Result<_, _>>()?;
        let inertial = child(node, "inertial").map(|inertial| self.inertial(inertial)).transpose()?;
        Ok(Link { inertial, meshes: files, visuals, ..Link::empty(&name, self.xml.tag(node)) })
    }

    /// The mesh of a `<visual>`, if it is one.
    fn visual(&self, node: Node<'_, '_>) -> Result<Option<Visual>, UrdfError> {
        let mesh = child(node, "geometry").and_then(|geometry| child(geometry, "mesh"));
        let Some((mesh, file)) = mesh.and_then(|mesh| Some((mesh, mesh.attribute("filename")?))) else {
            return Ok(None);
        };
        let scale = self.xml.vector(mesh, "scale")?.unwrap_or([1.0; 3]);
        Ok(Some(Visual { file: file.to_owned(), origin: self.pose(node)?, scale }))
    }

    fn inertial(&self, node: Node<'_, '_>) -> Result<Inertial, UrdfError> {
        let missing =
            |what| self.xml.wrong(node, format!("it has no <{what}>"), "mass and inertia make a body");
        let mass = child(node, "mass").ok_or_else(|| missing("mass"))?;
        let value = self.xml.number(mass, "value")?;
        if value < 0.0 {
            return Err(self.xml.wrong(mass, format!("the mass is {value}"), "a mass is not negative"));
        }
        let moments = child(node, "inertia").ok_or_else(|| missing("inertia"))?;
        let mut inertia = [0.0; 6];
        for (entry, name) in inertia.iter_mut().zip(["ixx", "iyy", "izz", "ixy", "iyz", "ixz"]) {
            *entry = self.xml.number(moments, name)?;
        }
        Ok(Inertial { origin: self.pose(node)?, mass: value, inertia })
    }

    fn joint(&self, node: Node<'_, '_>) -> Result<Joint, UrdfError> {
        let name = self.xml.text(node, "name")?;
        let word = self.xml.text(node, "type")?;
        let Some((_, kind)) = Kind::ALL.into_iter().find(|(known, _)| *known == word) else {
            let known: Vec<&str> = Kind::ALL.iter().map(|(word, _)| *word).collect();
            let span = self.xml.value_span(node, "type");
            let help = format!("the types are {}", known.join(", "));
            return Err(self.xml.error(span, node, format!("there is no joint of type `{word}`"), &help));
        };
        let link = |which: &str| -> Result<String, UrdfError> {
            let end = child(node, which).ok_or_else(|| {
                self.xml.wrong(node, format!("it has no <{which}>"), "a joint has a <parent> and a <child>")
            })?;
            self.xml.text(end, "link")
        };
        let axis = match child(node, "axis") {
            Some(axis) => self.xml.vector(axis, "xyz")?.unwrap_or([1.0, 0.0, 0.0]),
            None => [1.0, 0.0, 0.0],
        };
        let second_axis = match child(node, "axis2").map(|axis| self.xml.vector(axis, "xyz")).transpose()? {
            Some(axis) => axis.unwrap_or([0.0; 3]),
            None if kind == Kind::Universal => {
                let help = "write <axis2 xyz=\"0 1 0\"/>: the body turns about <axis>, then about <axis2>";
                return Err(self.xml.wrong(node, "it has no <axis2>", help));
            }
            None => [0.0; 3],
        };
        let used: &[(&str, [f64; 3])] = match kind {
            Kind::Universal => &[("axis", axis), ("axis2", second_axis)],
            _ if kind.has_axis() => &[("axis", axis)],
            _ => &[],
        };
        if let Some((name, _)) = used.iter().find(|(_, axis)| *axis == [0.0; 3]) {
            let axis = child(node, name).unwrap_or(node);
            let span = self.xml.value_span(axis, "xyz");
            return Err(self.xml.error(
                span,
                node,
                "the axis has length 0",
                "give it a direction, such as `0 0 1`",
            ));
        }
        let is_normal = (0..3).any(|i| axis[i] > 0.0 && axis[(i + 1) % 3] == 0.0 && axis[(i + 2) % 3] == 0.0);
        if kind == Kind::Planar && !is_normal {
            let axis = child(node, "axis").unwrap_or(node);
            let span = self.xml.value_span(axis, "xyz");
            let message = "a planar joint with a normal that is no axis of the joint has no place in a model"
                .to_owned();
            return Err(self.xml.error(
                span,
                node,
                message,
                "turn the joint by `rpy`, so that its normal is `0 0 1`",
            ));
        }
        let mut limits = Vec::new();
        if let Some(limit) = child(node, "limit") {
            for key in ["lower", "upper", "effort", "velocity", "acceleration", "deceleration", "jerk"] {
                if limit.has_attribute(key) {
                    limits.push((key, self.xml.number(limit, key)?));
                }
            }
        }
        let dynamics = |key| match child(node, "dynamics").filter(|dynamics| dynamics.has_attribute(key)) {
            Some(dynamics) => self.xml.number(dynamics, key),
            None => Ok(0.0),
        };
        let mimic = child(node, "mimic").map(|mimic| self.mimic(mimic)).transpose()?;
        Ok(Joint {
            name,
            span: self.xml.tag(node),
            kind,
            parent: link("parent")?,
            child: link("child")?,
            origin: self.pose(node)?,
            axis,
            second_axis,
            limits,
            damping: dynamics("damping")?,
            friction: dynamics("friction")?,
            mimic,
            ..Joint::default()
        })
    }

    fn mimic(&self, node: Node<'_, '_>) -> Result<Mimic, UrdfError> {
        let number = |key, otherwise| match node.has_attribute(key) {
            true => self.xml.number(node, key),
            false => Ok(otherwise),
        };
        let (multiplier, offset) = (number("multiplier", 1.0)?, number("offset", 0.0)?);
        Ok(Mimic { joint: self.xml.text(node, "joint")?, multiplier, offset })
    }

    /// The `<origin>` of an element.
    fn pose(&self, node: Node<'_, '_>) -> Result<Pose, UrdfError> {
        let Some(origin) = child(node, "origin") else { return Ok(Pose::default()) };
        let part = |key| Ok(self.xml.vector(origin, key)?.unwrap_or_default());
        let (xyz, rpy) = (part("xyz")?, part("rpy")?);
        let Some(quaternion) = self.xml.vector::<4>(origin, "quat_xyzw")? else {
            return Ok(Pose { xyz, rpy });
        };
        let fault = |message: String, help: &str| {
            Err(self.xml.error(self.xml.value_span(origin, "quat_xyzw"), node, message, help))
        };
        if origin.has_attribute("rpy") {
            return fault("there is `rpy`, too".into(), "give the attitude once");
        }
        let length = quaternion.iter().map(|part| part * part).sum::<f64>().sqrt();
        if (length - 1.0).abs() > 1e-3 {
            return fault(
                format!("the length of the quaternion is {length}"),
                "it is 1: x, y, z are the axis times sin(φ/2), w is cos(φ/2)",
            );
        }
        Ok(Pose::new(xyz, &of_quaternion(quaternion)))
    }
}

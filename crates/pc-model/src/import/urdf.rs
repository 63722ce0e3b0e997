//! Reads the text of a URDF file as a robot.

use std::ops::Range;

use roxmltree::{Document, Node};

use crate::diagnostics::source::Source;
use crate::import::error::UrdfError;
use crate::import::robot::{Inertial, Joint, Kind, Link, Mimic, Pose, Robot};

/// Reads a robot.
///
/// # Errors
/// [`UrdfError`] at the first invalid element or attribute.
pub(crate) fn read(source: &Source) -> Result<Robot, UrdfError> {
    let text = source.text();
    let document = Document::parse(text).map_err(|error| {
        let at = error.pos();
        let line = text.split_inclusive('\n').take(at.row as usize - 1).map(str::len).sum::<usize>();
        let column = text[line..].char_indices().nth(at.col as usize - 1).map_or(0, |(column, _)| column);
        let place = (line + column).min(text.len());
        UrdfError::at(
            source,
            place..place,
            "",
            format!("not valid XML: {error}"),
            "URDF is XML, its root is <robot>",
        )
    })?;
    Reader { source }.robot(document.root_element())
}

struct Reader<'a> {
    source: &'a Source,
}

impl Reader<'_> {
    fn error(&self, span: Range<usize>, node: Node<'_, '_>, message: String, help: &str) -> UrdfError {
        let name = node.attribute("name").map(|name| format!(" {name}")).unwrap_or_default();
        UrdfError::at(self.source, span, format!("<{}{name}>", node.tag_name().name()), message, help)
    }

    /// An error about an element, which shows its opening tag.
    fn wrong(&self, node: Node<'_, '_>, message: impl Into<String>, help: &str) -> UrdfError {
        self.error(self.tag(node), node, message.into(), help)
    }

    /// The bytes of the `<name` with which an element begins.
    fn tag(&self, node: Node<'_, '_>) -> Range<usize> {
        let range = node.range();
        let tag = self.source.text()[range.clone()].find(['>', '/', ' ', '\n', '\t']).unwrap_or(1);
        range.start..range.start + tag
    }

    fn robot(&self, root: Node<'_, '_>) -> Result<Robot, UrdfError> {
        if root.tag_name().name() != "robot" {
            let found = root.tag_name().name();
            return Err(self.wrong(root, format!("the root is <{found}>"), "the root of URDF is <robot>"));
        }
        let mut robot =
            Robot { name: root.attribute("name").unwrap_or_default().to_owned(), ..Robot::default() };
        for node in root.children().filter(Node::is_element) {
            if node.tag_name().namespace().is_some_and(|space| space.contains("xacro")) {
                return Err(self.wrong(
                    node,
                    "it is a macro of xacro",
                    "expand the macros first: `xacro robot.xacro > robot.urdf`",
                ));
            }
            match node.tag_name().name() {
                "link" => {
                    let link = self.link(node)?;
                    if robot.links.iter().any(|known| known.name == link.name) {
                        return Err(self.wrong(
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
                        return Err(self.wrong(
                            node,
                            format!("there are two joints called `{}`", joint.name),
                            "rename one of them",
                        ));
                    }
                    robot.joints.push(joint);
                }
                "material" => {}
                other => match robot.left_out.iter_mut().find(|(name, _)| name == other) {
                    Some((_, count)) => *count += 1,
                    None => robot.left_out.push((other.to_owned(), 1)),
                },
            }
        }
        if robot.links.is_empty() {
            return Err(self.wrong(root, "there is no <link>", "a robot has links and joints between them"));
        }
        Ok(robot)
    }

    fn link(&self, node: Node<'_, '_>) -> Result<Link, UrdfError> {
        let name = self.text(node, "name")?;
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
        let inertial = child(node, "inertial").map(|inertial| self.inertial(inertial)).transpose()?;
        Ok(Link { name, span: self.tag(node), inertial, meshes: files })
    }

    fn inertial(&self, node: Node<'_, '_>) -> Result<Inertial, UrdfError> {
        let missing = |what| self.wrong(node, format!("it has no <{what}>"), "mass and inertia make a body");
        let mass = child(node, "mass").ok_or_else(|| missing("mass"))?;
        let value = self.number(mass, "value")?;
        if value < 0.0 {
            return Err(self.wrong(mass, format!("the mass is {value}"), "a mass is not negative"));
        }
        let moments = child(node, "inertia").ok_or_else(|| missing("inertia"))?;
        let mut inertia = [0.0; 6];
        for (entry, name) in inertia.iter_mut().zip(["ixx", "iyy", "izz", "ixy", "iyz", "ixz"]) {
            *entry = self.number(moments, name)?;
        }
        Ok(Inertial { origin: self.pose(node)?, mass: value, inertia })
    }

    fn joint(&self, node: Node<'_, '_>) -> Result<Joint, UrdfError> {
        let name = self.text(node, "name")?;
        let word = self.text(node, "type")?;
        let Some((_, kind)) = Kind::ALL.into_iter().find(|(known, _)| *known == word) else {
            let known: Vec<&str> = Kind::ALL.iter().map(|(word, _)| *word).collect();
            let span = self.value_span(node, "type");
            let help = format!("the types are {}", known.join(", "));
            return Err(self.error(span, node, format!("there is no joint of type `{word}`"), &help));
        };
        let link = |which: &str| -> Result<String, UrdfError> {
            let end = child(node, which).ok_or_else(|| {
                self.wrong(node, format!("it has no <{which}>"), "a joint has a <parent> and a <child>")
            })?;
            self.text(end, "link")
        };
        let axis = match child(node, "axis") {
            Some(axis) => self.vector(axis, "xyz")?.unwrap_or([1.0, 0.0, 0.0]),
            None => [1.0, 0.0, 0.0],
        };
        if axis == [0.0; 3] && !matches!(kind, Kind::Fixed | Kind::Floating) {
            let axis = child(node, "axis").unwrap_or(node);
            let span = self.value_span(axis, "xyz");
            return Err(self.error(
                span,
                node,
                "the axis has length 0".into(),
                "give it a direction, such as `0 0 1`",
            ));
        }
        let is_normal = (0..3).any(|i| axis[i] > 0.0 && axis[(i + 1) % 3] == 0.0 && axis[(i + 2) % 3] == 0.0);
        if kind == Kind::Planar && !is_normal {
            let axis = child(node, "axis").unwrap_or(node);
            let span = self.value_span(axis, "xyz");
            let message = "a planar joint with a normal that is no axis of the joint has no place in a model"
                .to_owned();
            return Err(self.error(
                span,
                node,
                message,
                "turn the joint by `rpy`, so that its normal is `0 0 1`",
            ));
        }
        let mut limits = Vec::new();
        if let Some(limit) = child(node, "limit") {
            for key in ["lower", "upper", "effort", "velocity"] {
                if limit.has_attribute(key) {
                    limits.push((key, self.number(limit, key)?));
                }
            }
        }
        let dynamics = |key| match child(node, "dynamics").filter(|dynamics| dynamics.has_attribute(key)) {
            Some(dynamics) => self.number(dynamics, key),
            None => Ok(0.0),
        };
        let mimic = child(node, "mimic").map(|mimic| self.mimic(mimic)).transpose()?;
        Ok(Joint {
            name,
            span: self.tag(node),
            kind,
            parent: link("parent")?,
            child: link("child")?,
            origin: self.pose(node)?,
            axis,
            limits,
            damping: dynamics("damping")?,
            friction: dynamics("friction")?,
            mimic,
        })
    }

    fn mimic(&self, node: Node<'_, '_>) -> Result<Mimic, UrdfError> {
        let number = |key, otherwise| match node.has_attribute(key) {
            true => self.number(node, key),
            false => Ok(otherwise),
        };
        let (multiplier, offset) = (number("multiplier", 1.0)?, number("offset", 0.0)?);
        Ok(Mimic { joint: self.text(node, "joint")?, multiplier, offset })
    }

    /// The `<origin>` of an element.
    fn pose(&self, node: Node<'_, '_>) -> Result<Pose, UrdfError> {
        let Some(origin) = child(node, "origin") else { return Ok(Pose::default()) };
        if origin.has_attribute("quat_xyzw") {
            let span = self.value_span(origin, "quat_xyzw");
            return Err(self.error(
                span,
                node,
                "`quat_xyzw` has no place here".into(),
                "give the attitude as `rpy`",
            ));
        }
        let part = |key| Ok(self.vector(origin, key)?.unwrap_or_default());
        Ok(Pose { xyz: part("xyz")?, rpy: part("rpy")? })
    }

    fn text(&self, node: Node<'_, '_>, key: &str) -> Result<String, UrdfError> {
        match node.attribute(key) {
            Some(text) => Ok(text.to_owned()),
            None => Err(self.wrong(
                node,
                format!("it has no `{key}`"),
                &format!("write <{} {key}=\"…\">", node.tag_name().name()),
            )),
        }
    }

    fn value_span(&self, node: Node<'_, '_>, key: &str) -> Range<usize> {
        node.attribute_node(key).map_or_else(|| self.tag(node), |attribute| attribute.range_value())
    }

    fn number(&self, node: Node<'_, '_>, key: &str) -> Result<f64, UrdfError> {
        let text = self.text(node, key)?;
        match text.trim().parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => {
                let span = self.value_span(node, key);
                Err(self.error(
                    span,
                    node,
                    format!("`{text}` is not a finite number"),
                    "write a number such as `0.5`",
                ))
            }
        }
    }

    /// Three numbers separated by spaces; none if the attribute is missing.
    fn vector(&self, node: Node<'_, '_>, key: &str) -> Result<Option<[f64; 3]>, UrdfError> {
        let Some(text) = node.attribute(key) else { return Ok(None) };
        let numbers: Result<Vec<f64>, _> = text.split_whitespace().map(str::parse::<f64>).collect();
        let vector = numbers.ok().and_then(|numbers| <[f64; 3]>::try_from(numbers).ok());
        match vector.filter(|vector| vector.iter().all(|part| part.is_finite())) {
            Some(vector) => Ok(Some(vector)),
            None => {
                let span = self.value_span(node, key);
                let message = format!("`{text}` is not three numbers");
                Err(self.error(
                    span,
                    node,
                    message,
                    "write three numbers with spaces between them, such as `0 0 1`",
                ))
            }
        }
    }
}

fn child<'a, 'd>(node: Node<'a, 'd>, name: &str) -> Option<Node<'a, 'd>> {
    node.children().find(|child| child.is_element() && child.tag_name().name() == name)
}

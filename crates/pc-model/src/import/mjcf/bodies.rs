//! The bodies of an MJCF file, nested in each other.

use std::collections::{HashMap, HashSet};

use roxmltree::Node;

use crate::diagnostics::words::rounded;
use crate::import::error::UrdfError;
use crate::import::inertia::joined;
use crate::import::mjcf::compiler::{Compiler, FromGeoms};
use crate::import::mjcf::defaults::{Defaults, Element, elements};
use crate::import::mjcf::joints::joint;
use crate::import::mjcf::shapes;
use crate::import::pose::Pose;
use crate::import::robot::{Inertial, Joint, Kind, Link, Robot, WORLD};

/// A body: the link that has its mass, and where its frame is.
#[derive(Clone, Debug)]
pub(super) struct Body {
    pub(super) link: String,
    /// The pose of the body in the link.
    pub(super) in_link: Pose,
    /// The pose of the body in the world, in the position of the file.
    pub(super) in_world: Pose,
}

/// The bodies read so far.
pub(super) struct Bodies<'e, 'a, 'd> {
    defaults: &'e Defaults<'a, 'd>,
    compiler: &'e Compiler,
    pub(super) robot: Robot,
    /// The bodies that have names.
    pub(super) named: HashMap<String, Body>,
    /// The names of links, in the file or chosen.
    links: HashSet<String>,
    /// The names of joints, in the file or chosen.
    joints: HashSet<String>,
    contacts: bool,
}

/// An element that remains to be read, with what surrounds it.
struct Open<'d> {
    node: Node<'d, 'd>,
    parent: Body,
    parent_is_world: bool,
    /// The pose of the frames around it, in the parent.
    frame: Pose,
    class: Option<String>,
}

impl<'e, 'a, 'd> Bodies<'e, 'a, 'd> {
    pub(super) fn new(
        defaults: &'e Defaults<'a, 'd>,
        compiler: &'e Compiler,
        root: Node<'d, 'd>,
    ) -> Bodies<'e, 'a, 'd> {
        let names = |tags: &[&str]| {
            let all = root.descendants().filter(|node| tags.contains(&node.tag_name().name()));
            all.filter_map(|node| node.attribute("name")).map(str::to_owned).collect::<HashSet<String>>()
        };
        let (mut links, joints) = (names(&["body"]), names(&["joint", "freejoint"]));
        links.insert(WORLD.to_owned());
        let robot = Robot { links: vec![Link::world()], ..Robot::default() };
        let world = Body { link: WORLD.to_owned(), in_link: Pose::default(), in_world: Pose::default() };
        let named = HashMap::from([(WORLD.to_owned(), world)]);
        Bodies { defaults, compiler, robot, named, links, joints, contacts: false }
    }

    /// Reads everything in `<worldbody>`, bodies in the order of the file.
    pub(super) fn read(&mut self, world: Node<'d, 'd>) -> Result<(), UrdfError> {
        let parent = self.named[WORLD].clone();
        let class = world.attribute("childclass").map(str::to_owned);
        let mut open = Vec::new();
        self.add(
            &mut open,
            world,
            &Open { node: world, parent, parent_is_world: true, frame: Pose::default(), class },
        )?;
        while let Some(next) = open.pop() {
            match next.node.tag_name().name() {
                "body" => self.body(&mut open, next)?,
                _ => {
                    let element = self.defaults.element(next.node, next.class.as_deref())?;
                    let frame = next.frame.then(&self.compiler.pose(&element)?);
                    let class = next.node.attribute("childclass").map(str::to_owned).or(next.class);
                    self.add(&mut open, next.node, &Open { frame, class, ..next })?;
                }
            }
        }
        Ok(())
    }

    /// Adds the bodies and frames in an element to what remains to be read.
    fn add(&self, open: &mut Vec<Open<'d>>, node: Node<'d, 'd>, around: &Open<'d>) -> Result<(), UrdfError> {
        let place = open.len();
        for child in elements(node) {
            match child.tag_name().name() {
                "body" | "frame" => open.push(Open {
                    node: child,
                    parent: around.parent.clone(),
                    parent_is_world: around.parent_is_world,
                    frame: around.frame,
                    class: around.class.clone(),
                }),
                "geom" | "site" | "camera" | "light" => {}
                "joint" | "freejoint" | "inertial" if node.has_tag_name("body") => {}
                "plugin" => {
                    let message = "<plugin> has no place in a model";
                    return Err(self.defaults.xml.wrong(child, message, "leave the plugin out"));
                }
                other => {
                    let message = format!("<{other}> has no place in <{}>", node.tag_name().name());
                    return Err(self.defaults.xml.wrong(
                        child,
                        message,
                        "joints and masses are those of a <body>",
                    ));
                }
            }
        }
        open[place..].reverse();
        Ok(())
    }

    /// Reads a body: its chain of joints, its mass, and what is in it.
    fn body(&mut self, open: &mut Vec<Open<'d>>, next: Open<'d>) -> Result<(), UrdfError> {
        let Open { node, parent, parent_is_world, frame, class } = next;
        let xml = self.defaults.xml;
        let class = node.attribute("childclass").map(str::to_owned).or(class);
        let element = self.defaults.element(node, class.as_deref())?;
        let place = frame.then(&self.compiler.pose(&element)?);
        let name =
            chosen(node.attribute("name"), format!("body_{}", self.robot.links.len()), &mut self.links);
        if self.named.contains_key(&name) {
            let message = format!("there are two bodies called `{name}`");
            return Err(xml.wrong(node, message, "rename one of them"));
        }
        let joints: Vec<Node<'d, 'd>> =
            elements(node).filter(|child| matches!(child.tag_name().name(), "joint" | "freejoint")).collect();
        let in_world = parent.in_world.then(&place);
        // The pose of the body in the link reached so far.
        let mut at = parent.in_link.then(&place);
        let mut link = parent.link;
        for (index, node) in joints.iter().enumerate() {
            let element = self.defaults.element(*node, class.as_deref())?;
            let (mut joint, position) = joint(xml, self.compiler, &element)?;
            if joint.kind == Kind::Floating && !(parent_is_world && joints.len() == 1) {
                let help = "it is the only joint of a body in <worldbody>";
                return Err(xml.wrong(*node, "a free joint has no place here", help));
            }
            let otherwise = if joints.len() == 1 { name.clone() } else { format!("{name}_{}", index + 1) };
            joint.name = chosen(node.attribute("name"), otherwise, &mut self.joints);
            if self.robot.joints.iter().any(|known| known.name == joint.name) {
                let message = format!("there are two joints called `{}`", joint.name);
                return Err(xml.wrong(*node, message, "rename one of them"));
            }
            if joint.reference != 0.0 {
                let (joined, reference) = (&joint.name, rounded(joint.reference));
                let remark = format!(
                    "the coordinate of the joint `{joined}` is that of MuJoCo less its `ref`, {reference}"
                );
                joint.remarks.push(remark);
            }
            if joint.stiffness != 0.0 && !joint.kind.is_single() {
                self.robot.notes.push(format!("the stiffness of the joint `{}` is left out", joint.name));
            }
            let is_last = index + 1 == joints.len();
            joint.child = match is_last {
                true => name.clone(),
                false => chosen(None, format!("{name}_{}", joint.name), &mut self.links),
            };
            joint.parent = std::mem::replace(&mut link, joint.child.clone());
            joint.origin = at.then(&Pose::at(position));
            at = Pose::at(position).inverse();
            if !is_last {
                self.robot.links.push(Link::empty(&joint.child, xml.tag(*node)));
            }
            self.robot.joints.push(joint);
        }
        if joints.is_empty() {
            let fixed = Joint {
                name: chosen(None, format!("{name}_fixed"), &mut self.joints),
                span: xml.tag(node),
                parent: std::mem::replace(&mut link, name.clone()),
                child: name.clone(),
                origin: at,
                ..Joint::default()
            };
            at = Pose::default();
            self.robot.joints.push(fixed);
        }
        let inertial = self.inertial(node, class.as_deref())?.map(|mut inertial| {
            inertial.origin = at.then(&inertial.origin);
            inertial
        });
        self.robot.links.push(Link { inertial, ..Link::empty(&name, xml.tag(node)) });
        for (key, what) in [("gravcomp", "the compensation of gravity"), ("mocap", "the motion from outside")]
        {
            if node.attribute(key).is_some_and(|value| value != "0" && value != "false") {
                self.robot.notes.push(format!("{what} of the body `{name}` is left out"));
            }
        }
        let body = Body { link, in_link: at, in_world };
        self.named.insert(name, body.clone());
        self.add(
            open,
            node,
            &Open { node, parent: body, parent_is_world: false, frame: Pose::default(), class },
        )
    }

    /// The mass of a body: that of its `<inertial>`, or that of its geoms, those in frames included.
    fn inertial(&mut self, node: Node<'d, 'd>, class: Option<&str>) -> Result<Option<Inertial>, UrdfError> {
        let own = elements(node).find(|child| child.has_tag_name("inertial"));
        let mut parts = Vec::new();
        let uses_geoms = match self.compiler.inertia_from_geoms {
            FromGeoms::Always => true,
            FromGeoms::Never => false,
            FromGeoms::WithoutInertial => own.is_none(),
        };
        let mut open = vec![(node, Pose::default(), class.map(str::to_owned))];
        while let Some((outer, frame, class)) = open.pop() {
            for child in elements(outer) {
                match child.tag_name().name() {
                    "geom" => {
                        let geom = self.defaults.element(child, class.as_deref())?;
                        let is = |key| geom.text(key).is_none_or(|value| value.trim() != "0");
                        self.contacts |= is("contype") || is("conaffinity");
                        if uses_geoms && let Some(mut part) = shapes::inertial(self.compiler, &geom)? {
                            part.origin = frame.then(&part.origin);
                            parts.push(part);
                        }
                    }
                    "frame" => {
                        let element = self.defaults.element(child, class.as_deref())?;
                        let inner = frame.then(&self.compiler.pose(&element)?);
                        open.push((
                            child,
                            inner,
                            child.attribute("childclass").map(str::to_owned).or(class.clone()),
                        ));
                    }
                    _ => {}
                }
            }
        }
        match own.filter(|_| !uses_geoms) {
            Some(own) => self.given(&self.defaults.element(own, None)?).map(Some),
            None => Ok(joined(&parts)),
        }
    }

    /// The mass that `<inertial>` gives.
    fn given(&self, element: &Element<'_, '_, 'd>) -> Result<Inertial, UrdfError> {
        let xml = self.defaults.xml;
        let mass = xml.number(element.node, "mass")?;
        if mass < 0.0 {
            return Err(element.wrong("mass", format!("the mass is {mass}"), "a mass is not negative"));
        }
        let inertia = match (element.list("fullinertia")?.as_deref(), element.vector("diaginertia")?) {
            (Some(&[xx, yy, zz, xy, xz, yz]), None) => [xx, yy, zz, xy, yz, xz],
            (Some(_), None) => {
                let help = "write Ixx Iyy Izz Ixy Ixz Iyz";
                return Err(element.wrong("fullinertia", "these are not six numbers", help));
            }
            (Some(_), Some(_)) => {
                return Err(element.wrong("diaginertia", "there is `fullinertia`, too", "give one of them"));
            }
            (None, Some([xx, yy, zz])) => [xx, yy, zz, 0.0, 0.0, 0.0],
            (None, None) => [0.0; 6],
        };
        Ok(Inertial { origin: self.compiler.pose(element)?, mass, inertia })
    }

    /// Whether geoms may touch each other.
    pub(super) fn have_contacts(&self) -> bool {
        self.contacts
    }
}

/// The name in the file, or else another one that is not taken.
fn chosen(given: Option<&str>, otherwise: String, taken: &mut HashSet<String>) -> String {
    if let Some(given) = given {
        return given.to_owned();
    }
    let mut name = otherwise;
    while !taken.insert(name.clone()) {
        name.push('_');
    }
    name
}

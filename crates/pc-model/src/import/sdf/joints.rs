//! The joints of a model.

use std::f64::consts::TAU;
use std::ops::Range;

use roxmltree::Node;

use crate::import::error::UrdfError;
use crate::import::pose::{Pose, applied, tidy, transposed};
use crate::import::robot::{Joint, Kind, Mimic, WORLD};
use crate::import::sdf::content::Content;
use crate::import::sdf::frames::Frames;
use crate::import::xml::child;

/// A joint as read.
pub(super) struct Parsed {
    pub(super) name: String,
    pub(super) span: Range<usize>,
    pub(super) kind: Kind,
    /// The links that it joins; the parent may be the world.
    pub(super) parent: String,
    pub(super) child: String,
    /// Its pose in the model.
    pub(super) place: Pose,
    pub(super) axes: Vec<Axis>,
    /// The advance of a screw per radian.
    pub(super) pitch: f64,
}

/// An axis of a joint.
#[derive(Clone, Debug)]
pub(super) struct Axis {
    /// Its direction in the joint.
    pub(super) axis: [f64; 3],
    limits: Vec<(&'static str, f64)>,
    pub(super) damping: f64,
    friction: f64,
    pub(super) stiffness: f64,
    rest: f64,
    mimic: Option<Mimic>,
}

impl Parsed {
    /// Whether it can close a loop.
    pub(super) fn can_close(&self) -> bool {
        match self.kind {
            Kind::Fixed | Kind::Spherical => true,
            Kind::Revolute | Kind::Continuous => self.axes.len() == 1,
            _ => false,
        }
    }

    /// Its element in the model.
    pub(super) fn node<'d>(&self, model: Node<'d, 'd>) -> Node<'d, 'd> {
        let mut joints = model.children().filter(|node| node.has_tag_name("joint"));
        joints.find(|node| node.attribute("name") == Some(&self.name)).unwrap_or(model)
    }
}

impl Axis {
    /// The joint with this axis, and what acts along it.
    pub(super) fn on(&self, joint: Joint, prefix: &str) -> Joint {
        let mimic = self.mimic.clone();
        Joint {
            axis: self.axis,
            limits: self.limits.clone(),
            damping: self.damping,
            friction: self.friction,
            stiffness: self.stiffness,
            rest: self.rest,
            mimic: mimic.map(|mimic| Mimic { joint: format!("{prefix}{}", mimic.joint), ..mimic }),
            ..joint
        }
    }
}

/// Reads a joint.
pub(super) fn joint<'d>(
    xml: &Content<'_>,
    frames: &Frames<'_, '_, 'd>,
    node: Node<'d, 'd>,
) -> Result<Parsed, UrdfError> {
    let name = xml.xml.text(node, "name")?;
    let word = xml.xml.text(node, "type")?;
    let (kind, count) = match word.as_str() {
        "revolute" => (Kind::Revolute, 1),
        "continuous" => (Kind::Continuous, 1),
        "prismatic" => (Kind::Prismatic, 1),
        "screw" => (Kind::Screw, 1),
        "ball" => (Kind::Spherical, 0),
        "fixed" => (Kind::Fixed, 0),
        "universal" | "revolute2" => (Kind::Revolute, 2),
        _ => {
            let message = format!("a joint of type `{word}` has no place here");
            let help =
                "the types are revolute, continuous, prismatic, screw, ball, universal, revolute2, fixed";
            return Err(xml.xml.wrong_value(node, "type", message, help));
        }
    };
    let end = |which: &str| {
        let end = child(node, which).ok_or_else(|| {
            xml.xml.wrong(node, format!("it has no <{which}>"), "a joint has a <parent> and a <child>")
        })?;
        Ok::<_, UrdfError>((xml.text(end)?, end))
    };
    let (parent, child_end) = (end("parent")?, end("child")?);
    let parent = match parent.0 {
        WORLD => WORLD.to_owned(),
        frame => frames.link(frame, parent.1)?,
    };
    let place = frames.pose(&name, node)?;
    let axes = ["axis", "axis2"].into_iter().take(count);
    let axes = axes.map(|which| axis(xml, frames, node, which, &place)).collect::<Result<Vec<_>, _>>()?;
    Ok(Parsed {
        span: xml.xml.tag(node),
        kind,
        child: frames.link(child_end.0, child_end.1)?,
        parent,
        place,
        axes,
        pitch: if kind == Kind::Screw { pitch(xml, node)? } else { 0.0 },
        name,
    })
}

/// The advance of a screw per radian: right-handed by `screw_thread_pitch` in lengths per turn, left-handed
/// by `thread_pitch` in radians per length.
fn pitch(xml: &Content<'_>, node: Node<'_, '_>) -> Result<f64, UrdfError> {
    if let Some(pitch) = child(node, "screw_thread_pitch") {
        return Ok(xml.number(pitch)? / TAU);
    }
    let Some(pitch) = child(node, "thread_pitch") else {
        return Err(xml.xml.wrong(node, "the screw has no pitch", "write <screw_thread_pitch>"));
    };
    match xml.number(pitch)? {
        0.0 => Err(xml.xml.wrong(pitch, "the pitch is 0", "write <screw_thread_pitch>, in lengths per turn")),
        turns => Ok(-1.0 / turns),
    }
}

fn axis<'d>(
    xml: &Content<'_>,
    frames: &Frames<'_, '_, 'd>,
    joint: Node<'d, 'd>,
    which: &str,
    place: &Pose,
) -> Result<Axis, UrdfError> {
    let Some(node) = child(joint, which) else {
        return Err(xml.xml.wrong(
            joint,
            format!("it has no <{which}>"),
            "write <axis><xyz>0 0 1</xyz></axis>",
        ));
    };
    let mut axis = [0.0, 0.0, 1.0];
    if let Some(direction) = child(node, "xyz") {
        axis = xml.vector(direction)?;
        if axis == [0.0; 3] {
            let help = "give it a direction, such as `0 0 1`";
            return Err(xml.xml.wrong(direction, "the axis has length 0", help));
        }
        let frame = direction.attribute("expressed_in").filter(|frame| !frame.is_empty());
        let in_model = child(node, "use_parent_model_frame").is_some_and(|node| xml.is_true(node));
        let frame = if in_model { Some("__model__") } else { frame };
        if let Some(frame) = frame.filter(|frame| joint.attribute("name") != Some(*frame)) {
            let turned = applied(&frames.pose(frame, direction)?.rotation(), axis);
            axis = tidy(applied(&transposed(&place.rotation()), turned));
        }
    }
    let mut limits = Vec::new();
    for (key, none) in [("lower", -1e16), ("upper", 1e16), ("effort", -1.0), ("velocity", -1.0)] {
        if let Some(limit) = child(node, "limit").and_then(|limit| child(limit, key)) {
            let word = limit.text().unwrap_or_default().trim().trim_start_matches('-');
            if matches!(word, "inf" | "INF" | "Inf" | "infinity") {
                continue;
            }
            let value = xml.number(limit)?;
            if value != none {
                limits.push((key, value));
            }
        }
    }
    let dynamics = |key: &str| {
        let dynamics = child(node, "dynamics").and_then(|dynamics| child(dynamics, key));
        dynamics.map_or(Ok(0.0), |node| xml.number(node))
    };
    Ok(Axis {
        axis,
        limits,
        damping: dynamics("damping")?,
        friction: dynamics("friction")?,
        stiffness: dynamics("spring_stiffness")?,
        rest: dynamics("spring_reference")?,
        mimic: child(node, "mimic").map(|mimic| mimicked(xml, mimic)).transpose()?,
    })
}

/// x = multiplier (other − reference) + offset
fn mimicked(xml: &Content<'_>, node: Node<'_, '_>) -> Result<Mimic, UrdfError> {
    let number = |key: &str, otherwise: f64| child(node, key).map_or(Ok(otherwise), |node| xml.number(node));
    let (multiplier, offset) = (number("multiplier", 1.0)?, number("offset", 0.0)?);
    let offset = offset - multiplier * number("reference", 0.0)?;
    if node.attribute("axis").is_some_and(|axis| axis != "axis") {
        let help = "mimic a joint with one axis";
        return Err(xml.xml.wrong_value(node, "axis", "a second axis cannot be mimicked here", help));
    }
    Ok(Mimic { joint: xml.xml.text(node, "joint")?, multiplier, offset })
}

//! The contents of elements of SDF.

use std::ops::Range;

use roxmltree::Node;

use crate::import::error::UrdfError;
use crate::import::pose::{Pose, of_quaternion};
use crate::import::xml::{Reader, child, numbers};

/// What reads the contents of elements.
pub(super) struct Content<'a> {
    pub(super) xml: Reader<'a>,
}

impl Content<'_> {
    /// Checks that the version is one whose poses and axes are in the frames that are known here.
    pub(super) fn check_version(&self, root: Node<'_, '_>) -> Result<(), UrdfError> {
        let text = self.xml.text(root, "version")?;
        let parts: Option<Vec<u32>> = text.trim().split('.').map(|part| part.parse().ok()).collect();
        match parts.as_deref() {
            Some([1, minor, ..]) if *minor >= 5 => Ok(()),
            _ => {
                let message = format!("the version {text} of SDF is not known here");
                Err(self.xml.wrong_value(root, "version", message, "the versions are 1.5 and later"))
            }
        }
    }

    /// The bytes of the text of an element, or else of its tag.
    fn span(&self, node: Node<'_, '_>) -> Range<usize> {
        node.first_child().filter(Node::is_text).map_or_else(|| self.xml.tag(node), |text| text.range())
    }

    /// The text of an element.
    pub(super) fn text<'d>(&self, node: Node<'d, '_>) -> Result<&'d str, UrdfError> {
        let text = node.text().map(str::trim).filter(|text| !text.is_empty());
        text.ok_or_else(|| self.xml.wrong(node, "it is empty", "write a name"))
    }

    /// The number in an element.
    pub(super) fn number(&self, node: Node<'_, '_>) -> Result<f64, UrdfError> {
        let text = node.text().unwrap_or_default().trim();
        match text.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => {
                let message = format!("`{text}` is not a finite number");
                Err(self.xml.error(self.span(node), node, message, "write a number such as `0.5`"))
            }
        }
    }

    /// Three numbers in an element.
    pub(super) fn vector(&self, node: Node<'_, '_>) -> Result<[f64; 3], UrdfError> {
        let text = node.text().unwrap_or_default().trim();
        match numbers(text).and_then(|numbers| <[f64; 3]>::try_from(numbers).ok()) {
            Some(vector) => Ok(vector),
            None => {
                let message = format!("`{text}` is not three numbers");
                let help = "write three numbers with spaces between them, such as `0 0 1`";
                Err(self.xml.error(self.span(node), node, message, help))
            }
        }
    }

    /// Whether an element contains `true` or 1.
    pub(super) fn is_true(&self, node: Node<'_, '_>) -> bool {
        matches!(node.text().map(str::trim), Some("true" | "1"))
    }

    /// The `<pose>` in an element, and the frame in which it is given, if it is named.
    pub(super) fn pose<'d>(&self, node: Node<'d, 'd>) -> Result<(Pose, Option<&'d str>), UrdfError> {
        let Some(pose) = child(node, "pose") else { return Ok((Pose::default(), None)) };
        if pose.attribute("frame").is_some_and(|frame| !frame.is_empty()) {
            let help = "write `relative_to`, and the version 1.7";
            return Err(self.xml.wrong_value(pose, "frame", "`frame` has no place here", help));
        }
        let text = pose.text().unwrap_or_default().trim();
        let is_quaternion = pose.attribute("rotation_format") == Some("quat_xyzw");
        let unit = if pose.attribute("degrees") == Some("true") { 1_f64.to_radians() } else { 1.0 };
        let numbers = if text.is_empty() { Some(vec![0.0; 6]) } else { numbers(text) };
        let found = match (numbers.as_deref(), is_quaternion) {
            (Some(&[x, y, z, a, b, c, d]), true) if [a, b, c, d] != [0.0; 4] => {
                Pose::new([x, y, z], &of_quaternion([a, b, c, d]))
            }
            (Some(&[x, y, z, roll, pitch, yaw]), false) => {
                Pose { xyz: [x, y, z], rpy: [roll, pitch, yaw].map(|angle| angle * unit) }
            }
            _ => {
                let help = "write six numbers x y z roll pitch yaw, or x y z and a quaternion x y z w";
                return Err(self.xml.error(self.span(pose), pose, format!("`{text}` is no pose"), help));
            }
        };
        Ok((found, pose.attribute("relative_to").filter(|frame| !frame.is_empty())))
    }
}

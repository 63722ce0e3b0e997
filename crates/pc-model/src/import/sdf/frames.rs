//! The frames of a model: of links, joints, and those that have names of their own.

use std::collections::HashMap;

use roxmltree::Node;

use crate::import::error::UrdfError;
use crate::import::pose::Pose;
use crate::import::sdf::content::Content;
use crate::import::xml::child;

/// The name of the frame of the model itself.
const MODEL: &str = "__model__";

/// The elements that have frames, by name.
pub(super) struct Frames<'e, 'a, 'd> {
    xml: &'e Content<'a>,
    nodes: HashMap<String, Node<'d, 'd>>,
}

impl<'e, 'a, 'd> Frames<'e, 'a, 'd> {
    pub(super) fn of(xml: &'e Content<'a>, model: Node<'d, 'd>) -> Result<Frames<'e, 'a, 'd>, UrdfError> {
        let mut nodes = HashMap::new();
        let all =
            model.children().filter(|node| matches!(node.tag_name().name(), "link" | "joint" | "frame"));
        for node in all.filter(Node::is_element) {
            let name = xml.xml.text(node, "name")?;
            if nodes.insert(name.clone(), node).is_some() {
                let message = format!("there are two elements called `{name}`");
                return Err(xml.xml.wrong(node, message, "links, joints and frames have names of their own"));
            }
        }
        Ok(Frames { xml, nodes })
    }

    /// The frame in which the pose of an element is given where it does not say so.
    fn surrounding(&self, node: Node<'d, 'd>) -> Result<String, UrdfError> {
        Ok(match node.tag_name().name() {
            "joint" => {
                let child = child(node, "child").ok_or_else(|| {
                    self.xml.xml.wrong(node, "it has no <child>", "a joint has a <parent> and a <child>")
                })?;
                self.xml.text(child)?.to_owned()
            }
            "frame" => node.attribute("attached_to").unwrap_or(MODEL).to_owned(),
            _ => MODEL.to_owned(),
        })
    }

    fn find(&self, name: &str, from: Node<'_, '_>) -> Result<Node<'d, 'd>, UrdfError> {
        self.nodes.get(name).copied().ok_or_else(|| {
            let message = format!("there is no frame `{name}` in this model");
            self.xml.xml.wrong(from, message, "name a link, a joint or a frame of the model, or `__model__`")
        })
    }

    /// The pose of a frame in the model, in the position of the file; `from` is the element that names it.
    pub(super) fn pose(&self, name: &str, from: Node<'d, 'd>) -> Result<Pose, UrdfError> {
        let (mut pose, mut name, mut from) = (Pose::default(), name.to_owned(), from);
        let mut seen = Vec::new();
        while name != MODEL {
            if seen.contains(&name) {
                let message = format!("the pose of `{name}` is given in terms of itself");
                return Err(self.xml.xml.wrong(from, message, "give one of the poses in `__model__`"));
            }
            let node = self.find(&name, from)?;
            let (own, relative) = self.xml.pose(node)?;
            pose = own.then(&pose);
            seen.push(name);
            name = match relative {
                Some(frame) => frame.to_owned(),
                None => self.surrounding(node)?,
            };
            from = node;
        }
        Ok(pose)
    }

    /// The link to which a frame is attached.
    pub(super) fn link(&self, name: &str, from: Node<'d, 'd>) -> Result<String, UrdfError> {
        let (mut name, mut from) = (name.to_owned(), from);
        for _ in 0..=self.nodes.len() {
            let node = self.find(&name, from)?;
            if node.has_tag_name("link") {
                return Ok(name);
            }
            name = self.surrounding(node)?;
            from = node;
        }
        let message = format!("`{name}` is attached to itself by others");
        Err(self.xml.xml.wrong(from, message, "attach a frame to a link"))
    }
}

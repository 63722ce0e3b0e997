//! The attributes of elements of MJCF, with the defaults of their classes.

use std::collections::HashMap;

use roxmltree::Node;

use crate::import::error::UrdfError;
use crate::import::xml::{Reader, numbers};

/// The elements of `<actuator>`: a class has one set of defaults for all of them.
pub(super) const ACTUATORS: &[&str] = &[
    "general",
    "motor",
    "position",
    "velocity",
    "intvelocity",
    "damper",
    "cylinder",
    "muscle",
    "adhesion",
    "dcmotor",
];

/// A class of defaults: the class from which it inherits, and its element `<default>`.
struct Class<'d> {
    parent: Option<String>,
    node: Node<'d, 'd>,
}

/// The classes of defaults, with the reader of attributes.
pub(super) struct Defaults<'a, 'd> {
    pub(super) xml: &'a Reader<'a>,
    classes: HashMap<String, Class<'d>>,
}

impl<'a, 'd> Defaults<'a, 'd> {
    /// The classes of a document.
    pub(super) fn of(xml: &'a Reader<'a>, root: Node<'d, 'd>) -> Result<Defaults<'a, 'd>, UrdfError> {
        let mut classes: HashMap<String, Class<'d>> = HashMap::new();
        let mut open: Vec<(Node<'d, 'd>, Option<String>)> =
            elements(root).filter(|node| node.has_tag_name("default")).map(|node| (node, None)).collect();
        open.reverse();
        while let Some((node, parent)) = open.pop() {
            let name = match (node.attribute("class"), &parent) {
                (Some(name), _) => name.to_owned(),
                (None, None) => "main".to_owned(),
                (None, Some(_)) => {
                    return Err(xml.wrong(node, "the class has no name", "write <default class=\"…\">"));
                }
            };
            let name = if parent.is_none() { "main".to_owned() } else { name };
            let inner = elements(node).filter(|child| child.has_tag_name("default"));
            let mut inner: Vec<_> = inner.map(|child| (child, Some(name.clone()))).collect();
            inner.reverse();
            open.extend(inner);
            if classes.insert(name.clone(), Class { parent, node }).is_some() {
                let message = format!("there are two classes called `{name}`");
                return Err(xml.wrong(node, message, "rename one of them"));
            }
        }
        Ok(Defaults { xml, classes })
    }

    /// An element with the class that its attribute `class`, or else `childclass` of a body around it, names.
    pub(super) fn element(
        &self,
        node: Node<'d, 'd>,
        child_class: Option<&str>,
    ) -> Result<Element<'_, 'a, 'd>, UrdfError> {
        let class = node.attribute("class").or(child_class).unwrap_or("main").to_owned();
        if class != "main" && !self.classes.contains_key(&class) {
            let key = if node.has_attribute("class") { "class" } else { "childclass" };
            let message = format!("there is no class `{class}` of defaults");
            return Err(self.xml.wrong_value(node, key, message, "declare it in <default>"));
        }
        Ok(Element { defaults: self, node, class })
    }
}

/// An element with its class.
pub(super) struct Element<'e, 'a, 'd> {
    defaults: &'e Defaults<'a, 'd>,
    pub(super) node: Node<'d, 'd>,
    class: String,
}

impl<'d> Element<'_, '_, 'd> {
    /// The elements in which an attribute may stand: this one, then the defaults of its class, of the class
    /// from which that inherits, and so on.
    fn sources(&self) -> impl Iterator<Item = Node<'d, 'd>> {
        let tag = self.node.tag_name().name();
        let is_actuator = ACTUATORS.contains(&tag);
        let mut sources = vec![self.node];
        let mut class = self.defaults.classes.get(&self.class);
        while let Some(Class { parent, node }) = class {
            // Of several elements in one class the last one counts.
            let mut own: Vec<Node<'d, 'd>> = elements(*node)
                .filter(|child| {
                    let name = child.tag_name().name();
                    name == tag || is_actuator && ACTUATORS.contains(&name)
                })
                .collect();
            own.reverse();
            sources.extend(own);
            class = parent.as_ref().and_then(|parent| self.defaults.classes.get(parent));
        }
        sources.into_iter()
    }

    /// The element in which an attribute stands, if there is one.
    pub(super) fn source(&self, key: &str) -> Option<Node<'d, 'd>> {
        self.sources().find(|node| node.has_attribute(key))
    }

    /// The first element in which one of several attributes stands, with that attribute.
    pub(super) fn either<'k>(&self, keys: &[&'k str]) -> Option<(Node<'d, 'd>, &'k str)> {
        self.sources().find_map(|node| Some((node, *keys.iter().find(|key| node.has_attribute(**key))?)))
    }

    /// The text of an attribute.
    pub(super) fn text(&self, key: &str) -> Option<&'d str> {
        self.source(key).and_then(|node| node.attribute(key))
    }

    /// The number in an attribute, if there is one.
    pub(super) fn number(&self, key: &str) -> Result<Option<f64>, UrdfError> {
        self.source(key).map(|node| self.defaults.xml.number(node, key)).transpose()
    }

    /// Three numbers in an attribute, if there is one.
    pub(super) fn vector(&self, key: &str) -> Result<Option<[f64; 3]>, UrdfError> {
        match self.source(key) {
            Some(node) => self.defaults.xml.vector(node, key),
            None => Ok(None),
        }
    }

    /// The numbers in an attribute, if there is one.
    pub(super) fn list(&self, key: &str) -> Result<Option<Vec<f64>>, UrdfError> {
        let Some(node) = self.source(key) else { return Ok(None) };
        let text = node.attribute(key).unwrap_or_default();
        match numbers(text) {
            Some(list) => Ok(Some(list)),
            None => {
                let message = format!("`{text}` is not a list of numbers");
                Err(self.defaults.xml.wrong_value(
                    node,
                    key,
                    message,
                    "write numbers with spaces between them",
                ))
            }
        }
    }

    /// An error about the value of an attribute.
    pub(super) fn wrong(&self, key: &str, message: impl Into<String>, help: &str) -> UrdfError {
        let node = self.source(key).unwrap_or(self.node);
        self.defaults.xml.wrong_value(node, key, message, help)
    }
}

/// The elements in an element.
pub(super) fn elements<'d>(node: Node<'d, 'd>) -> impl Iterator<Item = Node<'d, 'd>> {
    node.children().filter(Node::is_element)
}

//! Reads elements and attributes of XML, with the place in the file in every error.

use std::ops::Range;

use roxmltree::{Document, Error, Node, ParsingOptions};

use crate::diagnostics::source::Source;
use crate::import::error::UrdfError;

/// The document in a file. A document type is read, with the entities that it declares; nothing is read from
/// other files.
///
/// # Errors
/// [`UrdfError`] where the text is not XML.
pub(crate) fn parse(source: &Source) -> Result<Document<'_>, UrdfError> {
    let text = source.text();
    let options = ParsingOptions { allow_dtd: true, ..ParsingOptions::default() };
    Document::parse_with_options(text, options).map_err(|error| {
        let at = error.pos();
        let line = text.split_inclusive('\n').take(at.row as usize - 1).map(str::len).sum::<usize>();
        let column = text[line..].char_indices().nth(at.col as usize - 1).map_or(0, |(column, _)| column);
        let place = (line + column).min(text.len());
        if let Error::UnknownNamespace(prefix, _) = &error
            && prefix == "xacro"
        {
            let tag = text[place..].find(['>', '/', ' ', '\n', '\t']).map_or(text.len(), |tag| place + tag);
            return UrdfError::at(source, place..tag, "", "it is a macro of xacro", EXPAND);
        }
        UrdfError::at(
            source,
            place..place,
            "",
            format!("not valid XML: {error}"),
            "the formats that can be imported are XML",
        )
    })
}

/// How macros of xacro are expanded.
pub(crate) const EXPAND: &str = "expand the macros first: `xacro robot.xacro > robot.urdf`";

/// What reads the elements of a file.
pub(crate) struct Reader<'a> {
    pub(crate) source: &'a Source,
}

impl Reader<'_> {
    /// An error about bytes of an element.
    pub(crate) fn error(
        &self,
        span: Range<usize>,
        node: Node<'_, '_>,
        message: impl Into<String>,
        help: &str,
    ) -> UrdfError {
        let name = node.attribute("name").map(|name| format!(" {name}")).unwrap_or_default();
        UrdfError::at(self.source, span, format!("<{}{name}>", node.tag_name().name()), message, help)
    }

    /// An error about an element, which shows its opening tag.
    pub(crate) fn wrong(&self, node: Node<'_, '_>, message: impl Into<String>, help: &str) -> UrdfError {
        self.error(self.tag(node), node, message, help)
    }

    /// An error about the value of an attribute.
    pub(crate) fn wrong_value(
        &self,
        node: Node<'_, '_>,
        key: &str,
        message: impl Into<String>,
        help: &str,
    ) -> UrdfError {
        self.error(self.value_span(node, key), node, message, help)
    }

    /// The bytes of the `<name` with which an element begins.
    pub(crate) fn tag(&self, node: Node<'_, '_>) -> Range<usize> {
        let range = node.range();
        let tag = self.source.slice(range.clone()).find(['>', '/', ' ', '\n', '\t']).unwrap_or(1);
        range.start..range.start + tag
    }

    /// The value of an attribute that has to be there.
    pub(crate) fn text(&self, node: Node<'_, '_>, key: &str) -> Result<String, UrdfError> {
        match node.attribute(key) {
            Some(text) => Ok(text.to_owned()),
            None => Err(self.wrong(
                node,
                format!("it has no `{key}`"),
                &format!("write <{} {key}=\"…\">", node.tag_name().name()),
            )),
        }
    }

    /// The bytes of the value of an attribute; of the tag if there is no such attribute.
    pub(crate) fn value_span(&self, node: Node<'_, '_>, key: &str) -> Range<usize> {
        node.attribute_node(key).map_or_else(|| self.tag(node), |attribute| attribute.range_value())
    }

    /// The number in an attribute that has to be there.
    pub(crate) fn number(&self, node: Node<'_, '_>, key: &str) -> Result<f64, UrdfError> {
        let text = self.text(node, key)?;
        match text.trim().parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => {
                let message = format!("`{text}` is not a finite number");
                Err(self.wrong_value(node, key, message, "write a number such as `0.5`"))
            }
        }
    }

    /// N numbers separated by spaces; none if the attribute is missing.
    pub(crate) fn vector<const N: usize>(
        &self,
        node: Node<'_, '_>,
        key: &str,
    ) -> Result<Option<[f64; N]>, UrdfError> {
        let Some(text) = node.attribute(key) else { return Ok(None) };
        match numbers(text).and_then(|numbers| <[f64; N]>::try_from(numbers).ok()) {
            Some(vector) => Ok(Some(vector)),
            None => {
                let (many, example) = match N {
                    3 => ("three", "0 0 1"),
                    4 => ("four", "0 0 0 1"),
                    _ => ("six", "0 0 1 0 0 0"),
                };
                let message = format!("`{text}` is not {many} numbers");
                let help = format!("write {many} numbers with spaces between them, such as `{example}`");
                Err(self.wrong_value(node, key, message, &help))
            }
        }
    }
}

/// Finite numbers separated by spaces; none if anything else is there.
pub(crate) fn numbers(text: &str) -> Option<Vec<f64>> {
    let numbers: Result<Vec<f64>, _> = text.split_whitespace().map(str::parse::<f64>).collect();
    numbers.ok().filter(|numbers| numbers.iter().all(|number| number.is_finite()))
}

/// The first element of this name in an element.
pub(crate) fn child<'a, 'd>(node: Node<'a, 'd>, name: &str) -> Option<Node<'a, 'd>> {
    node.children().find(|child| child.is_element() && child.tag_name().name() == name)
}

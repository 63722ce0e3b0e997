//! What is left of xacro in a file whose macros have not been expanded.

use roxmltree::{Document, Node};

use crate::import::error::UrdfError;
use crate::import::xml::{EXPAND, Reader};

/// Checks that no element, attribute or text of the document is one of xacro: `<xacro:…>`, `${…}`, `$(…)`.
///
/// # Errors
/// [`UrdfError`] at the first of them.
pub(crate) fn check(xml: &Reader<'_>, document: &Document<'_>) -> Result<(), UrdfError> {
    document.descendants().try_for_each(|node| {
        if node.is_element() {
            return element(xml, node);
        }
        match (node.parent().filter(Node::is_element), node.text().filter(|_| node.is_text())) {
            (Some(parent), Some(text)) => match expression(text) {
                Some(expression) => {
                    let start = node.range().start;
                    let at = xml.source.slice(node.range()).find(expression).unwrap_or(0);
                    let span = start + at..start + at + expression.len();
                    Err(xml.error(span, parent, unexpanded(expression), EXPAND))
                }
                None => Ok(()),
            },
            _ => Ok(()),
        }
    })
}

fn element(xml: &Reader<'_>, node: Node<'_, '_>) -> Result<(), UrdfError> {
    if node.tag_name().namespace().is_some_and(|space| space.contains("xacro")) {
        return Err(xml.wrong(node, "it is a macro of xacro", EXPAND));
    }
    for attribute in node.attributes() {
        if let Some(expression) = expression(attribute.value()) {
            let range = attribute.range_value();
            let at = xml.source.slice(range.clone()).find(expression).unwrap_or(0);
            let span = range.start + at..(range.start + at + expression.len()).min(range.end);
            return Err(xml.error(span, node, unexpanded(expression), EXPAND));
        }
    }
    Ok(())
}

fn unexpanded(expression: &str) -> String {
    format!("`{expression}` is an expression of xacro")
}

/// The first `${…}` or `$(…)` of a text.
fn expression(text: &str) -> Option<&str> {
    let starts = text.match_indices(['{', '(']).filter(|(at, _)| text[..*at].ends_with('$'));
    starts.into_iter().find_map(|(at, open)| {
        let end = text[at..].find(if open == "{" { '}' } else { ')' })?;
        Some(&text[at - 1..=at + end])
    })
}

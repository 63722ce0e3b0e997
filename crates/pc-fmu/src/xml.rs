//! Elements of XML and their attributes.

use std::io;

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};

pub(crate) type Xml = Writer<Vec<u8>>;
pub(crate) type Attributes = Vec<(&'static str, String)>;

/// Text of an attribute, without characters that XML has not.
pub(crate) fn text(text: &str) -> String {
    text.chars()
        .map(|c| if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') { ' ' } else { c })
        .collect()
}

pub(crate) fn number(value: f64) -> String {
    format!("{value:?}")
}

/// An element with these attributes and its contents.
pub(crate) fn inside(
    xml: &mut Xml,
    name: &str,
    attributes: &Attributes,
    write: impl FnOnce(&mut Xml) -> io::Result<()>,
) -> io::Result<()> {
    let pairs = attributes.iter().map(|(name, value)| (*name, value.as_str()));
    xml.create_element(name).with_attributes(pairs).write_inner_content(write)?;
    Ok(())
}

pub(crate) fn empty(xml: &mut Xml, name: &str, attributes: &Attributes) -> io::Result<()> {
    let pairs = attributes.iter().map(|(name, value)| (*name, value.as_str()));
    xml.create_element(name).with_attributes(pairs).write_empty()?;
    Ok(())
}

/// A document with one element.
pub(crate) fn document(write: impl FnOnce(&mut Xml) -> io::Result<()>) -> io::Result<Vec<u8>> {
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 2);
    xml.write_event(Event::Decl(BytesDecl::new("1.0", Some("UTF-8"), None)))?;
    write(&mut xml)?;
    let mut bytes = xml.into_inner();
    bytes.push(b'\n');
    Ok(bytes)
}

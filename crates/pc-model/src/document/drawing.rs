//! `[drawing]`: what is left out of the drawing of a model, and which way is up.

use super::reader::{Item, Table};
use crate::diagnostics::error::ModelError;
use crate::diagnostics::error_kind::ErrorKind;
use crate::document::expression::Located;

/// What `[[draw]]` cannot say of the drawing as a whole.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drawing {
    /// Whether nothing is drawn of bodies and points but what `[[draw]]` says.
    pub hides_all: bool,
    /// The bodies and points of which nothing else is drawn.
    pub hide: Vec<Located<String>>,
    /// The direction that is seen as up, along one of the fixed axes; if left out, it follows from gravity and from the motion.
    pub up: Option<[f64; 3]>,
}

const UP: &str = "up = [0, 0, 1]";

impl Drawing {
    /// Whether nothing is drawn of the body or point with this name but what `[[draw]]` says.
    pub fn hides(&self, name: &str) -> bool {
        self.hides_all || self.hide.iter().any(|hidden| hidden.value == name)
    }
}

pub(super) fn drawing(table: &Table<'_>) -> Result<Drawing, ModelError> {
    let mut drawing = Drawing::default();
    for item in table.items() {
        match item.key() {
            "hide" if item.is_boolean() => drawing.hides_all = item.boolean()?.value,
            "hide" => drawing.hide = item.texts("true or a list of names", "[\"NAME\"]")?,
            "up" => drawing.up = Some(up(&item)?),
            _ => return Err(item.unknown(&["hide", "up"])),
        }
    }
    Ok(drawing)
}

/// Two numbers are a direction in the plane of the first two axes.
fn up(item: &Item<'_>) -> Result<[f64; 3], ModelError> {
    let expected = "2 or 3 numbers";
    let given = item.numbers(expected, UP)?;
    if !matches!(given.len(), 2 | 3) {
        return Err(item.error(ErrorKind::WrongLength { expected, found: given.len(), example: UP }));
    }
    if given.iter().filter(|part| **part != 0.0).count() != 1 {
        return Err(item.error(ErrorKind::OutOfRange {
            expected: "a direction along one of the fixed axes",
            found: item.raw().to_owned(),
            example: UP,
        }));
    }
    let sign = |part: &f64| if *part == 0.0 { 0.0 } else { part.signum() };
    Ok([0, 1, 2].map(|k| given.get(k).map_or(0.0, sign)))
}

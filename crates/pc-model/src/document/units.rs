//! `[units]`: the names of the units of quantities. They are labels, which nothing converts or compares.

use crate::diagnostics::error::ModelError;
use crate::diagnostics::error_kind::ErrorKind;
use crate::diagnostics::meaning::MeaningError;
use crate::document::contents::{Document, NamedUnit};
use crate::document::expression::Located;
use crate::document::hidden::is_hidden;
use crate::document::reader::{Item, Table};

/// The most characters of the name of a unit.
const MOST_CHARACTERS: usize = 40;

pub(super) fn units(table: &Table<'_>) -> Result<Vec<NamedUnit>, ModelError> {
    table.items().map(|item| Ok(NamedUnit { quantity: item.new_label()?, unit: unit(&item)? })).collect()
}

fn unit(item: &Item<'_>) -> Result<Located<String>, ModelError> {
    let unit = item.text()?;
    let text = &unit.value;
    let is_name = !text.trim().is_empty()
        && text.chars().count() <= MOST_CHARACTERS
        && !text.contains(|c: char| c.is_control() || is_hidden(c));
    match is_name {
        true => Ok(unit),
        false => Err(item.error(ErrorKind::OutOfRange {
            expected: "the name of a unit, of 1 to 40 visible characters on one line",
            found: format!("{text:?}"),
            example: "ω1 = \"rad/s\"",
        })),
    }
}

/// Checks that units are given to quantities of the model.
pub(super) fn check_units(document: &Document) -> Result<(), ModelError> {
    let known = document.quantities();
    match document.units.iter().find(|given| !known.contains(&given.quantity.text)) {
        Some(given) => {
            let kind = MeaningError::NoQuantity { name: given.quantity.text.clone(), known };
            Err(document.error(&given.quantity.place, kind))
        }
        None => Ok(()),
    }
}

impl Document {
    /// The name of the unit of a quantity, if the text gives one.
    pub fn unit(&self, quantity: &str) -> Option<&str> {
        let given = self.units.iter().find(|given| given.quantity.text == quantity)?;
        Some(&given.unit.value)
    }

    /// The names that may have a unit.
    fn quantities(&self) -> Vec<String> {
        let declared = self.declared_names().into_iter().map(|(name, _)| name.text.clone());
        let velocities = self.coordinates.iter().map(|x| format!("{}'", x.name.text));
        declared.chain(velocities).chain(["t".to_owned(), "energy".to_owned()]).collect()
    }
}

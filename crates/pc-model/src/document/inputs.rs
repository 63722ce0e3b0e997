//! The section of inputs.

use pc_mech::Interpolation;

use super::reader::{Item, Table};
use crate::diagnostics::error::ModelError;
use crate::diagnostics::error_kind::ErrorKind;
use crate::document::contents::{Input, InputValue, TableFile};

const KEYS: &[&str] = &["times", "values", "file", "column", "time", "interpolation"];
const TIMES: &str = "times = [0.0, 1.0], values = [0.0, 2.0]";
const COLUMN: &str = "file = \"x.csv\", column = \"u\"";

pub(super) fn inputs(table: &Table<'_>) -> Result<Vec<Input>, ModelError> {
    table.items().map(|item| Ok(Input { name: item.new_name()?, value: value(&item)? })).collect()
}

fn value(item: &Item<'_>) -> Result<InputValue, ModelError> {
    if !item.is_table() {
        return Ok(InputValue::Constant(item.expression()?));
    }
    let (mut times, mut values, mut file, mut column, mut time) = (None, None, None, None, None);
    let mut interpolation = Interpolation::Linear;
    let table = item.table("a table", "{ times = […], values = […] }")?;
    for part in table.items() {
        match part.key() {
            "times" => times = Some(part.numbers("a list of numbers", "times = [0.0, 1.0]")?),
            "values" => values = Some(part.numbers("a list of numbers", "values = [0.0, 2.0]")?),
            "file" => file = Some((part.text()?, part.clone())),
            "column" => column = Some(part.text()?),
            "time" => time = Some(part.text()?),
            "interpolation" => {
                interpolation = part
                    .choice(&[
                        ("linear", Interpolation::Linear),
                        ("cubic", Interpolation::Cubic),
                        ("hold", Interpolation::Hold),
                    ])?
                    .value;
            }
            _ => return Err(part.unknown(KEYS)),
        }
    }
    let missing = |key, example| Err(table.error(ErrorKind::Missing { key, example }));
    let Some((file, part)) = file else {
        return match (times, values, column.or(time)) {
            (_, _, Some(_)) => missing("file", COLUMN),
            (Some(times), Some(values), None) => {
                Ok(InputValue::Lists { place: table.place.clone(), times, values, interpolation })
            }
            (Some(_), None, None) => missing("values", TIMES),
            (None, _, None) => missing("times", TIMES),
        };
    };
    if times.is_some() || values.is_some() {
        return Err(part.key_error(ErrorKind::Exclusive {
            first: "file",
            second: if times.is_some() { "times" } else { "values" },
            help: "a table is written out, or read from a file",
        }));
    }
    match column {
        Some(column) => Ok(InputValue::File(TableFile { file, column, time, interpolation })),
        None => missing("column", COLUMN),
    }
}

//! The section of inputs.

use pc_mech::{Interpolation, KnownRates};

use super::reader::{Item, Table};
use crate::diagnostics::error::ModelError;
use crate::diagnostics::error_kind::ErrorKind;
use crate::document::contents::{Input, InputValue, TableFile};
use crate::document::expression::Name;

const KEYS: &[&str] = &[
    "times",
    "values",
    "rates",
    "accelerations",
    "file",
    "column",
    "rate",
    "acceleration",
    "time",
    "interpolation",
];
const TIMES: &str = "times = [0.0, 1.0], values = [0.0, 2.0]";
const COLUMN: &str = "file = \"x.csv\", column = \"u\"";
const NUMBERS: &str = "a list of numbers";

/// The inputs, then the rates u' and u'' of those that are curves.
pub(super) fn inputs(table: &Table<'_>) -> Result<Vec<Input>, ModelError> {
    let read = |item: Item<'_>| Ok(Input { name: item.new_name()?, value: value(&item)? });
    let mut inputs: Vec<Input> = table.items().map(read).collect::<Result<_, ModelError>>()?;
    for place in 0..inputs.len() {
        if inputs[place].is_curve() {
            let mut of = place;
            for _ in 0..2 {
                let Name { text, place } = inputs[of].name.clone();
                let name = Name { text: format!("{text}'"), place };
                inputs.push(Input { name, value: InputValue::RateOf(of) });
                of = inputs.len() - 1;
            }
        }
    }
    Ok(inputs)
}

/// The two ways to give a table.
const LISTED: [&str; 4] = ["times", "values", "rates", "accelerations"];

fn value(item: &Item<'_>) -> Result<InputValue, ModelError> {
    if !item.is_table() {
        return Ok(InputValue::Constant(item.expression()?));
    }
    let (mut times, mut values, mut known) = (None, None, KnownRates::default());
    let (mut file, mut column, mut time, mut rate, mut acceleration) = (None, None, None, None, None);
    let mut interpolation = Interpolation::Linear;
    let table = item.table("a table", "{ times = […], values = […] }")?;
    for part in table.items() {
        match part.key() {
            "times" => times = Some(part.numbers(NUMBERS, "times = [0.0, 1.0]")?),
            "values" => values = Some(part.numbers(NUMBERS, "values = [0.0, 2.0]")?),
            "rates" => known.rates = Some(part.numbers(NUMBERS, "rates = [0.0, 0.0]")?),
            "accelerations" => {
                known.accelerations = Some(part.numbers(NUMBERS, "accelerations = [0.0, 0.0]")?);
            }
            "file" => file = Some((part.text()?, part.clone())),
            "column" => column = Some(part.text()?),
            "rate" => rate = Some(part.text()?),
            "acceleration" => acceleration = Some(part.text()?),
            "time" => time = Some(part.text()?),
            "interpolation" => {
                interpolation = part
                    .choice(&[
                        ("linear", Interpolation::Linear),
                        ("cubic", Interpolation::Cubic),
                        ("quintic", Interpolation::Quintic),
                        ("hold", Interpolation::Hold),
                    ])?
                    .value;
            }
            _ => return Err(part.unknown(KEYS)),
        }
    }
    let missing = |key, example| Err(table.error(ErrorKind::Missing { key, example }));
    let Some((file, part)) = file else {
        return match (times, values, column.or(time).or(rate).or(acceleration)) {
            (_, _, Some(_)) => missing("file", COLUMN),
            (Some(times), Some(values), None) => {
                Ok(InputValue::Lists { place: table.place.clone(), times, values, known, interpolation })
            }
            (Some(_), None, None) => missing("values", TIMES),
            (None, _, None) => missing("times", TIMES),
        };
    };
    if let Some(second) = LISTED.into_iter().find(|key| table.items().any(|part| part.key() == *key)) {
        return Err(part.key_error(ErrorKind::Exclusive {
            first: "file",
            second,
            help: "a table is written out, or read from a file",
        }));
    }
    match column {
        Some(column) => {
            Ok(InputValue::File(TableFile { file, column, rate, acceleration, time, interpolation }))
        }
        None => missing("column", COLUMN),
    }
}

//! The sections that say how the motion is followed: events and simulation.

use super::reader::{Item, Table};
use pc_expr::Direction;

use super::{Event, Form, Located, Method, NamedExpression, Simulation};
use crate::error::{ErrorKind, ModelError};

/// More rows than any file should hold.
const MOST_SAMPLES: i64 = 1_000_000_000;

pub(super) fn simulation(table: &Table<'_>) -> Result<Simulation, ModelError> {
    let mut result = Simulation { place: Some(table.place.clone()), ..Simulation::default() };
    for item in table.items() {
        match item.key() {
            "t_start" => result.t_start = Some(item.number()?),
            "t_end" => result.t_end = Some(item.number()?),
            "samples" => result.samples = Some(samples(&item)?),
            "rtol" => result.rtol = Some(tolerance(&item, "rtol = 1e-9")?),
            "atol" => result.atol = Some(tolerance(&item, "atol = 1e-12")?),
            "method" => {
                result.method = Some(item.choice(&[
                    ("bdf", Method::Bdf),
                    ("adams", Method::Adams),
                    ("taylor", Method::Taylor),
                    ("dop853", Method::Dop853),
                    ("auto", Method::Auto),
                ])?);
            }
            "form" => {
                result.form =
                    Some(item.choice(&[("poincare", Form::Poincare), ("canonical", Form::Canonical)])?);
            }
            "project" => result.project = item.texts("a list of names of integrals", "[\"energy\"]")?,
            _ => {
                return Err(item
                    .unknown(&["t_start", "t_end", "samples", "rtol", "atol", "method", "form", "project"]));
            }
        }
    }
    Ok(result)
}

fn samples(item: &Item<'_>) -> Result<Located<usize>, ModelError> {
    let value = item.integer()?.value;
    match usize::try_from(value) {
        Ok(count) if count >= 2 && value <= MOST_SAMPLES => Ok(item.located(count)),
        _ => Err(item.error(ErrorKind::OutOfRange {
            expected: "2 (start and end) to 1000000000 samples",
            found: value.to_string(),
            example: "samples = 101",
        })),
    }
}

fn tolerance(item: &Item<'_>, example: &'static str) -> Result<Located<f64>, ModelError> {
    let number = item.number()?;
    if number.value > 0.0 {
        return Ok(number);
    }
    let found = number.value.to_string();
    Err(item.error(ErrorKind::OutOfRange { expected: "a tolerance greater than 0", found, example }))
}

pub(super) fn events(table: &Table<'_>) -> Result<Vec<Event>, ModelError> {
    table.items().map(|item| event(&item)).collect()
}

fn event(item: &Item<'_>) -> Result<Event, ModelError> {
    let name = item.label();
    let table = item.section(&format!("events.{}", name.text), "[events.NAME]")?;
    let (mut when, mut direction, mut terminal, mut reset) = (None, None, None, Vec::new());
    for part in table.items() {
        match part.key() {
            "when" => when = Some(part.expression()?),
            "direction" => {
                direction = Some(part.choice(&[
                    ("rising", Direction::Rising),
                    ("falling", Direction::Falling),
                    ("both", Direction::Both),
                ])?);
            }
            "terminal" => terminal = Some(part.boolean()?),
            "reset" => reset = resets(&part)?,
            _ => return Err(part.unknown(&["when", "direction", "terminal", "reset"])),
        }
    }
    match when {
        Some(when) => Ok(Event { name, place: table.place, when, direction, terminal, reset }),
        None => Err(table.error(ErrorKind::Missing { key: "when", example: "when = \"…\"" })),
    }
}

fn resets(item: &Item<'_>) -> Result<Vec<NamedExpression>, ModelError> {
    let entries = item.table("a table", "{ name = \"…\" }")?;
    let reset = |entry: Item<'_>| {
        // `x'` is the velocity of a coordinate: the prime stays in the name.
        let name = if entry.velocity().is_some() { entry.label() } else { entry.name()? };
        Ok(NamedExpression { name, expression: entry.expression()? })
    };
    entries.items().map(reset).collect()
}

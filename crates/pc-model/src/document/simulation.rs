//! The sections that describe the run: events and simulation.

use pc_expr::{Direction, Method};

use super::reader::{Item, Table};
use crate::diagnostics::error::ModelError;
use crate::diagnostics::error_kind::ErrorKind;
use crate::document::contents::Event;
use crate::document::expression::{Located, Name, NamedExpression};
use crate::document::run_settings::Simulation;
use crate::document::tolerance::AbsoluteTolerance;
use crate::variables::Variables;

/// The largest number of rows in a table: all rows are held in memory.
pub const MOST_SAMPLES: usize = 10_000_000;

/// The largest number of points in one step at which events are looked for.
const MOST_SAMPLES_PER_STEP: u32 = 10_000;

pub(super) fn simulation(table: &Table<'_>) -> Result<Simulation, ModelError> {
    let mut result = Simulation { place: Some(table.place.clone()), ..Simulation::default() };
    for item in table.items() {
        match item.key() {
            "t_start" => result.t_start = Some(item.number()?),
            "t_end" => result.t_end = Some(item.number()?),
            "samples" => result.samples = Some(samples(&item)?),
            "rtol" => result.rtol = Some(tolerance(&item, "rtol = 1e-9")?),
            "atol" => result.atol = Some(item.located(absolute(&item)?)),
            "max_step" => {
                result.max_step = Some(positive(&item, "a length greater than 0", "max_step = 0.01")?);
            }
            "samples_per_step" => result.samples_per_step = Some(samples_per_step(&item)?),
            "accumulation" => result.accumulation = Some(part(&item)?),
            "method" => {
                result.method = Some(item.choice(&Method::ALL.map(|method| (method.name(), method)))?);
            }
            "form" => {
                result.form = Some(item.choice(&Variables::ALL.map(|form| (form.name(), form)))?);
            }
            "hamel" => result.hamel = hamel(&item)?,
            "independent" => {
                result.independent = item.texts("a list of names of velocities", "[\"v\", \"x'\"]")?;
            }
            "project" => result.project = item.texts("a list of names of integrals", "[\"energy\"]")?,
            _ => {
                return Err(item.unknown(&[
                    "t_start",
                    "t_end",
                    "samples",
                    "rtol",
                    "atol",
                    "max_step",
                    "samples_per_step",
                    "accumulation",
                    "method",
                    "form",
                    "hamel",
                    "independent",
                    "project",
                ]));
            }
        }
    }
    let is_hamel = result.form.as_ref().is_some_and(|form| form.value == Variables::Given);
    match (is_hamel, result.hamel.is_empty()) {
        (true, true) => Err(table.error(ErrorKind::Missing { key: "hamel", example: HAMEL })),
        (false, false) => {
            let (key, example) = ("hamel".to_owned(), "form = \"hamel\"");
            Err(table.error(ErrorKind::NoEffect { key, without: "form", example }))
        }
        _ => Ok(result),
    }
}

const HAMEL: &str = "hamel = { v = \"r*θ'\" }";

fn hamel(item: &Item<'_>) -> Result<Vec<NamedExpression>, ModelError> {
    let entries = item.table("a table of quasi-velocities", "{ v = \"r*θ'\" }")?;
    let given =
        |entry: Item<'_>| Ok(NamedExpression { name: entry.new_name()?, expression: entry.expression()? });
    entries.items().map(given).collect()
}

fn samples(item: &Item<'_>) -> Result<Located<usize>, ModelError> {
    let value = item.integer()?.value;
    match usize::try_from(value) {
        Ok(count) if (2..=MOST_SAMPLES).contains(&count) => Ok(item.located(count)),
        _ => Err(item.error(ErrorKind::OutOfRange {
            expected: "2 (start and end) to 10000000 samples",
            found: value.to_string(),
            example: "samples = 101",
        })),
    }
}

fn samples_per_step(item: &Item<'_>) -> Result<Located<u32>, ModelError> {
    let value = item.integer()?.value;
    match u32::try_from(value) {
        Ok(count) if (1..=MOST_SAMPLES_PER_STEP).contains(&count) => Ok(item.located(count)),
        _ => Err(item.error(ErrorKind::OutOfRange {
            expected: "1 to 10000 samples per step",
            found: value.to_string(),
            example: "samples_per_step = 16",
        })),
    }
}

/// A number that is at least 0 and less than 1.
fn part(item: &Item<'_>) -> Result<Located<f64>, ModelError> {
    let number = item.number()?;
    if (0.0..1.0).contains(&number.value) {
        return Ok(number);
    }
    Err(item.error(ErrorKind::OutOfRange {
        expected: "a fraction from 0 to less than 1",
        found: number.value.to_string(),
        example: "accumulation = 1e-6",
    }))
}

fn tolerance(item: &Item<'_>, example: &'static str) -> Result<Located<f64>, ModelError> {
    positive(item, "a tolerance greater than 0", example)
}

/// One number, or a number for each of several names.
fn absolute(item: &Item<'_>) -> Result<AbsoluteTolerance, ModelError> {
    if !item.is_table() {
        return Ok(AbsoluteTolerance { all: Some(tolerance(item, "atol = 1e-12")?.value), each: Vec::new() });
    }
    let entries = item.table("a table of names", "{ x = 1e-15 }")?;
    let own =
        |entry: Item<'_>| Ok((component(&entry)?.text, tolerance(&entry, "atol = { x = 1e-15 }")?.value));
    Ok(AbsoluteTolerance { all: None, each: entries.items().map(own).collect::<Result<_, _>>()? })
}

/// The name of a component of the state. `x'` is the velocity of a coordinate: the prime stays in the name.
fn component(entry: &Item<'_>) -> Result<Name, ModelError> {
    if entry.velocity().is_some() { Ok(entry.label()) } else { entry.name() }
}

fn positive(
    item: &Item<'_>,
    expected: &'static str,
    example: &'static str,
) -> Result<Located<f64>, ModelError> {
    let number = item.number()?;
    if number.value > 0.0 {
        return Ok(number);
    }
    let found = number.value.to_string();
    Err(item.error(ErrorKind::OutOfRange { expected, found, example }))
}

pub(super) fn events(table: &Table<'_>) -> Result<Vec<Event>, ModelError> {
    table.items().map(|item| event(&item)).collect()
}

fn event(item: &Item<'_>) -> Result<Event, ModelError> {
    let name = item.new_label()?;
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
    let reset =
        |entry: Item<'_>| Ok(NamedExpression { name: component(&entry)?, expression: entry.expression()? });
    entries.items().map(reset).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diagnostics::source::Source;
    use crate::document::contents::Document;

    #[test]
    fn the_message_states_the_largest_table() {
        let text = |samples: usize| format!("[simulation]\nsamples = {samples}\n");
        let read = |samples: usize| Document::parse(Source::new("m.toml", text(samples))).map(|_| ());
        let refusal = |samples: usize| read(samples).map_err(|error| error.to_string());
        let is_range = |message: &String| message.contains(&format!("to {MOST_SAMPLES} samples"));
        assert!(refusal(MOST_SAMPLES + 1).is_err_and(|message| is_range(&message)));
        assert!(refusal(MOST_SAMPLES).is_err_and(|message| !is_range(&message)), "the rest of the model");
    }
}

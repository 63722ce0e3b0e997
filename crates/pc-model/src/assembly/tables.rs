//! The tables of inputs: lists in the text of the model, or columns of a file beside it.

use pc_mech::{KnownRates, Table, TableError};

use crate::diagnostics::error::ModelError;
use crate::diagnostics::error_kind::ErrorKind;
use crate::diagnostics::meaning::MeaningError;
use crate::diagnostics::source::Place;
use crate::document::{Document, Input, InputValue, Located, Name, TableFile, read_file_bounded};

const LISTS: &str = "give as many values as times, at least two, with increasing times";
const RATES: &str =
    "`rates` go with `interpolation = \"cubic\"`, `rates` and `accelerations` with \"quintic\"";
const COLUMNS: &str = "a file has a line of names, then lines of numbers, with commas between them; the times are in its \
                       column `t`, else in the first, or where `time = \"…\"` says";

/// The table of an input; `None` for a constant, and for a rate, which follows from the table of another.
///
/// # Errors
/// [`ModelError`] at an entry that is invalid or names an invalid file.
pub(crate) fn of(document: &Document, input: &Input) -> Result<Option<Table>, ModelError> {
    match &input.value {
        InputValue::Constant(_) | InputValue::RateOf(_) => Ok(None),
        InputValue::Lists { place, times, values, known, interpolation } => {
            let table = Table::with_rates(times.clone(), values.clone(), known, *interpolation);
            table.map(Some).map_err(|error| {
                let of_rates = matches!(error, TableError::Unused { .. } | TableError::RatesMissing);
                fault(document, place, error.to_string(), if of_rates { RATES } else { LISTS })
            })
        }
        InputValue::File(file) => from_file(document, file).map(Some),
    }
}

/// The error for the rate of an input whose table has jumps or corners, given in place of the one in the text.
pub(crate) fn without_rate(document: &Document, name: &Name) -> ModelError {
    let what = format!("the rate of `{}` is in use, and its table has corners or jumps", name.text);
    fault(document, &name.place, what, "give a table with cubic or quintic interpolation")
}

/// The error for a motion that starts outside a table.
pub(crate) fn not_at_start(document: &Document, name: &Name, table: &Table) -> ModelError {
    let (from, to) = (table.times().first(), table.times().last());
    let [from, to] = [from, to].map(|t| t.copied().unwrap_or(f64::NAN));
    let what =
        format!("the table of `{}` goes from {from} to {to}, and the motion starts outside", name.text);
    fault(
        document,
        &name.place,
        what,
        "let the table begin at `t_start` of [simulation], which is 0 unless given",
    )
}

fn fault(document: &Document, place: &Place, what: String, help: &'static str) -> ModelError {
    document.source.error(place, ErrorKind::Meaning(MeaningError::BadTable { what, help }))
}

fn from_file(document: &Document, file: &TableFile) -> Result<Table, ModelError> {
    let name = &file.file.value;
    let wrong = |what: String| fault(document, &file.file.place, what, COLUMNS);
    let unread = |error: String| {
        let help = "paths are relative to the model's file";
        fault(document, &file.file.place, format!("`{name}` cannot be read: {error}"), help)
    };
    let bytes = read_file_bounded(document.beside(name)).map_err(|error| unread(error.to_string()))?;
    let text =
        String::from_utf8(bytes).map_err(|_| unread("stream did not contain valid UTF-8".to_owned()))?;
    let mut lines = text.trim_start_matches('\u{feff}').lines().enumerate();
    let mut rows = lines.by_ref().filter(|(_, line)| !(line.trim().is_empty() || line.starts_with('#')));
    let (_, header) = rows.next().ok_or_else(|| wrong(format!("`{name}` is empty")))?;
    let columns: Vec<&str> = cells(header).collect();
    let find = |column: &str| columns.iter().position(|known| *known == column);
    let missing = |column: &str, place: &Place| {
        let what = format!("`{name}` has no column `{column}`; its columns are {}", columns.join(", "));
        fault(document, place, what, COLUMNS)
    };
    let (asked, asked_place) = (&file.column.value, &file.column.place);
    let value = find(asked).ok_or_else(|| missing(asked, asked_place))?;
    let given = |asked: &Option<Located<String>>| match asked {
        Some(Located { value, place }) => find(value).map(Some).ok_or_else(|| missing(value, place)),
        None => Ok(None),
    };
    let (rate, acceleration) = (given(&file.rate)?, given(&file.acceleration)?);
    let time = match &file.time {
        Some(time) => find(&time.value).ok_or_else(|| missing(&time.value, &time.place))?,
        None => find("t").unwrap_or(0),
    };
    let (mut times, mut values, mut numbers) = (Vec::new(), Vec::new(), Vec::new());
    let list = |column: Option<usize>| column.map(|_| Vec::new());
    let mut known = KnownRates { rates: list(rate), accelerations: list(acceleration) };
    for (number, line) in rows {
        let row: Vec<&str> = cells(line).collect();
        if row.len() != columns.len() {
            let what =
                format!("line {} of `{name}` has {} entries, not {}", number + 1, row.len(), columns.len());
            return Err(wrong(what));
        }
        let parsed = |column: usize| match row[column].parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            _ => Err(wrong(format!(
                "line {} of `{name}`: `{}` is not a finite number",
                number + 1,
                row[column]
            ))),
        };
        times.push(parsed(time)?);
        values.push(parsed(value)?);
        for (list, column) in [(&mut known.rates, rate), (&mut known.accelerations, acceleration)] {
            if let (Some(list), Some(column)) = (list, column) {
                list.push(parsed(column)?);
            }
        }
        numbers.push(number + 1);
    }
    Table::with_rates(times, values, &known, file.interpolation).map_err(|error| match error {
        TableError::NotRising { place, before, time } => wrong(format!(
            "line {} of `{name}`: the times must increase, but {time} follows {before}",
            numbers[place]
        )),
        other => wrong(format!("`{name}`: {other}")),
    })
}

/// The entries of a line, without the spaces and quotes around them.
fn cells(line: &str) -> impl Iterator<Item = &str> {
    line.split(',').map(|cell| cell.trim().trim_matches('"'))
}

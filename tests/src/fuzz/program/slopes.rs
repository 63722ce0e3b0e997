//! `pc run --sensitivities`, against differences of runs.

use super::table::Table;
use super::tried::Tried;
use crate::fuzz::comparison::exceeds;

/// Of the largest derivative of the table or of 1: differences over a thousandth leave 1e-6 of it, the tolerance of the
/// integration as much; the rest is left to motions that part from each other.
const TOLERANCE: f64 = 1e-4;

/// A motion that the default tolerances leave so far from the tight one, relative to a number or to 1, passes a place where
/// derivatives are larger still: they judge nothing.
const RESOLVED: f64 = 1e-7;

/// The part of a parameter over which motions are subtracted.
const STEP: f64 = 1e-3;

/// Tolerances of motions that are subtracted.
const TIGHT: [&str; 4] = ["--rtol", "1e-12", "--atol", "1e-14"];

/// The derivatives by one parameter.
pub(super) fn examine(tried: &mut Tried<'_>) {
    if tried.parameters.is_empty() {
        return;
    }
    let name = tried.random.pick(&tried.parameters).0.clone();
    let Some(value) = tried.value_of(&name) else { return };
    let rows = ["--rows", "3"].map(str::to_owned);
    let arguments = [vec!["--sensitivities".to_owned(), name.clone()], rows.to_vec()].concat();
    let Some(text) = tried.output("pc run --sensitivities", "run", &arguments) else { return };
    let Some(table) = tried.table(&text, &arguments, |_, _| true) else { return };
    let step = STEP * if value == 0.0 { 1.0 } else { value.abs() };
    let Some(wide) = differences(tried, &name, value, 2.0 * step) else { return };
    let Some(narrow) = differences(tried, &name, value, step) else { return };
    if let Some(difference) = not_the_slope(&table, &name, &narrow, &wide)
        && is_resolved(tried, &table)
    {
        let detail = format!("{difference}: run {}", arguments.join(" "));
        tried.tally.find("sensitivities are not the differences of motions", detail);
    }
}

/// Whether the motion beside the derivatives is that of tight tolerances.
fn is_resolved(tried: &mut Tried<'_>, table: &Table) -> bool {
    let run = [&["--rows", "3"][..], &TIGHT].concat();
    let run: Vec<String> = run.into_iter().map(str::to_owned).collect();
    let text = tried.output("pc run", "run", &run);
    let Some(tight) = text.and_then(|text| Table::of(&text).ok()) else { return false };
    let (Some(last), Some(wanted)) = (table.rows.last(), tight.rows.last()) else { return false };
    tight.columns.iter().zip(wanted).all(|(name, wanted)| {
        let found = table.place(name).map_or(f64::NAN, |place| last[place]);
        !exceeds(found - wanted, RESOLVED * wanted.abs().max(1.0))
    })
}

/// (x(p + h) − x(p − h))/2h at the end, of all columns; none where motions end otherwise.
fn differences(tried: &mut Tried<'_>, name: &str, value: f64, step: f64) -> Option<Vec<(String, f64)>> {
    let mut end = |value: f64| {
        let set = format!("{name}={value:?}");
        let run = [&["--set", &set, "--rows", "3"][..], &TIGHT].concat();
        let run: Vec<String> = run.into_iter().map(str::to_owned).collect();
        Table::of(&tried.output("pc run", "run", &run)?).ok()
    };
    let (above, below) = (end(value + step)?, end(value - step)?);
    let (last, before) = (above.rows.last()?, below.rows.last()?);
    let t = above.place("t")?;
    // A motion that an event ends has no slope at its end that the program would give.
    (last[t] == before[t] && above.rows.len() == below.rows.len()).then(|| {
        let slopes = last.iter().zip(before).map(|(a, b)| (a - b) / (2.0 * step));
        above.columns.iter().cloned().zip(slopes).collect()
    })
}

/// A derivative of the table that is not the difference, where the difference does not depend on its step.
fn not_the_slope(
    table: &Table,
    name: &str,
    narrow: &[(String, f64)],
    wide: &[(String, f64)],
) -> Option<String> {
    let last = table.rows.last()?;
    let size = narrow.iter().fold(1.0, |size, (_, slope)| f64::max(size, slope.abs()));
    for ((column, slope), (_, other)) in narrow.iter().zip(wide) {
        let Some(place) = table.place(&format!("∂{column}/∂{name}")) else { continue };
        let settled = f64::abs(slope - other) <= TOLERANCE * size / 4.0;
        if settled && exceeds(last[place] - slope, TOLERANCE * size) {
            return Some(format!("∂{column}/∂{name} is {:?}, the difference {slope:?}", last[place]));
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_derivative_that_is_another_is_found_where_differences_have_settled() {
        let table = Table::of("t,x,∂x/∂p\n0,1,0\n1,2,0.5\n").expect("a table");
        let slopes = |slope: f64| vec![("t".to_owned(), 0.0), ("x".to_owned(), slope)];
        assert_eq!(not_the_slope(&table, "p", &slopes(0.5), &slopes(0.500001)), None);
        assert!(not_the_slope(&table, "p", &slopes(0.6), &slopes(0.600001)).is_some());
        assert_eq!(not_the_slope(&table, "p", &slopes(0.6), &slopes(0.7)), None);
    }
}

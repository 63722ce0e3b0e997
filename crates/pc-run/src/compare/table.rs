//! A comparison as a table, with a row for each column that is compared.

use std::io::{self, Seek, Write};

use pc_print::{visible, visible_json};

use crate::compare::compared::Compared;
use crate::compare::difference::Difference;
use crate::table::format::Format;
#[cfg(feature = "parquet")]
use crate::table::parquet;
use crate::table::rows::{Cell, CellKind, Column, Rows, Take};
use crate::table::tabulated::Tabulated;
use crate::table::{csv, npz};

/// The differences of a comparison.
struct Differences<'c>(&'c [Difference]);

impl Rows for Differences<'_> {
    fn columns(&self) -> Vec<Column> {
        let numbers = ["largest", "time", "scale", "error(A)", "error(B)", "allowed", "since", "untold"]
            .map(|name| Column::new(name, CellKind::Number));
        let first = std::iter::once(Column::new("name", CellKind::Text));
        let last = [Column::new("counts", CellKind::Integer), Column::new("verdict", CellKind::Text)];
        first.chain(numbers).chain(last).collect()
    }

    fn count(&self) -> Option<u64> {
        Some(self.0.len() as u64)
    }

    fn each(&self, take: Take<'_>) -> io::Result<()> {
        self.0.iter().try_for_each(|found| {
            let Difference { largest, time, scale, errors: [a, b], allowed, since, untold, .. } = *found;
            let never = |time: Option<f64>| time.unwrap_or(f64::NAN);
            let numbers = [largest, time, scale, a, b, allowed, never(since), never(untold)];
            let first = std::iter::once(Cell::Text(&found.name));
            let last = [Cell::Integer(u64::from(found.counts)), Cell::Text(found.verdict().word())];
            take(&first.chain(numbers.map(Cell::Number)).chain(last).collect::<Vec<_>>())
        })
    }
}

impl Tabulated for Compared {
    fn formats(&self) -> &'static [Format] {
        Format::OF_COMPARISONS
    }

    fn write_as(&self, format: Format, out: &mut (impl Write + Seek + Send)) -> io::Result<()> {
        let table = Differences(&self.comparison.differences);
        match format {
            Format::Text => write!(out, "{}", visible(&self.text())),
            Format::Json => writeln!(out, "{}", visible_json(&self.json())),
            Format::Npz => npz::write(&table, &[], out),
            #[cfg(feature = "parquet")]
            Format::Parquet => parquet::write("comparison", &table, &[], out),
            Format::Csv | Format::Mat => csv::write(&table, out),
        }
    }
}

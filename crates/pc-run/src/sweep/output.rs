//! Writes the table of a sweep, using an amount of memory that does not depend on the number of records.

use std::io::{self, Seek, Write};

use pc_report::UnknownColumn;
use serde_json::json;

use super::journal::Records;
use super::sweep_columns::SweepColumns;
use crate::files::error::FileError;
use crate::files::kept::Kept;
use crate::table::chosen::{Chosen, chosen};
use crate::table::file::TableFile;
use crate::table::format::Format;
#[cfg(feature = "parquet")]
use crate::table::parquet;
use crate::table::rows::{Column, Rows, Take};
use crate::table::{csv, json, npz};

/// The members of a sweep as a table.
struct SweepTable<'s> {
    columns: &'s SweepColumns,
    records: &'s dyn Records,
}

impl Rows for SweepTable<'_> {
    fn columns(&self) -> Vec<Column> {
        self.columns.columns().to_vec()
    }

    fn count(&self) -> Option<u64> {
        None
    }

    fn each(&self, take: Take<'_>) -> io::Result<()> {
        for record in self.records.records()? {
            self.columns.rows(&record?)?.try_for_each(|row| take(&row))?;
        }
        Ok(())
    }
}

impl SweepColumns {
    /// The numbers of the columns that are written where some are wanted: the member, what is varied and, where there are many
    /// rows, the time always are.
    ///
    /// # Errors
    /// [`UnknownColumn`]
    pub fn written(&self, wanted: &[String]) -> Result<Vec<usize>, UnknownColumn> {
        let names: Vec<String> = self.columns().iter().map(|column| column.name.clone()).collect();
        chosen(&names, |j| self.tells_rows_apart(j), wanted)
    }
}

/// Writes these columns of the table, for a model with this title.
///
/// # Errors
/// [`FileError::Write`]; an existing file is then unchanged.
pub fn write(
    file: &TableFile,
    title: &str,
    (columns, written): (&SweepColumns, &[usize]),
    records: &dyn Records,
) -> Result<(), FileError> {
    let table = Chosen { table: &SweepTable { columns, records }, places: written };
    let result = file.place.write(|out| write_as(file.format, title, &table, out));
    result.map_err(|source| FileError::Write {
        path: file.path().display().to_string(),
        kept: records.kept().map_or(Kept::Nowhere, |path| Kept::Journal(path.to_owned())),
        source,
    })
}

fn write_as(
    format: Format,
    title: &str,
    table: &dyn Rows,
    out: &mut (impl Write + Seek + Send),
) -> io::Result<()> {
    match format {
        Format::Json => json::write(&[("model", json!(title))], table, &[], out),
        Format::Npz => npz::write(table, &[], out),
        #[cfg(feature = "parquet")]
        Format::Parquet => parquet::write("sweep", table, &[], out),
        Format::Text | Format::Csv | Format::Mat => csv::write(table, out),
    }
}

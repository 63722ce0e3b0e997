//! Writes the table of a sweep to a file, using an amount of memory that does not depend on the number of
//! records.

use std::io;

use serde_json::json;

use super::journal::Records;
use super::sweep_columns::SweepColumns;
use crate::files::error::FileError;
use crate::files::kept::Kept;
use crate::table::file::{Format, TableFile};
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

/// Writes the table, for a model with this title.
///
/// # Errors
/// [`FileError::Write`]; an existing file is then unchanged.
pub fn write(
    file: &TableFile,
    title: &str,
    columns: &SweepColumns,
    records: &dyn Records,
) -> Result<(), FileError> {
    let table = SweepTable { columns, records };
    let written = file.place.write(|out| match file.format {
        Format::Json => json::write(&[("model", json!(title))], &table, &[], out),
        Format::Npz => npz::write(&table, &[], out),
        #[cfg(feature = "parquet")]
        Format::Parquet => parquet::write("sweep", &table, &[], out),
        Format::Csv | Format::Mat => csv::write(&table, out),
    });
    written.map_err(|source| FileError::Write {
        path: file.path().display().to_string(),
        kept: records.kept().map_or(Kept::Nowhere, |path| Kept::Journal(path.to_owned())),
        source,
    })
}

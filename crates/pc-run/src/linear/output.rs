//! Linearizations and equilibria as files.

use std::io::Write;

use serde_json::Value;

use crate::files::error::FileError;
use crate::table::array::Array;
use crate::table::file::{Format, TableFile};
use crate::table::{mat, npz};

/// A result that can be written in every format.
pub(crate) struct Contents<'a> {
    pub(crate) json: &'a Value,
    pub(crate) csv: &'a str,
    pub(crate) arrays: &'a [Array],
    /// The names of the rows and columns of the arrays, as lists separated by commas.
    pub(crate) texts: &'a [(&'a str, String)],
}

impl Contents<'_> {
    /// Writes the result.
    ///
    /// # Errors
    /// [`FileError::Write`], which says where the result was kept; an existing file is then
    /// unchanged.
    pub(crate) fn write(&self, file: &TableFile) -> Result<(), FileError> {
        file.place.write_or_keep(file.format == Format::Csv, |out| match file.format {
            Format::Json => writeln!(out, "{:#}", self.json),
            Format::Npz => npz::write_arrays(self.arrays, out),
            Format::Mat => mat::write(self.arrays, self.texts, out),
            _ => out.write_all(self.csv.as_bytes()),
        })
    }
}

//! The destination of the table of a sweep.

use std::path::Path;

#[cfg(feature = "parquet")]
use super::parquet;
use super::{csv, json, npz};
use crate::error::CliError;
use crate::output::kept::Kept;
use crate::output::place::Place;
use crate::sweep::journal::Records;
use crate::sweep::sheet::Sheet;

/// Where the table goes.
#[derive(Debug)]
pub(crate) struct Destination {
    place: Place,
    encoding: Encoding,
}

#[derive(Clone, Copy, Debug)]
enum Encoding {
    Csv,
    Json,
    Npz,
    #[cfg(feature = "parquet")]
    Parquet,
}

impl Destination {
    /// # Errors
    /// [`CliError::UnknownExtension`]; [`CliError::Place`] where no file can be.
    pub(crate) fn new(path: &Path) -> Result<Destination, CliError> {
        let extension = path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase);
        let encoding = match extension.as_deref() {
            Some("csv") => Encoding::Csv,
            Some("json") => Encoding::Json,
            Some("npz") => Encoding::Npz,
            #[cfg(feature = "parquet")]
            Some("parquet") => Encoding::Parquet,
            _ => {
                let expected = if cfg!(feature = "parquet") {
                    ".csv, .json, .npz or .parquet"
                } else {
                    ".csv, .json or .npz (.parquet where pc is built with its feature `parquet`)"
                };
                return Err(CliError::UnknownExtension { option: "-o", path: path.to_owned(), expected });
            }
        };
        let place = Place::regular(path).map_err(|source| CliError::no_place(path, source))?;
        Ok(Destination { place, encoding })
    }

    /// The file.
    pub(crate) fn path(&self) -> &Path {
        self.place.path()
    }

    /// Writes the table.
    ///
    /// # Errors
    /// [`CliError::Write`]; an existing file is then unchanged.
    pub(crate) fn write(&self, title: &str, sheet: &Sheet, members: &dyn Records) -> Result<(), CliError> {
        let written = self.place.write(|out| match self.encoding {
            Encoding::Csv => csv::write(sheet, members, out),
            Encoding::Json => json::write(title, sheet, members, out),
            Encoding::Npz => npz::write(sheet, members, out),
            #[cfg(feature = "parquet")]
            Encoding::Parquet => parquet::write(sheet, members, out),
        });
        written.map_err(|source| CliError::Write {
            path: self.path().display().to_string(),
            kept: members.kept().map_or(Kept::Nowhere, |path| Kept::Journal(path.to_owned())),
            source,
        })
    }
}

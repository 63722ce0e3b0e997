//! Where results go: standard output, or a file that is there whole or not at all.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::error::CliError;
use crate::motion::run::Run;
use crate::output::{atomic, csv, json, npz, standard_output};
use crate::plot::picture::Picture;

/// How a result is encoded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
    /// Comma-separated values, 17 significant digits.
    Csv,
    /// One object: model, parameters, columns, rows, summary.
    Json,
    /// NumPy's archive, an array for each column.
    Npz,
    /// Vector graphics.
    Svg,
    /// A bitmap.
    Png,
}

/// Where a result goes; the place has been looked at before anything is computed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Destination {
    encoding: Encoding,
    /// None for standard output.
    path: Option<PathBuf>,
}

impl Destination {
    /// The place of the table: the file, else standard output as CSV.
    ///
    /// # Errors
    /// [`CliError::UnknownExtension`]; [`CliError::Write`] where no file can be.
    pub fn table(path: Option<&Path>) -> Result<Destination, CliError> {
        let Some(path) = path else { return Ok(Destination { encoding: Encoding::Csv, path: None }) };
        let encodings = [("csv", Encoding::Csv), ("json", Encoding::Json), ("npz", Encoding::Npz)];
        Destination::file("-o", path, &encodings, ".csv, .json or .npz")
    }

    /// The place of the picture, if one is wanted.
    ///
    /// # Errors
    /// As for [`table`](Destination::table).
    pub fn plot(path: Option<&Path>) -> Result<Option<Destination>, CliError> {
        let encodings = [("svg", Encoding::Svg), ("png", Encoding::Png)];
        path.map(|path| Destination::file("--plot", path, &encodings, ".svg or .png")).transpose()
    }

    fn file(
        option: &'static str,
        path: &Path,
        encodings: &[(&str, Encoding)],
        expected: &'static str,
    ) -> Result<Destination, CliError> {
        let extension = path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase);
        let encoding = encodings.iter().find(|(name, _)| extension.as_deref() == Some(*name));
        let Some(&(_, encoding)) = encoding else {
            return Err(CliError::UnknownExtension { option, path: path.to_owned(), expected });
        };
        atomic::look(path).map_err(|source| CliError::cannot_write(path, source))?;
        Ok(Destination { encoding, path: Some(path.to_owned()) })
    }

    /// Writes the table of a run.
    ///
    /// # Errors
    /// [`CliError::Write`]; an existing file is then as it was.
    pub fn write_table(&self, run: &Run) -> Result<(), CliError> {
        self.write(|out| match self.encoding {
            Encoding::Json => json::write(run, out),
            Encoding::Npz => npz::write(run, out),
            Encoding::Csv | Encoding::Svg | Encoding::Png => csv::write(&run.table, out),
        })
    }

    /// Writes a picture.
    ///
    /// # Errors
    /// As for [`write_table`](Destination::write_table), and [`CliError::Plot`].
    pub fn write_plot(&self, picture: &Picture) -> Result<(), CliError> {
        let bytes = match self.encoding {
            Encoding::Png => picture.png()?,
            _ => picture.svg()?.into_bytes(),
        };
        self.write(|out| out.write_all(&bytes))
    }

    fn write(&self, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), CliError> {
        match &self.path {
            None => standard_output::print(write),
            Some(path) => atomic::write(path, write).map_err(|source| CliError::cannot_write(path, source)),
        }
    }
}

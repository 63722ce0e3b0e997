//! Files of matrices.

use std::io::{self, Write};
use std::path::Path;

use npyz::WriterBuilder;
use serde_json::Value;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

use crate::error::CliError;
use crate::linear::arrays::Array;
use crate::linear::mat;
use crate::output::atomic::FileWriter;
use crate::output::npz::entry;
use crate::output::place::Place;

/// Where a result goes, and in which format.
#[derive(Debug)]
pub(crate) struct Destination {
    place: Place,
    format: Format,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Format {
    Json,
    Csv,
    Npz,
    Mat,
}

/// A result in every format.
pub(crate) struct Contents<'a> {
    pub(crate) json: &'a Value,
    pub(crate) csv: &'a str,
    pub(crate) arrays: &'a [Array],
    /// Names for the rows and columns of the arrays, each list separated by commas.
    pub(crate) texts: &'a [(&'a str, String)],
}

impl Destination {
    /// A file for arrays.
    ///
    /// # Errors
    /// [`CliError::UnknownExtension`]; [`CliError::Place`] where no file can be.
    pub(crate) fn of_arrays(path: &Path) -> Result<Destination, CliError> {
        let formats =
            [("json", Format::Json), ("csv", Format::Csv), ("npz", Format::Npz), ("mat", Format::Mat)];
        Destination::new(path, &formats, ".json, .csv, .npz or .mat")
    }

    /// A file for a list.
    ///
    /// # Errors
    /// As for [`of_arrays`](Destination::of_arrays).
    pub(crate) fn of_list(path: &Path) -> Result<Destination, CliError> {
        Destination::new(path, &[("json", Format::Json), ("csv", Format::Csv)], ".json or .csv")
    }

    fn new(path: &Path, formats: &[(&str, Format)], expected: &'static str) -> Result<Destination, CliError> {
        let extension = path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase);
        let format = formats.iter().find(|(name, _)| extension.as_deref() == Some(*name));
        let Some(&(_, format)) = format else {
            return Err(CliError::UnknownExtension { option: "-o", path: path.to_owned(), expected });
        };
        // Writing the archive needs to seek.
        let place = if format == Format::Npz { Place::regular(path) } else { Place::new(path) };
        let place = place.map_err(|source| CliError::no_place(path, source))?;
        Ok(Destination { place, format })
    }

    /// Writes the result to the destination.
    ///
    /// # Errors
    /// [`CliError::Write`], which says where the result was kept; an existing file is then
    /// unchanged.
    pub(crate) fn write(&self, contents: &Contents<'_>) -> Result<(), CliError> {
        self.place.write_or_keep(self.format == Format::Csv, |out| match self.format {
            Format::Json => writeln!(out, "{:#}", contents.json),
            Format::Csv => out.write_all(contents.csv.as_bytes()),
            Format::Npz => npz(contents.arrays, out),
            Format::Mat => mat::write(contents.arrays, contents.texts, out),
        })
    }
}

/// One array for each, a complex one with a last axis of real and imaginary part; the archive has
/// no date.
fn npz(arrays: &[Array], out: &mut FileWriter<'_>) -> io::Result<()> {
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Stored)
        .last_modified_time(DateTime::default());
    let mut archive = ZipWriter::new(out);
    for array in arrays {
        archive.start_file(format!("{}.npy", entry(&array.name)), options)?;
        let columns = (!array.is_list).then_some(array.columns as u64);
        let parts = array.imaginary.as_ref().map(|_| 2);
        let shape: Vec<u64> = [Some(array.rows as u64), columns, parts].into_iter().flatten().collect();
        let mut writer =
            npyz::WriteOptions::new().default_dtype().shape(&shape).writer(&mut archive).begin_nd()?;
        match &array.imaginary {
            Some(imaginary) => {
                writer.extend(array.real.iter().zip(imaginary).flat_map(|(&re, &im)| [re, im]))?;
            }
            None => writer.extend(array.real.iter().copied())?,
        }
        writer.finish()?;
    }
    archive.finish()?;
    Ok(())
}

//! Destinations of results: standard output, or a file that is written whole or not at all.

use std::io::Write;
use std::path::Path;

use pc_report::picture::Drawing;

use crate::error::CliError;
use crate::motion::run::Run;
use crate::output::place;
use crate::output::place::Place;
use crate::output::stream::Stream;
use crate::output::{csv, json, npz, standard_output};
use crate::plot::gif::gif;
use crate::plot::pdf::pdf;
use crate::plot::png::png;

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
    /// A page for print.
    Pdf,
    /// A page for a browser.
    Html,
    /// A sequence of bitmaps.
    Gif,
}

/// The destination of a result; the place is examined before anything is computed.
#[derive(Debug)]
pub struct Destination {
    encoding: Encoding,
    /// None for standard output.
    place: Option<Place>,
}

impl Destination {
    /// The place of the table: the file, else, as for `-`, standard output as CSV.
    ///
    /// # Errors
    /// [`CliError::UnknownExtension`]; [`CliError::Place`] where no file can be.
    pub fn table(path: Option<&Path>) -> Result<Destination, CliError> {
        let Some(path) = place::file(path) else {
            return Ok(Destination { encoding: Encoding::Csv, place: None });
        };
        let encodings = [("csv", Encoding::Csv), ("json", Encoding::Json), ("npz", Encoding::Npz)];
        Destination::file("-o", path, &encodings, ".csv, .json or .npz")
    }

    /// The place of the picture, if one is wanted.
    ///
    /// # Errors
    /// As for [`table`](Destination::table).
    pub fn plot(path: Option<&Path>) -> Result<Option<Destination>, CliError> {
        let encodings = [("svg", Encoding::Svg), ("png", Encoding::Png), ("pdf", Encoding::Pdf)];
        path.map(|path| Destination::file("--plot", path, &encodings, ".svg, .png or .pdf")).transpose()
    }

    /// The place of a page: the file, else, as for `-`, standard output.
    ///
    /// # Errors
    /// As for [`table`](Destination::table).
    pub fn page(path: Option<&Path>) -> Result<Destination, CliError> {
        let Some(path) = place::file(path) else {
            return Ok(Destination { encoding: Encoding::Html, place: None });
        };
        Destination::file("-o", path, &[("html", Encoding::Html), ("htm", Encoding::Html)], ".html")
    }

    /// The place of a motion that is shown: a page, a film, or a picture of one frame; else, as for `-`, standard output.
    ///
    /// # Errors
    /// As for [`table`](Destination::table).
    pub fn shown(path: Option<&Path>) -> Result<Destination, CliError> {
        let Some(path) = place::file(path) else { return Destination::page(path) };
        let encodings = [
            ("html", Encoding::Html),
            ("htm", Encoding::Html),
            ("gif", Encoding::Gif),
            ("svg", Encoding::Svg),
            ("png", Encoding::Png),
            ("pdf", Encoding::Pdf),
        ];
        Destination::file("-o", path, &encodings, ".html, .gif, .svg, .png or .pdf")
    }

    /// How it is encoded.
    pub fn encoding(&self) -> Encoding {
        self.encoding
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
        // Writing the archive needs to seek.
        let place = if encoding == Encoding::Npz { Place::regular(path) } else { Place::new(path) };
        let place = place.map_err(|source| CliError::no_place(path, source))?;
        Ok(Destination { encoding, place: Some(place) })
    }

    /// Writes the table of a run.
    ///
    /// # Errors
    /// [`CliError::Write`], which says where the table was kept; an existing file is then
    /// unchanged.
    pub fn write_table(&self, run: &Run) -> Result<(), CliError> {
        let Some(place) = &self.place else {
            return standard_output::print_or_keep("motion.csv", |out| csv::write(&run.table, out));
        };
        place.write_or_keep(self.encoding == Encoding::Csv, |out| match self.encoding {
            Encoding::Json => json::write(run, out),
            Encoding::Npz => npz::write(run, out),
            Encoding::Csv
            | Encoding::Svg
            | Encoding::Png
            | Encoding::Pdf
            | Encoding::Html
            | Encoding::Gif => csv::write(&run.table, out),
        })
    }

    /// A stream for the rows of the table as they are computed, if the destination is a regular CSV
    /// file.
    pub(crate) fn stream(&self) -> Option<Stream<'_>> {
        let place = self.place.as_ref().filter(|place| place.device.is_none());
        place.filter(|_| self.encoding == Encoding::Csv).map(Stream::to)
    }

    /// Writes a page.
    ///
    /// # Errors
    /// As for [`write_table`](Destination::write_table).
    pub fn write_page(&self, page: &str) -> Result<(), CliError> {
        match &self.place {
            None => standard_output::print_or_keep("page.html", |out| out.write_all(page.as_bytes())),
            Some(place) => place.write_or_keep(false, |out| out.write_all(page.as_bytes())),
        }
    }

    /// Writes a picture.
    ///
    /// # Errors
    /// As for [`write_table`](Destination::write_table), and [`CliError::Plot`].
    pub fn write_plot(&self, drawing: &Drawing) -> Result<(), CliError> {
        self.write_bytes(&match self.encoding {
            Encoding::Png => png(drawing)?,
            Encoding::Pdf => pdf(drawing)?,
            _ => drawing.svg().into_bytes(),
        })
    }

    /// Writes a sequence of pictures as GIF.
    ///
    /// # Errors
    /// As for [`write_plot`](Destination::write_plot).
    pub fn write_film(&self, drawings: impl Iterator<Item = Drawing>) -> Result<(), CliError> {
        self.write_bytes(&gif(drawings)?)
    }

    fn write_bytes(&self, bytes: &[u8]) -> Result<(), CliError> {
        match &self.place {
            None => standard_output::print(|out| out.write_all(bytes)),
            Some(place) => place.write_or_keep(false, |out| out.write_all(bytes)),
        }
    }
}

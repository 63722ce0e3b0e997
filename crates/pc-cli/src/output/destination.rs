//! Destinations of results: standard output, or a file that is written whole or not at all.

use std::io::Write;
use std::path::Path;

use pc_report::files::{gif, pdf, png};
use pc_report::picture::Drawing;
use pc_run::files::error::FileError;
use pc_run::files::target;
use pc_run::files::target::Target;
use pc_run::motion::run::Run;

use crate::error::CliError;
use crate::output::standard_output;
use crate::terminal::text;

/// How a page or a picture is encoded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Encoding {
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

/// The destination of a page or a picture; the place is examined before anything is computed.
#[derive(Debug)]
pub struct Destination {
    encoding: Encoding,
    /// None for standard output.
    place: Option<Target>,
}

impl Destination {
    /// The place of the picture, if one is wanted.
    ///
    /// # Errors
    /// [`FileError::UnknownExtension`]; [`FileError::Place`] where no file can be.
    pub fn plot(path: Option<&Path>) -> Result<Option<Destination>, CliError> {
        let encodings = [("svg", Encoding::Svg), ("png", Encoding::Png), ("pdf", Encoding::Pdf)];
        path.map(|path| Destination::file("--plot", path, &encodings, ".svg, .png or .pdf")).transpose()
    }

    /// The place of a page: the file, else, as for `-`, standard output.
    ///
    /// # Errors
    /// As for [`plot`](Destination::plot).
    pub fn page(path: Option<&Path>) -> Result<Destination, CliError> {
        let Some(path) = target::file(path) else {
            return Ok(Destination { encoding: Encoding::Html, place: None });
        };
        Destination::file("-o", path, &[("html", Encoding::Html), ("htm", Encoding::Html)], ".html")
    }

    /// The place of a motion that is shown: a page, a film, or a picture of one frame; else, as for `-`, standard output.
    ///
    /// # Errors
    /// As for [`plot`](Destination::plot).
    pub fn shown(path: Option<&Path>) -> Result<Destination, CliError> {
        let Some(path) = target::file(path) else { return Destination::page(path) };
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

    /// This destination or, for what there is of a run that was interrupted, FILE.partial beside the file.
    pub fn for_run(self, run: &Run) -> Destination {
        let so_far = self.place.as_ref().filter(|_| run.is_interrupted()).and_then(Target::so_far);
        Destination { place: so_far.or(self.place), ..self }
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
            let expected = expected.to_owned();
            return Err(FileError::UnknownExtension { option, path: path.to_owned(), expected }.into());
        };
        let place = Target::new(path).map_err(|source| FileError::no_place(path, source))?;
        Ok(Destination { encoding, place: Some(place) })
    }

    /// Writes a page.
    ///
    /// # Errors
    /// [`FileError::Write`], which says where it was kept; an existing file is then unchanged.
    pub fn write_page(&self, page: &str) -> Result<(), CliError> {
        match &self.place {
            None => standard_output::print_or_keep("page.html", |out| out.write_all(page.as_bytes())),
            Some(place) => write(place, page.as_bytes()),
        }
    }

    /// Writes a picture.
    ///
    /// # Errors
    /// [`CliError::Picture`], and as for [`write_page`](Destination::write_page).
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
            Some(place) => write(place, bytes),
        }
    }
}

fn write(place: &Target, bytes: &[u8]) -> Result<(), CliError> {
    place.write_or_keep(false, |out| out.write_all(bytes))?;
    text::say_so_far(place.path(), place.instead_of());
    Ok(())
}

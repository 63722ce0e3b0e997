//! The file of a table, in the format given by its name.

use std::path::Path;

use crate::files::error::FileError;
use crate::files::stream::Stream;
use crate::files::target::Target;

/// The format of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Comma-separated values, 17 significant digits.
    Csv,
    /// One JSON object.
    Json,
    /// NumPy's archive.
    Npz,
    /// A MAT-file.
    Mat,
    /// Apache Parquet.
    #[cfg(feature = "parquet")]
    Parquet,
}

impl Format {
    /// The formats of tables of numbers and text.
    pub const OF_TABLES: &'static [Format] = &[
        Format::Csv,
        Format::Json,
        Format::Npz,
        #[cfg(feature = "parquet")]
        Format::Parquet,
    ];
    /// The formats of arrays.
    pub const OF_ARRAYS: &'static [Format] = &[Format::Json, Format::Csv, Format::Npz, Format::Mat];
    /// The formats of lists.
    pub const OF_LISTS: &'static [Format] = &[Format::Json, Format::Csv];

    /// The extension of file names in this format.
    pub fn extension(self) -> &'static str {
        match self {
            Format::Csv => "csv",
            Format::Json => "json",
            Format::Npz => "npz",
            Format::Mat => "mat",
            #[cfg(feature = "parquet")]
            Format::Parquet => "parquet",
        }
    }

    /// A phrase that lists the extensions of some formats.
    fn expected(formats: &[Format]) -> String {
        let endings: Vec<String> = formats.iter().map(|format| format!(".{}", format.extension())).collect();
        let listed = match endings.split_last() {
            Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
            _ => endings.concat(),
        };
        let is_missing = cfg!(not(feature = "parquet")) && formats == Format::OF_TABLES;
        let feature = " (.parquet where pc is built with its feature `parquet`)";
        if is_missing { listed + feature } else { listed }
    }
}

/// The file of a table; its place is examined before anything is computed.
#[derive(Debug)]
pub struct TableFile {
    pub(crate) place: Target,
    pub(crate) format: Format,
}

impl TableFile {
    /// A file in one of these formats, or a device for formats that are written from beginning to end.
    ///
    /// # Errors
    /// [`FileError::UnknownExtension`]; [`FileError::Place`] if the file cannot be written.
    pub fn new(path: &Path, formats: &[Format]) -> Result<TableFile, FileError> {
        let format = format(path, formats)?;
        // Writing the archive needs to seek.
        let place = if format == Format::Npz { Target::regular(path) } else { Target::new(path) };
        Ok(TableFile { place: place.map_err(|source| FileError::no_place(path, source))?, format })
    }

    /// A regular file in one of these formats.
    ///
    /// # Errors
    /// As for [`new`](TableFile::new).
    pub fn regular(path: &Path, formats: &[Format]) -> Result<TableFile, FileError> {
        let format = format(path, formats)?;
        let place = Target::regular(path).map_err(|source| FileError::no_place(path, source))?;
        Ok(TableFile { place, format })
    }

    /// The path as given.
    pub fn path(&self) -> &Path {
        self.place.path()
    }

    /// A stream that takes rows as they are computed, if this is a regular CSV file.
    pub fn stream(&self) -> Option<Stream<'_>> {
        (self.format == Format::Csv && self.place.device.is_none()).then(|| Stream::to(&self.place))
    }

    /// Puts the rows of a stream at the place of this file, that of the stream or the one for as much as there
    /// [`is so far`](TableFile::so_far).
    ///
    /// # Errors
    /// [`FileError::Write`], which says where the rows were kept.
    pub fn end(&self, stream: Stream<'_>) -> Result<(), FileError> {
        stream.end(&self.place)
    }

    /// The file of what there is of a table that was interrupted, FILE.partial, so that FILE stays as it was; none for a device.
    pub fn so_far(&self) -> Option<TableFile> {
        Some(TableFile { place: self.place.so_far()?, format: self.format })
    }

    /// The path of the file that stays as it was, if this is the file of an interrupted table.
    pub fn instead_of(&self) -> Option<&Path> {
        self.place.instead_of()
    }
}

fn format(path: &Path, formats: &[Format]) -> Result<Format, FileError> {
    let extension = path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase);
    let format = formats.iter().find(|format| extension.as_deref() == Some(format.extension()));
    format.copied().ok_or_else(|| FileError::UnknownExtension {
        option: "-o",
        path: path.to_owned(),
        expected: Format::expected(formats),
    })
}

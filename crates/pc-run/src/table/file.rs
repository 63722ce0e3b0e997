//! The file of a table.

use std::path::Path;

use crate::files::error::FileError;
use crate::files::stream::Stream;
use crate::files::target::Target;
use crate::table::format::Format;

/// The file of a table; its place is examined before anything is computed.
#[derive(Debug)]
pub struct TableFile {
    pub(crate) place: Target,
    pub(crate) format: Format,
}

impl TableFile {
    /// A file in the format that is asked for, or else given by its name, among these; or a device for formats that are
    /// written from beginning to end.
    ///
    /// # Errors
    /// Those of [`Format::of`]; [`FileError::Place`] if the file cannot be written.
    pub fn new(path: &Path, asked: Option<Format>, formats: &[Format]) -> Result<TableFile, FileError> {
        let format = Format::of(Some(path), asked, formats)?;
        // Writing the archive needs to seek.
        let place = if format == Format::Npz { Target::regular(path) } else { Target::new(path) };
        Ok(TableFile { place: place.map_err(|source| FileError::no_place(path, source))?, format })
    }

    /// A regular file in the format that is asked for, or else given by its name, among these.
    ///
    /// # Errors
    /// As for [`new`](TableFile::new).
    pub fn regular(path: &Path, asked: Option<Format>, formats: &[Format]) -> Result<TableFile, FileError> {
        let format = Format::of(Some(path), asked, formats)?;
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

//! Rows that are written as they are computed.

use std::io::{self, BufWriter, Write};
use std::ops::ControlFlow;

use tempfile::NamedTempFile;

use crate::files::error::FileError;
use crate::files::kept::Kept;
use crate::files::partial;
use crate::files::target::Target;
use crate::table::csv;
use crate::table::rows::Cell;

/// A table of comma-separated values that grows in a file beside the one that it replaces at the end.
#[derive(Debug)]
pub struct Stream<'p> {
    place: &'p Target,
    /// The file, once it has been begun.
    out: Option<BufWriter<NamedTempFile>>,
    /// The error that ended the writing.
    error: Option<io::Error>,
}

/// The number of bytes that are written at once.
const BLOCK: usize = 1 << 20;

impl<'p> Stream<'p> {
    /// A stream to a regular file.
    pub(crate) fn to(place: &'p Target) -> Stream<'p> {
        Stream { place, out: None, error: None }
    }

    /// Creates the file and writes the line of names.
    ///
    /// # Errors
    /// [`FileError::Write`]
    pub(crate) fn begin<'n>(
        &mut self,
        columns: impl IntoIterator<Item = &'n String>,
    ) -> Result<(), FileError> {
        let begun = partial::make(&self.place.file).and_then(|made| {
            let mut out = BufWriter::with_capacity(BLOCK, made);
            writeln!(out, "{}", csv::header(columns))?;
            self.out = Some(out);
            Ok(())
        });
        begun.map_err(|source| FileError::cannot_write(self.place.path(), source))
    }

    /// Whether the file has been created.
    pub fn is_begun(&self) -> bool {
        self.out.is_some()
    }

    /// Writes a row; returns a break if this fails.
    pub(crate) fn row(&mut self, numbers: impl IntoIterator<Item = f64>) -> ControlFlow<()> {
        let Some(out) = &mut self.out else { return ControlFlow::Break(()) };
        if let Err(error) = csv::row(numbers.into_iter().map(Cell::Number), out) {
            self.error = Some(error);
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    }

    /// Whether a row could not be written.
    pub(crate) fn has_failed(&self) -> bool {
        self.error.is_some()
    }

    /// Puts the table at a place in the directory in which it was begun or, failing that, keeps its complete rows beside it.
    ///
    /// # Errors
    /// [`FileError::Write`], which says where the table was kept.
    pub(crate) fn end(self, place: &Target) -> Result<(), FileError> {
        let Some(mut out) = self.out else { return Ok(()) };
        let flushed = self.error.map_or_else(|| out.flush(), Err);
        let (made, _) = out.into_parts(); // what could not be written is not tried again
        let (source, part) = match flushed {
            Err(error) => (error, Some(made)),
            Ok(()) => match place.put(made) {
                Ok(()) => return Ok(()),
                Err(failed) => failed,
            },
        };
        let kept = part.and_then(|part| place.keep_lines(part)).map_or(Kept::Nowhere, Kept::Beginning);
        Err(FileError::Write { path: place.path().display().to_string(), kept, source })
    }
}

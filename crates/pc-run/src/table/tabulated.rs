//! Results that are written as tables: to a file, or from beginning to end.

use std::io::{self, Cursor, Error, ErrorKind, Seek, SeekFrom, Write};

use crate::files::error::FileError;
use crate::table::file::TableFile;
use crate::table::format::Format;

/// A result that can be written in some of the formats.
pub trait Tabulated {
    /// The formats that it has, the first of which is the usual one on standard output.
    fn formats(&self) -> &'static [Format];

    /// Writes the result in one of its formats.
    ///
    /// # Errors
    /// [`io::Error`]
    fn write_as(&self, format: Format, out: &mut (impl Write + Seek + Send)) -> io::Result<()>;

    /// Writes the result to its file.
    ///
    /// # Errors
    /// [`FileError::Write`], which says where the result was kept; an existing file is then
    /// unchanged.
    fn write(&self, file: &TableFile) -> Result<(), FileError> {
        file.place.write_or_keep(file.format == Format::Csv, |out| self.write_as(file.format, out))
    }

    /// Writes the result to what takes bytes in their order, as a pipe does. A format that goes back to what it has written is
    /// composed in memory.
    ///
    /// # Errors
    /// [`io::Error`]
    fn print_as(&self, format: Format, out: &mut (dyn Write + Send)) -> io::Result<()> {
        if !format.is_binary() {
            return self.write_as(format, &mut InOrder(out));
        }
        let mut bytes = Cursor::new(Vec::new());
        self.write_as(format, &mut bytes)?;
        out.write_all(bytes.get_ref())
    }
}

/// What takes bytes in their order.
struct InOrder<'o>(&'o mut (dyn Write + Send));

impl Write for InOrder<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

impl Seek for InOrder<'_> {
    fn seek(&mut self, _: SeekFrom) -> io::Result<u64> {
        Err(Error::from(ErrorKind::NotSeekable))
    }
}

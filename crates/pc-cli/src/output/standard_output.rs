//! Standard output; it is no error if its reader goes away.

use std::io::{self, ErrorKind, Write};

use pc_run::files::error::FileError;
use pc_run::files::kept::Kept;
use pc_run::files::rescue::elsewhere;

use crate::error::{CliError, STANDARD_OUTPUT};

/// Writes to standard output.
///
/// # Errors
/// [`FileError::Write`], which needs no message where the reader has gone away (`pc run … | head`).
pub fn print(write: impl FnOnce(&mut (dyn Write + Send)) -> io::Result<()>) -> Result<(), CliError> {
    attempt(write).map_err(error)
}

/// Writes a result to standard output, or else to a file in the directory of temporary files.
pub(crate) fn print_or_keep(
    name: &str,
    write: impl Fn(&mut (dyn Write + Send)) -> io::Result<()>,
) -> Result<(), CliError> {
    attempt(&write).map_err(|source| {
        let gone = source.kind() == ErrorKind::BrokenPipe;
        let kept = if gone { None } else { elsewhere(name, |out| write(out)) };
        unwritten(source, kept.map_or(Kept::Nowhere, Kept::Elsewhere))
    })
}

fn attempt(write: impl FnOnce(&mut (dyn Write + Send)) -> io::Result<()>) -> io::Result<()> {
    let mut out = io::BufWriter::new(io::stdout());
    let written = write(&mut out).and_then(|()| out.flush());
    drop(out.into_parts()); // what could not be written is not tried again
    written
}

/// The error of output that could not be written and is not kept anywhere.
pub fn error(source: io::Error) -> CliError {
    unwritten(source, Kept::Nowhere)
}

fn unwritten(source: io::Error, kept: Kept) -> CliError {
    FileError::Write { path: STANDARD_OUTPUT.to_owned(), kept, source }.into()
}

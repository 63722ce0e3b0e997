//! Standard output, where a closed pipe is no error.

use std::io::{self, Write};

use crate::error::CliError;

/// Writes to standard output; a reader that has gone away (`pc run … | head`) is no error.
///
/// # Errors
/// [`CliError::Write`] for anything else.
pub fn print(write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), CliError> {
    let mut out = io::BufWriter::new(io::stdout().lock());
    match write(&mut out).and_then(|()| out.flush()) {
        Err(source) if source.kind() != io::ErrorKind::BrokenPipe => {
            Err(CliError::Write { path: "standard output".to_owned(), source })
        }
        _ => {
            drop(out.into_parts()); // what could not be written is not tried again
            Ok(())
        }
    }
}

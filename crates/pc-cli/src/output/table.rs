//! Where a table goes: to a file, or to standard output.

use std::io::{self, IsTerminal};

use pc_run::files::target;
use pc_run::table::file::TableFile;
use pc_run::table::format::Format;
use pc_run::table::tabulated::Tabulated;

use crate::args::table::TableArguments;
use crate::error::CliError;
use crate::output::standard_output::print_or_keep;

/// The place of a table, which is examined before anything is computed.
#[derive(Debug)]
pub enum TablePlace {
    /// A file.
    File(TableFile),
    /// Standard output, also as `-`, in this format.
    StandardOutput(Format),
}

impl TablePlace {
    /// The place that the options name, for a result in one of these formats; the first is the usual one on standard output.
    ///
    /// # Errors
    /// Those of [`TableFile::new`]; [`CliError::Unreadable`] for bytes that a terminal would show.
    pub fn of(arguments: &TableArguments, formats: &[Format]) -> Result<TablePlace, CliError> {
        if let Some(path) = target::file(arguments.output.as_deref()) {
            return Ok(TablePlace::File(TableFile::new(path, arguments.format, formats)?));
        }
        let format = Format::of(None, arguments.format, formats)?;
        if format.is_binary() && io::stdout().is_terminal() {
            return Err(CliError::Unreadable { format: format.name() });
        }
        Ok(TablePlace::StandardOutput(format))
    }

    /// The file, if it is one.
    pub fn file(&self) -> Option<&TableFile> {
        match self {
            TablePlace::File(file) => Some(file),
            TablePlace::StandardOutput(_) => None,
        }
    }

    /// Writes a result there; if it cannot be written to standard output, it is kept in a file of this name.
    ///
    /// # Errors
    /// [`FileError::Write`](pc_run::files::error::FileError::Write)
    pub fn write(&self, result: &impl Tabulated, name: &str) -> Result<(), CliError> {
        match self {
            TablePlace::File(file) => Ok(result.write(file)?),
            TablePlace::StandardOutput(format) => {
                let name = format!("{name}.{}", format.extension());
                print_or_keep(&name, |out| result.print_as(*format, out))
            }
        }
    }
}

/// The file that the options name, for a result that goes to a regular file alone.
///
/// # Errors
/// Those of [`TableFile::regular`]; [`CliError::NoFile`] for standard output.
pub fn regular_file(arguments: &TableArguments, formats: &[Format]) -> Result<TableFile, CliError> {
    let path = target::file(arguments.output.as_deref()).ok_or(CliError::NoFile)?;
    Ok(TableFile::regular(path, arguments.format, formats)?)
}

//! A text that a command prints, or writes to the file named by `-o`.

use std::io::{self, Write};
use std::path::Path;

use pc_run::files::error::FileError;
use pc_run::files::target::{Target, file};

use crate::error::CliError;
use crate::output::standard_output::print;

/// The place of a text: a file, or standard output.
#[derive(Debug)]
pub(crate) struct TextOutput(Option<Target>);

impl TextOutput {
    /// The file named by `-o`, which is examined before anything is derived, or standard output.
    ///
    /// # Errors
    /// [`FileError::NoPlace`]
    pub(crate) fn at(path: Option<&Path>) -> Result<TextOutput, CliError> {
        let opened = |path: &Path| Target::new(path).map_err(|source| FileError::no_place(path, source));
        Ok(TextOutput(file(path).map(opened).transpose()?))
    }

    /// Prints the text, or writes the file as a whole.
    ///
    /// # Errors
    /// [`FileError::Write`]
    pub(crate) fn write(
        &self,
        text: impl Fn(&mut (dyn Write + Send)) -> io::Result<()>,
    ) -> Result<(), CliError> {
        match &self.0 {
            None => print(text),
            Some(place) => place
                .write(|out| text(out))
                .map_err(|source| FileError::cannot_write(place.path(), source).into()),
        }
    }
}

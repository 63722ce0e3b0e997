//! The text with which a page begins, and the file from which it came.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use pc_model::Builtin;
use pc_run::files::target::Target;

use crate::args::input;
use crate::error::CliError;

/// The text with which a page begins, and the file from which it came, if any.
pub(crate) struct Original {
    /// The model as it was named on the command line.
    given: String,
    /// The name of the source, from which the places of tables are found.
    source: String,
    path: Option<PathBuf>,
    text: String,
    /// The contents of the file when it was last read or written.
    known: Mutex<Vec<u8>>,
}

/// Why a text was not saved.
#[derive(Debug, thiserror::Error)]
pub(super) enum Unsaved {
    /// There is no file.
    #[error("the model came from no file")]
    NoFile,
    /// Somebody else has written the file.
    #[error("{name} has changed on disk since it was read")]
    Changed {
        /// Its name.
        name: String,
    },
    /// The file cannot be written.
    #[error("{name} cannot be written: {source}")]
    Unwritten {
        /// Its name.
        name: String,
        /// Why.
        source: std::io::Error,
    },
}

impl Original {
    /// The text of the model that the command line names; it may be wrong, since the page says what is.
    ///
    /// # Errors
    /// [`CliError`] if there is no such model, or it cannot be read.
    pub(crate) fn open(given: &str) -> Result<Original, CliError> {
        let source = input::source(given)?;
        let is_file = given != "-" && (Builtin::named(given).is_none() || Path::new(given).is_file());
        Ok(Original {
            given: given.to_owned(),
            path: is_file.then(|| PathBuf::from(given)),
            known: Mutex::new(source.text().as_bytes().to_vec()),
            text: source.text().to_owned(),
            source: source.name().to_owned(),
        })
    }

    /// The model as it was named on the command line.
    pub(super) fn given(&self) -> &str {
        &self.given
    }

    /// The name of the source, as in messages.
    pub(super) fn source(&self) -> &str {
        &self.source
    }

    pub(super) fn text(&self) -> &str {
        &self.text
    }

    /// The name of the file.
    pub(super) fn file(&self) -> Option<String> {
        let name = self.path.as_ref()?.file_name()?;
        Some(name.to_string_lossy().into_owned())
    }

    /// The name for files that are made of the model, without an extension.
    pub(super) fn stem(&self) -> String {
        let stem = Path::new(&self.given).file_stem().map(|stem| stem.to_string_lossy().into_owned());
        stem.filter(|_| self.given != "-").unwrap_or_else(|| "model".to_owned())
    }

    /// The directory in which commands find the tables of the model.
    pub(super) fn directory(&self) -> Option<&Path> {
        self.path.as_deref().and_then(Path::parent).filter(|directory| !directory.as_os_str().is_empty())
    }

    /// Replaces the file by this text, as a whole; a file that somebody else has written only if `force` says so.
    ///
    /// # Errors
    /// [`Unsaved`]; the file is then as it was.
    pub(super) fn save(&self, text: &str, force: bool) -> Result<(), Unsaved> {
        let path = self.path.as_ref().ok_or(Unsaved::NoFile)?;
        let name = || self.file().unwrap_or_default();
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        // A file that is gone is written anew.
        let is_changed = fs::read(path).is_ok_and(|now| now != *known);
        if is_changed && !force {
            return Err(Unsaved::Changed { name: name() });
        }
        let written =
            Target::regular(path).and_then(|place| place.write(|file| file.write_all(text.as_bytes())));
        written.map_err(|source| Unsaved::Unwritten { name: name(), source })?;
        *known = text.as_bytes().to_vec();
        Ok(())
    }
}

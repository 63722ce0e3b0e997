//! Equations that are kept from one run of a program to the next.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::{fs, io};

use pc_model::{Model, SealError, Variables, name_of, open, seal};
use serde::{Deserialize, Serialize};

use crate::files::target::Target;
use crate::motion::derived::Derived;
use crate::observer::Observer;

/// The kind of contents of a kept file.
const KIND: &str = "the equations of a model for pc run";

/// A directory of kept equations.
///
/// The name of a file says what it was derived from: the text of the model with its tables, values and choices, the form, and the
/// version of pc. Its contents carry a hash, and whatever is not as it was written is derived again.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Cache {
    directory: PathBuf,
}

/// Equations, with what was said of them when they were derived.
#[derive(Serialize, Deserialize)]
pub(crate) struct Kept {
    pub(crate) derived: Derived,
    pub(crate) remarks: Vec<String>,
    /// The result of the comparison with a second derivation.
    pub(crate) verified: Vec<String>,
}

/// Why a directory of kept equations is of no use now.
#[derive(Debug, thiserror::Error)]
enum CacheError {
    #[error("the equations in `{}` are not used: {source}", path.display())]
    Unusable { path: PathBuf, source: SealError },
    #[error("the equations in `{}` cannot be read: {source}", path.display())]
    Unreadable { path: PathBuf, source: io::Error },
    #[error("the equations cannot be kept in `{}`: {source}", path.display())]
    Unwritable { path: PathBuf, source: io::Error },
}

impl Cache {
    /// The cache in a directory, which is made when something is kept.
    pub fn new(directory: impl Into<PathBuf>) -> Cache {
        Cache { directory: directory.into() }
    }

    /// What has been kept of a model in a form, if anything has.
    pub(crate) fn find(&self, model: &Model, form: Variables, observer: &dyn Observer) -> Option<Kept> {
        let path = self.place(model, form)?;
        let bytes = match fs::read(&path) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == io::ErrorKind::NotFound => return None,
            Err(source) => {
                observer.trouble(&CacheError::Unreadable { path, source });
                return None;
            }
        };
        match open(KIND, &bytes) {
            Ok(kept) => Some(kept),
            Err(source) => {
                observer.trouble(&CacheError::Unusable { path, source });
                None
            }
        }
    }

    /// Keeps equations of a model in a form. Whoever cannot keep them has still run the model.
    pub(crate) fn keep(&self, model: &Model, form: Variables, kept: &Kept, observer: &dyn Observer) {
        let Some(path) = self.place(model, form) else { return };
        if let Err(source) = self.write(&path, kept) {
            observer.trouble(&CacheError::Unwritable { path, source });
        }
    }

    fn write(&self, path: &Path, kept: &Kept) -> io::Result<()> {
        let bytes = seal(KIND, kept).map_err(io::Error::other)?;
        fs::create_dir_all(&self.directory)?;
        Target::regular(path)?.write(|file| file.write_all(&bytes))
    }

    fn place(&self, model: &Model, form: Variables) -> Option<PathBuf> {
        let name = name_of(KIND, &(model, form)).ok()?;
        Some(self.directory.join(name).with_extension("pc"))
    }
}

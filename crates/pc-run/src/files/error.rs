//! Errors about files.

use std::io;
use std::path::{Path, PathBuf};

use crate::category::Category;
use crate::files::kept::Kept;

/// Why a result could not be written to a file.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum FileError {
    /// A file whose name does not show which format to write.
    #[error("{option} {}: the name must end in {expected}", path.display())]
    UnknownExtension {
        /// The option that names the file.
        option: &'static str,
        /// The file.
        path: PathBuf,
        /// The extensions that are accepted.
        expected: String,
    },
    /// A file that cannot be written, as was found before anything was computed.
    #[error("cannot write {}; nothing was computed", path.display())]
    Place {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A result that could not be written.
    #[error("cannot write {path}{kept}")]
    Write {
        /// The name of the file, or `standard output`.
        path: String,
        /// Where the result was kept.
        kept: Kept,
        /// Why.
        source: io::Error,
    },
}

impl FileError {
    /// A result that could not be written and is not kept anywhere.
    pub fn cannot_write(path: &Path, source: io::Error) -> FileError {
        FileError::Write { path: path.display().to_string(), kept: Kept::Nowhere, source }
    }

    /// The error for a file that cannot be written, as was found before anything was computed.
    pub fn no_place(path: &Path, source: io::Error) -> FileError {
        FileError::Place { path: path.to_owned(), source }
    }

    /// The kind of the error.
    pub fn category(&self) -> Category {
        match self {
            FileError::UnknownExtension { .. } | FileError::Place { .. } => Category::Request,
            FileError::Write { .. } => Category::Unwritten,
        }
    }
}

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
    /// A format that a result does not have.
    #[error("--format {format}: this is written as {expected}")]
    Format {
        /// The name of the format.
        format: &'static str,
        /// The formats that it has.
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
    /// A file that would be written is one of those that are read.
    #[error(
        "{} is the file {}, which is read; it would be replaced, and nothing was computed; give another name",
        path.display(), read.display()
    )]
    AlsoRead {
        /// The file, as named by the option.
        path: PathBuf,
        /// The name under which it is read.
        read: PathBuf,
    },
    /// Two results that would be written to one file.
    #[error(
        "{} is the file {}, and both would be written; nothing was computed; give another name",
        path.display(), other.display()
    )]
    Twice {
        /// The file, as named by the second option.
        path: PathBuf,
        /// The name under which it is written already.
        other: PathBuf,
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
            FileError::UnknownExtension { .. }
            | FileError::Format { .. }
            | FileError::Place { .. }
            | FileError::AlsoRead { .. }
            | FileError::Twice { .. } => Category::Request,
            FileError::Write { .. } => Category::Unwritten,
        }
    }
}

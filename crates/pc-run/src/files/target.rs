//! The place of a result, which is examined before the result is computed.

use std::fs::{self, File, OpenOptions};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use crate::files::partial;
use crate::files::partial::directory;

/// The file named by an option; none for `-`, which is standard output.
pub fn file(path: Option<&Path>) -> Option<&Path> {
    path.filter(|path| *path != Path::new("-"))
}

/// The place of a file that is replaced as a whole, or of a device that is written directly.
#[derive(Debug)]
pub struct Target {
    /// The path as given.
    pub(super) asked: PathBuf,
    /// The file to which any links lead.
    pub(super) file: PathBuf,
    /// A character device or FIFO, which is open from the beginning and written directly.
    pub(crate) device: Option<File>,
    /// The file that stays as it was, for the place of an interrupted result.
    pub(super) instead_of: Option<Original>,
}

/// A file that stays as it was.
#[derive(Debug)]
pub(super) struct Original {
    /// The path as given.
    pub(super) asked: PathBuf,
    /// The file to which any links lead.
    pub(super) file: PathBuf,
}

impl Target {
    /// The place of a regular file, existing or not, in a directory in which files can be created; leftovers
    /// of killed runs are removed.
    ///
    /// # Errors
    /// [`io::Error`] that says why the file cannot be written.
    pub fn regular(path: &Path) -> io::Result<Target> {
        match fs::metadata(path) {
            Ok(found) if !found.is_file() && !found.is_dir() => Err(refused("it is not a regular file")),
            _ => Target::new(path),
        }
    }

    /// The place of a file that does not exist yet, not even as a dangling link.
    ///
    /// # Errors
    /// As for [`regular`](Target::regular).
    pub fn fresh(path: &Path) -> io::Result<Target> {
        match fs::symlink_metadata(path) {
            Ok(_) => {
                let message = "it is there already, and nothing is replaced; give another name";
                Err(io::Error::new(ErrorKind::AlreadyExists, message))
            }
            Err(error) if error.kind() == ErrorKind::NotFound => Target::new(path),
            Err(error) => Err(error),
        }
    }

    /// The place of a regular file, or of a character device or FIFO, which is opened; opening a FIFO waits
    /// for its reader.
    ///
    /// # Errors
    /// As for [`regular`](Target::regular).
    pub fn new(path: &Path) -> io::Result<Target> {
        let (file, device) = match fs::metadata(path) {
            Ok(found) if found.is_dir() => {
                return Err(io::Error::new(ErrorKind::IsADirectory, "it is a directory"));
            }
            Ok(found) if found.is_file() => {
                // Root could write it, but the mark says that it should stay.
                if found.permissions().readonly() {
                    return Err(refused("it is read-only"));
                }
                OpenOptions::new().write(true).open(path)?;
                (fs::canonicalize(path)?, None)
            }
            Ok(found) if is_written_through(&found) => {
                (path.to_owned(), Some(OpenOptions::new().write(true).open(path)?))
            }
            Ok(_) => return Err(refused("it is neither a regular file nor a character device or FIFO")),
            Err(error) if error.kind() == ErrorKind::NotFound => (end_of_links(path)?, None),
            Err(error) => return Err(error),
        };
        if device.is_none() {
            try_directory(&file)?;
        }
        Ok(Target { asked: path.to_owned(), file, device, instead_of: None })
    }

    /// The path as given.
    pub fn path(&self) -> &Path {
        &self.asked
    }
}

/// An error unless a file can be created beside `file`.
fn try_directory(file: &Path) -> io::Result<()> {
    let directory = directory(file);
    if !fs::metadata(directory).is_ok_and(|found| found.is_dir()) {
        let message = format!("there is no directory {}", directory.display());
        return Err(io::Error::new(ErrorKind::NotFound, message));
    }
    partial::remove_leftovers(file);
    partial::make(file).map(drop)
}

/// The number of links that the system itself follows.
const MOST_LINKS: usize = 40;

/// The file to which links lead, which does not exist yet.
pub(super) fn end_of_links(path: &Path) -> io::Result<PathBuf> {
    let mut file = path.to_owned();
    for _ in 0..MOST_LINKS {
        match fs::read_link(&file) {
            Ok(target) => file = directory(&file).join(target),
            Err(_) => return Ok(file), // no link
        }
    }
    Err(refused("it is a dangling link"))
}

fn refused(message: &str) -> io::Error {
    io::Error::new(ErrorKind::PermissionDenied, message)
}

#[cfg(unix)]
fn is_written_through(found: &fs::Metadata) -> bool {
    use std::os::unix::fs::FileTypeExt;
    found.file_type().is_char_device() || found.file_type().is_fifo()
}

#[cfg(not(unix))]
fn is_written_through(_: &fs::Metadata) -> bool {
    false
}

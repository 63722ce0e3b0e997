//! Files that are written must be others than those that are read.

use std::fs;
use std::path::{Path, PathBuf};

use crate::files::error::FileError;
use crate::files::target::end_of_links;

/// Standard input, which leads to the file from which it comes, where the system has a name for it.
pub const STANDARD_INPUT: &str = "/dev/stdin";

/// What a path leads to, by whatever name and through whatever links.
#[derive(Debug, PartialEq, Eq)]
enum Identity {
    /// Device and inode of a file that is there.
    #[cfg(unix)]
    Inode(u64, u64),
    /// The path of a file that is not there yet, or whose system knows no inodes.
    Path(PathBuf),
}

impl Identity {
    /// That of a regular file, existing or not; devices and pipes may be read and written.
    fn of(path: &Path) -> Option<Identity> {
        match fs::metadata(path) {
            Ok(found) if found.is_file() => Identity::existing(path, &found),
            Ok(_) => None,
            Err(_) => {
                let file = end_of_links(path).ok()?;
                let directory = file.parent().filter(|parent| !parent.as_os_str().is_empty());
                let directory = fs::canonicalize(directory.unwrap_or(Path::new("."))).ok()?;
                Some(Identity::Path(directory.join(file.file_name()?)))
            }
        }
    }

    #[cfg(unix)]
    fn existing(_: &Path, found: &fs::Metadata) -> Option<Identity> {
        use std::os::unix::fs::MetadataExt;
        Some(Identity::Inode(found.dev(), found.ino()))
    }

    #[cfg(not(unix))]
    fn existing(path: &Path, _: &fs::Metadata) -> Option<Identity> {
        fs::canonicalize(path).ok().map(Identity::Path)
    }
}

/// Refuses to write a file that is also read, and to write two results to one file.
///
/// # Errors
/// [`FileError::AlsoRead`], [`FileError::Twice`].
pub fn keep_apart<'r, 'w>(
    read: impl IntoIterator<Item = &'r Path>,
    written: impl IntoIterator<Item = &'w Path>,
) -> Result<(), FileError> {
    let read: Vec<_> = read.into_iter().filter_map(identified).collect();
    let mut taken: Vec<(&Path, Identity)> = Vec::new();
    for (path, identity) in written.into_iter().filter_map(identified) {
        let same = |list: &[(&Path, Identity)]| {
            list.iter().find(|(_, known)| *known == identity).map(|(other, _)| other.to_path_buf())
        };
        if let Some(read) = same(&read) {
            return Err(FileError::AlsoRead { path: path.to_owned(), read });
        }
        if let Some(other) = same(&taken) {
            return Err(FileError::Twice { path: path.to_owned(), other });
        }
        taken.push((path, identity));
    }
    Ok(())
}

fn identified(path: &Path) -> Option<(&Path, Identity)> {
    Identity::of(path).map(|identity| (path, identity))
}

//! Files that are replaced whole: written beside the old one, then put in its place.

use std::fs::{self, File, Metadata};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::Builder;

/// A file that is written, with what is not on disk yet.
pub(crate) type FileWriter<'f> = BufWriter<&'f mut File>;

/// Whether a file can be at `path`: its directory is there, and it is not a directory itself.
pub(crate) fn look(path: &Path) -> io::Result<()> {
    if path.is_dir() {
        return Err(io::Error::new(io::ErrorKind::IsADirectory, "it is a directory"));
    }
    let directory = directory(path);
    match fs::metadata(directory) {
        Ok(metadata) if metadata.is_dir() => Ok(()),
        _ => {
            let message = format!("there is no directory {}", directory.display());
            Err(io::Error::new(io::ErrorKind::NotFound, message))
        }
    }
}

/// Puts what `write` writes at `path`. Until all of it is on disk, `path` is what it was.
pub(crate) fn write(path: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    write_file(path, |out| write(out))
}

/// As [`write()`], for what is not written from its beginning to its end.
pub(crate) fn write_file(
    path: &Path,
    write: impl FnOnce(&mut FileWriter<'_>) -> io::Result<()>,
) -> io::Result<()> {
    let path = followed(path);
    let mut builder = Builder::new();
    let builder = builder.prefix(".pc-").suffix(".part");
    #[cfg(unix)]
    builder.permissions(permissions(fs::metadata(&path).ok().as_ref()));
    let mut file = builder.tempfile_in(directory(&path))?;
    let mut out = BufWriter::new(file.as_file_mut());
    write(&mut out)?;
    out.flush()?;
    drop(out);
    file.as_file().sync_all()?;
    file.persist(&path)?;
    Ok(())
}

fn directory(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    }
}

/// The file itself where `path` is a link to one.
fn followed(path: &Path) -> PathBuf {
    fs::canonicalize(path).unwrap_or_else(|_| path.to_owned())
}

/// Those of the file that is replaced, else what any new file gets.
#[cfg(unix)]
fn permissions(replaced: Option<&Metadata>) -> fs::Permissions {
    use std::os::unix::fs::PermissionsExt;
    replaced.map_or_else(|| PermissionsExt::from_mode(0o666), Metadata::permissions)
}

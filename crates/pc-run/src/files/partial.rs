//! Files that are being written beside those that they will replace.
//!
//! The partial file of `a.csv` is `.a.csv.pc-a1B2c3.part`, with six random characters. A partial file is locked as long
//! as its process lives: an unlocked one was left behind by a run that was killed.

use std::ffi::{OsStr, OsString};
use std::fs::{self, File};
use std::io;
use std::path::Path;

use tempfile::{Builder, NamedTempFile};

const SUFFIX: &str = ".part";
const CHANCE: usize = 6;
/// The largest number of bytes taken from the name of the file; most systems allow 255 bytes for the whole
/// name.
const LONGEST: usize = 200;

/// Creates and locks a new file beside `file`.
pub(super) fn make(file: &Path) -> io::Result<NamedTempFile> {
    let prefix = prefix(file);
    loop {
        let mut builder = Builder::new();
        let builder = builder.prefix(&prefix).suffix(SUFFIX).rand_bytes(CHANCE);
        #[cfg(unix)]
        builder.permissions(new_file());
        let directory = directory(file);
        let made = builder.tempfile_in(directory).map_err(|error| {
            // The error itself names the partial file, which the user does not know.
            let message = format!("no file can be created in {}: {}", directory.display(), error.kind());
            io::Error::new(error.kind(), message)
        })?;
        // Without locks, no process removes it as a leftover; before the lock, one may have.
        let _ = made.as_file().try_lock();
        if made.path().exists() {
            return Ok(made);
        }
    }
}

/// Removes what killed runs have left behind beside `file`; files that cannot be removed do no harm.
pub(super) fn remove_leftovers(file: &Path) {
    let prefix = prefix(file);
    let (prefix, suffix) = (prefix.as_encoded_bytes(), SUFFIX.as_bytes());
    let Ok(entries) = fs::read_dir(directory(file)) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let name = name.as_encoded_bytes();
        let is_ours = name.len() == prefix.len() + CHANCE + suffix.len()
            && name.starts_with(prefix)
            && name.ends_with(suffix)
            && entry.file_type().is_ok_and(|kind| kind.is_file());
        let path = entry.path();
        if is_ours && File::open(&path).is_ok_and(|left| left.try_lock().is_ok()) {
            let _ = fs::remove_file(&path);
        }
    }
}

/// The directory that contains a file.
pub(super) fn directory(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if parent != Path::new("") => parent,
        _ => Path::new("."),
    }
}

fn prefix(file: &Path) -> OsString {
    let name = file.file_name().unwrap_or(OsStr::new("")).to_owned();
    let mut prefix = OsString::from(".");
    if name.len() > LONGEST {
        prefix.push(format!("{:08x}", crc32fast::hash(name.as_encoded_bytes())));
    } else {
        prefix.push(name);
    }
    prefix.push(".pc-");
    prefix
}

/// The mode of any new file, before the user's umask is applied.
#[cfg(unix)]
fn new_file() -> fs::Permissions {
    use std::os::unix::fs::PermissionsExt;
    PermissionsExt::from_mode(0o666)
}

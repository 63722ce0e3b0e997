//! Files that are replaced as a whole: a new file is written beside the old one and then put in its place.

use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, BufWriter, ErrorKind, Seek, Write};
use std::path::Path;

use tempfile::NamedTempFile;

use crate::files::partial;
use crate::files::target::Target;

/// A buffered writer to a file.
pub type FileWriter<'f> = BufWriter<&'f mut File>;

impl Target {
    /// Puts the output of `write` at this place. Until all of it is on disk, an existing file stays unchanged.
    ///
    /// # Errors
    /// [`io::Error`]
    pub fn write(&self, write: impl FnOnce(&mut FileWriter<'_>) -> io::Result<()>) -> io::Result<()> {
        match &self.device {
            Some(device) => fill(&mut device.try_clone()?, write),
            None => self.replace(write).map_err(|(error, _)| error),
        }
    }

    /// As [`write`](Target::write), for a file that did not exist; if the file has been created in the
    /// meantime, it is left as it is.
    ///
    /// # Errors
    /// [`io::Error`]
    pub fn create(&self, write: impl FnOnce(&mut FileWriter<'_>) -> io::Result<()>) -> io::Result<()> {
        let mut made = partial::make(&self.file)?;
        fill(made.as_file_mut(), write)?;
        made.as_file().sync_all()?;
        made.persist_noclobber(&self.file).map(drop).map_err(|error| error.error)
    }

    /// As [`write`](Target::write), for a regular file; an error is returned together with the part that could
    /// be written.
    pub(super) fn replace(
        &self,
        write: impl FnOnce(&mut FileWriter<'_>) -> io::Result<()>,
    ) -> Result<(), (io::Error, Option<NamedTempFile>)> {
        let mut made = partial::make(&self.file).map_err(|error| (error, None))?;
        match fill(made.as_file_mut(), write) {
            Ok(()) => self.put(made),
            Err(error) => Err((error, Some(made))),
        }
    }

    /// Moves a file that was made beside this place to the place itself.
    pub(super) fn put(&self, mut made: NamedTempFile) -> Result<(), (io::Error, Option<NamedTempFile>)> {
        if self.instead_of.is_some() {
            return self.put_anew(made);
        }
        let replaced = made.as_file().sync_all().and_then(|()| match fs::metadata(&self.file) {
            Err(_) => Ok(true),
            Ok(old) => take_after(made.as_file(), &old),
        });
        match replaced {
            Ok(true) => made.persist(&self.file).map(drop).map_err(|error| (error.error, Some(error.file))),
            Ok(false) => overwrite(made.as_file_mut(), &self.file).map_err(|error| (error, Some(made))),
            Err(error) => Err((error, Some(made))),
        }
    }

    /// Moves a file to this place unless another one is there; as far as this is permitted, it is seen by whoever sees the one
    /// that stays as it was.
    fn put_anew(&self, made: NamedTempFile) -> Result<(), (io::Error, Option<NamedTempFile>)> {
        if let Ok(original) = fs::metadata(self.original()) {
            let _ = take_after(made.as_file(), &original);
        }
        if let Err(error) = made.as_file().sync_all() {
            return Err((error, Some(made)));
        }
        made.persist_noclobber(&self.file).map(drop).map_err(|failed| {
            let error = match failed.error.kind() {
                ErrorKind::AlreadyExists => io::Error::new(ErrorKind::AlreadyExists, "it is there already"),
                _ => failed.error,
            };
            (error, Some(failed.file))
        })
    }
}

/// Writes to a file; after a failure, no attempt is made to write the rest.
pub(super) fn fill(
    file: &mut File,
    write: impl FnOnce(&mut FileWriter<'_>) -> io::Result<()>,
) -> io::Result<()> {
    let mut out = BufWriter::new(file);
    let written = write(&mut out).and_then(|()| out.flush());
    drop(out.into_parts());
    written
}

/// Gives a file the owner and mode of the file that it replaces; false if this is not permitted.
#[cfg(unix)]
fn take_after(made: &File, old: &Metadata) -> io::Result<bool> {
    use std::os::unix::fs::{MetadataExt, fchown};
    let new = made.metadata()?;
    if (new.uid(), new.gid()) != (old.uid(), old.gid())
        && fchown(made, Some(old.uid()), Some(old.gid())).is_err()
    {
        return Ok(false);
    }
    made.set_permissions(old.permissions())?;
    Ok(true)
}

#[cfg(not(unix))]
fn take_after(_: &File, _: &Metadata) -> io::Result<bool> {
    Ok(true)
}

/// Copies the complete file into a file of another user, who remains its owner.
fn overwrite(made: &mut File, file: &Path) -> io::Result<()> {
    let mut old = OpenOptions::new().write(true).truncate(true).open(file)?;
    made.rewind()?;
    io::copy(made, &mut old)?;
    old.sync_all()
}

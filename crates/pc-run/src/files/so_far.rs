//! The place of what there is of a result whose computation was interrupted.

use std::fs;
use std::path::{Path, PathBuf};

use crate::files::target::{Original, Target};

impl Target {
    /// The place of what there is of a result that was interrupted: FILE.partial, which is never put over another file, so that
    /// FILE stays as it was. None for a device, which takes as much as there is.
    pub fn so_far(&self) -> Option<Target> {
        if self.device.is_some() {
            return None;
        }
        // Beside the file itself, not beside a link to it: within a directory it is moved as a whole.
        let is_link = fs::symlink_metadata(&self.asked).is_ok_and(|found| found.is_symlink());
        let asked = if is_link { &self.file } else { &self.asked };
        let instead_of = Original { asked: self.asked.clone(), file: self.file.clone() };
        Some(Target {
            asked: beside(asked),
            file: beside(&self.file),
            device: None,
            instead_of: Some(instead_of),
        })
    }

    /// The path as given of the file that stays as it was, if this is the place of an interrupted result.
    pub fn instead_of(&self) -> Option<&Path> {
        self.instead_of.as_ref().map(|original| original.asked.as_path())
    }

    /// The file that was to be written.
    pub(super) fn original(&self) -> &Path {
        self.instead_of.as_ref().map_or(&self.file, |original| &original.file)
    }
}

/// FILE.partial, which holds what there is of FILE.
pub(crate) fn beside(file: &Path) -> PathBuf {
    let mut name = file.as_os_str().to_owned();
    name.push(".partial");
    PathBuf::from(name)
}

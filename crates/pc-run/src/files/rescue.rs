//! Rescues a result that cannot be written to its destination.

use std::borrow::Cow;
use std::io::{self, Read, Seek, SeekFrom};
use std::path::PathBuf;

use tempfile::{Builder, NamedTempFile};

use crate::files::atomic::{FileWriter, fill};
use crate::files::error::FileError;
use crate::files::kept::Kept;
use crate::files::so_far::beside;
use crate::files::target::Target;

impl Target {
    /// Writes a result to its place or, failing that, to the directory of temporary files; if this fails too
    /// and `is_lines` says that single lines are of use, keeps the part that could be written beside the
    /// file.
    ///
    /// # Errors
    /// [`FileError::Write`], which says where the result was kept.
    pub fn write_or_keep(
        &self,
        is_lines: bool,
        write: impl Fn(&mut FileWriter<'_>) -> io::Result<()>,
    ) -> Result<(), FileError> {
        let (source, part) = match &self.device {
            Some(_) => match self.write(&write) {
                Ok(()) => return Ok(()),
                Err(error) => (error, None),
            },
            None => match self.replace(&write) {
                Ok(()) => return Ok(()),
                Err(failed) => failed,
            },
        };
        let kept = elsewhere(&self.name(), &write).map(Kept::Elsewhere).or_else(|| {
            part.filter(|_| is_lines).and_then(|part| self.keep_lines(part)).map(Kept::Beginning)
        });
        Err(FileError::Write {
            path: self.asked.display().to_string(),
            kept: kept.unwrap_or_default(),
            source,
        })
    }

    /// Keeps the complete lines of the part that could be written in FILE.partial or, if that file exists, in the directory of
    /// temporary files.
    pub(super) fn keep_lines(&self, mut part: NamedTempFile) -> Option<PathBuf> {
        let end = end_of_lines(part.as_file_mut()).ok().filter(|&end| end > 0)?;
        part.as_file().set_len(end).ok()?;
        let path = beside(self.original());
        let mut part = match part.persist_noclobber(&path) {
            Ok(_) => return Some(path),
            Err(failed) => failed.file,
        };
        part.rewind().ok()?;
        elsewhere(&self.name(), |out| io::copy(&mut part, out).map(drop))
    }

    /// The name of the file that was to be written.
    fn name(&self) -> Cow<'_, str> {
        self.original().file_name().map_or(Cow::Borrowed("result"), |name| name.to_string_lossy())
    }
}

/// The largest number of bytes taken from the name.
const LONGEST: usize = 100;

/// Writes a result to a new file in the directory of temporary files, if possible, and returns its path.
pub fn elsewhere(name: &str, write: impl FnOnce(&mut FileWriter<'_>) -> io::Result<()>) -> Option<PathBuf> {
    let end = &name[name.ceil_char_boundary(name.len().saturating_sub(LONGEST))..];
    let mut file = Builder::new().prefix("pc-").suffix(&format!("-{end}")).tempfile().ok()?;
    fill(file.as_file_mut(), write).and_then(|()| file.as_file().sync_all()).ok()?;
    Some(file.keep().ok()?.1)
}

/// The number of bytes up to the end of the last complete line.
fn end_of_lines(file: &mut (impl Read + Seek)) -> io::Result<u64> {
    const BLOCK: u64 = 1 << 16;
    let mut end = file.seek(SeekFrom::End(0))?;
    while end > 0 {
        let start = end.saturating_sub(BLOCK);
        file.seek(SeekFrom::Start(start))?;
        let mut block = Vec::new();
        file.by_ref().take(end - start).read_to_end(&mut block)?;
        if let Some(place) = block.iter().rposition(|&byte| byte == b'\n') {
            return Ok(start + place as u64 + 1);
        }
        end = start;
    }
    Ok(0)
}

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    #[test]
    fn lines_are_kept_whole() {
        let end = |text: &[u8]| end_of_lines(&mut Cursor::new(text)).expect("read");
        assert_eq!(end(b"a,b\n1,2\n3"), 8);
        assert_eq!(end(b"a,b\n1,2\n"), 8);
        assert_eq!(end(b"a,b"), 0);
        assert_eq!(end(b""), 0);
        assert_eq!(end(&[b"a\n".as_slice(), &[b'1'; 200_000]].concat()), 2);
    }
}

//! Reads texts up to a maximum size.

use std::fs::File;
use std::io::{self, ErrorKind, Read};
use std::path::Path;

/// The largest number of bytes that are read from a model or from a table of an input: 64 MiB. Reading a device,
/// which has no end, takes no more memory than this.
pub const MOST_BYTES: u64 = 64 << 20;

/// The whole contents of a model or a table of an input.
///
/// # Errors
/// [`ErrorKind::FileTooLarge`] if there are more than [`MOST_BYTES`] bytes; any error from the reader.
pub fn read_bounded(from: impl Read) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    from.take(MOST_BYTES + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > MOST_BYTES {
        let message = format!("it has more than {} MiB, the most that is read", MOST_BYTES >> 20);
        return Err(io::Error::new(ErrorKind::FileTooLarge, message));
    }
    Ok(bytes)
}

/// The whole contents of a file.
///
/// # Errors
/// As for [`read_bounded`], and any error in opening the file.
pub fn read_file_bounded(path: impl AsRef<Path>) -> io::Result<Vec<u8>> {
    read_bounded(File::open(path)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn endless_input_is_not_read_to_the_end() {
        let error = read_bounded(io::repeat(b'#')).expect_err("endless");
        assert_eq!(error.kind(), ErrorKind::FileTooLarge);
        assert_eq!(error.to_string(), "it has more than 64 MiB, the most that is read");
        let most = read_bounded(io::repeat(0).take(MOST_BYTES)).expect("just so much");
        assert_eq!(most.len() as u64, MOST_BYTES);
    }
}

//! What was derived, as bytes that can be kept: with the version that wrote them, and a hash of all of them.
//!
//! ```text
//! offset  length
//!      0       8  "pc-code\n"
//!      8       4  LAYOUT, little-endian
//!     12      32  SHA-256 of all that follows
//!     44          the kind of contents, then the contents, as postcard writes them
//! ```
//!
//! Nothing is read before the hash is found to be right. The hash protects against damage, not against somebody who
//! computes it anew: what is read is still checked where unsafe code relies on it, by [`pc_expr::Program`].

use serde::Serialize;
use serde::de::DeserializeOwned;
use sha2::{Digest, Sha256};

const MAGIC: &[u8; 8] = b"pc-code\n";

/// Is raised whenever other bytes are written for the same model; other numbers are not read.
const LAYOUT: u32 = 1;

const HASH: usize = 12;
const CONTENTS: usize = HASH + 32;

/// Why bytes cannot be used.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum SealError {
    /// The bytes do not begin as they should.
    #[error("this is not a derived model that pc has saved")]
    NotSealed,
    /// Another version has written them.
    #[error("it was saved in layout {found}, but this version reads layout {read}: derive it again")]
    Layout {
        /// The layout of the bytes.
        found: u32,
        /// The layout that is read.
        read: u32,
    },
    /// The bytes are not those that were written.
    #[error("it is damaged: its contents do not have the hash that was saved with them")]
    Damaged,
    /// The contents are of another kind.
    #[error("it contains {found}, not {expected}")]
    Kind {
        /// The kind of the contents.
        found: String,
        /// The kind that is needed.
        expected: &'static str,
    },
    /// The contents cannot be read.
    #[error("it cannot be read: {reason}")]
    Unreadable {
        /// What the reader says.
        reason: String,
    },
}

/// The bytes of `contents`, which are of this kind.
///
/// # Errors
/// [`SealError::Unreadable`] for contents that cannot be written, such as sequences of unknown length.
pub fn seal<T: Serialize>(kind: &'static str, contents: &T) -> Result<Vec<u8>, SealError> {
    let mut bytes = [MAGIC.as_slice(), &LAYOUT.to_le_bytes(), &[0; CONTENTS - HASH]].concat();
    bytes.extend(postcard::to_stdvec(&(kind, contents)).map_err(|error| unreadable(&error))?);
    let hash = Sha256::digest(&bytes[CONTENTS..]);
    bytes[HASH..CONTENTS].copy_from_slice(&hash);
    Ok(bytes)
}

/// The contents of bytes that [`seal`] has made.
///
/// # Errors
/// [`SealError`].
pub fn open<T: DeserializeOwned>(kind: &'static str, bytes: &[u8]) -> Result<T, SealError> {
    let (head, contents) = bytes.split_at_checked(CONTENTS).ok_or(SealError::NotSealed)?;
    let numbered = head.strip_prefix(MAGIC).ok_or(SealError::NotSealed)?;
    let (layout, hash) = numbered.split_first_chunk().ok_or(SealError::NotSealed)?;
    let found = u32::from_le_bytes(*layout);
    if found != LAYOUT {
        return Err(SealError::Layout { found, read: LAYOUT });
    }
    if Sha256::digest(contents).as_slice() != hash {
        return Err(SealError::Damaged);
    }
    let (found, contents): (String, _) =
        postcard::take_from_bytes(contents).map_err(|error| unreadable(&error))?;
    if found != kind {
        return Err(SealError::Kind { found, expected: kind });
    }
    postcard::from_bytes(contents).map_err(|error| unreadable(&error))
}

/// The SHA-256 of contents of this kind in hexadecimal digits, with the layout: a name for what is derived from them.
///
/// # Errors
/// As for [`seal`].
pub fn name_of<T: Serialize>(kind: &'static str, contents: &T) -> Result<String, SealError> {
    let sealed = seal(kind, &(LAYOUT, env!("CARGO_PKG_VERSION"), contents))?;
    Ok(sealed[HASH..CONTENTS].iter().map(|byte| format!("{byte:02x}")).collect())
}

fn unreadable(error: &postcard::Error) -> SealError {
    SealError::Unreadable { reason: error.to_string() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_sealed_is_opened() {
        let contents = (vec![0.1, f64::NEG_INFINITY], "η".to_owned());
        let bytes = seal("numbers", &contents).unwrap();
        assert_eq!(open::<(Vec<f64>, String)>("numbers", &bytes), Ok(contents));
    }

    #[test]
    fn every_changed_or_missing_byte_is_noticed() {
        let bytes = seal("numbers", &vec![1.0, 2.0, 3.0]).unwrap();
        for place in 0..bytes.len() {
            let mut changed = bytes.clone();
            changed[place] ^= 1;
            assert!(open::<Vec<f64>>("numbers", &changed).is_err(), "byte {place}");
            assert!(open::<Vec<f64>>("numbers", &bytes[..place]).is_err(), "the first {place} bytes");
        }
    }

    #[test]
    fn contents_of_another_kind_are_refused() {
        let bytes = seal("numbers", &vec![1.0]).unwrap();
        let error = open::<Vec<f64>>("names", &bytes).unwrap_err();
        assert_eq!(error.to_string(), "it contains numbers, not names");
    }

    #[test]
    fn another_layout_is_refused_before_the_contents_are_read() {
        let mut bytes = seal("numbers", &vec![1.0]).unwrap();
        bytes[8] = 99;
        let error = open::<Vec<f64>>("numbers", &bytes).unwrap_err();
        assert_eq!(
            error.to_string(),
            "it was saved in layout 99, but this version reads layout 1: derive it again"
        );
    }
}

//! A part of a system with the wrong number of entries.

/// A part of the system with the wrong number of entries.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{what} has {found} entries where {expected} are needed")]
pub struct ShapeError {
    /// The part.
    pub what: &'static str,
    /// Its length.
    pub found: usize,
    /// The required number.
    pub expected: usize,
}

/// Returns an error unless `found` equals `expected`.
pub(crate) fn shape(what: &'static str, found: usize, expected: usize) -> Result<(), ShapeError> {
    if found == expected { Ok(()) } else { Err(ShapeError { what, found, expected }) }
}

//! Exit codes that errors of several kinds share.

/// A wrong command line.
pub(crate) const USAGE: u8 = 2;

/// A result that could not be written.
pub(crate) const UNWRITTEN: u8 = 6;

//! Exit codes that errors of several kinds share.

/// A wrong command line.
pub(crate) const USAGE: u8 = 2;

//! Exit codes that errors of several kinds share.

/// Two motions that were compared are not the same.
pub(crate) const DIFFERENT: u8 = 1;

/// A wrong command line.
pub(crate) const USAGE: u8 = 2;

/// The request is not defined for this model.
pub(crate) const INCONSISTENT: u8 = 4;

/// A numerical method did not converge or did not reach its end.
pub(crate) const FAILED: u8 = 5;

/// A result that could not be written.
pub(crate) const UNWRITTEN: u8 = 6;

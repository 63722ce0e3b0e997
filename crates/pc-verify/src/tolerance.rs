//! The tolerance of the comparison.

/// The largest difference of two values that agree, relative to the size of their terms.
///
/// Both routes sum some hundred terms in different orders and lead them through linear equations: some thousand roundings of
/// the largest term, and the amplification of rounding is measured at each state. A missing term or a wrong sign is an
/// error of order one of its own size, which at random states is seldom below 1e-6 of the largest.
pub const TOLERANCE: f64 = 1e-12;

/// A difference that ordinary rounding makes. Where one is larger, it is measured how far rounding is amplified.
pub(crate) const ORDINARY: f64 = 1e-14;

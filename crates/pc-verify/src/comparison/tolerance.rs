//! The tolerance of the comparison.

/// The largest difference of two values that agree, relative to the size of their terms.
///
/// Both routes sum some hundred terms in different orders and propagate them through linear equations: the
/// result has some thousand rounding errors of the largest term, and the amplification of rounding errors is
/// measured at each state. A missing term or a wrong sign is an error of the order of that term, which at
/// random states is rarely below 1e-6 of the largest.
pub const TOLERANCE: f64 = 1e-12;

/// The greatest difference that ordinary rounding errors cause. For a larger difference, the amplification of
/// rounding errors is measured.
pub(crate) const ORDINARY: f64 = 1e-14;

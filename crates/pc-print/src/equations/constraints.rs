//! Constraints in words.

use pc_nonholo::Kind;

/// The kind of a constraint in words.
pub fn kind_in_words(kind: Kind) -> &'static str {
    match kind {
        Kind::Position => "holonomic",
        Kind::Integrable => "integrable, so holonomic",
        Kind::Nonholonomic { .. } => "nonholonomic",
        Kind::Nonlinear => "nonholonomic, not affine in the velocities",
    }
}

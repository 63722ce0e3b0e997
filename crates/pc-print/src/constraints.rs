//! Constraints in words.

use pc_nonholo::Kind;

/// What a constraint does.
pub fn kind_in_words(kind: Kind) -> &'static str {
    match kind {
        Kind::Position => "holonomic",
        Kind::Integrable => "holonomic in disguise: integrable",
        Kind::Nonholonomic { .. } => "nonholonomic",
        Kind::Nonlinear => "nonholonomic, not affine in the velocities",
    }
}

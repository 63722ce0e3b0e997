//! Constraints in words.

use pc_nonholo::ConstraintKind;

/// The kind of a constraint in words.
pub fn kind_in_words(kind: ConstraintKind) -> &'static str {
    match kind {
        ConstraintKind::Position => "holonomic",
        ConstraintKind::Integrable => "integrable, so holonomic",
        ConstraintKind::Nonholonomic { .. } => "nonholonomic",
        ConstraintKind::Nonlinear => "nonholonomic, not affine in the velocities",
    }
}

//! Constraints in print.

use pc_mech::{Constraint, Style};
use pc_nonholo::Kind;
use serde_json::{Value, json};

use crate::derived::Derived;

/// What vanishes, a line a constraint.
pub(crate) fn constraints(derived: &Derived<'_>) -> Vec<String> {
    let lines = derived.constraints.iter().map(|(constraint, kind)| {
        let (left, kind) = (derived.vanishing(constraint).display(Style::Book), kind_in_words(*kind));
        format!("{}: {left} = 0   ({kind})", constraint.name())
    });
    lines.collect()
}

/// What a constraint does.
pub fn kind_in_words(kind: Kind) -> &'static str {
    match kind {
        Kind::Position => "holonomic",
        Kind::Integrable => "holonomic in disguise: integrable",
        Kind::Nonholonomic { .. } => "nonholonomic",
        Kind::Nonlinear => "nonholonomic, not affine in the velocities",
    }
}

/// The constraints for programs.
pub(crate) fn constraint_objects(derived: &Derived<'_>) -> Value {
    let object = |(constraint, kind): &(Constraint<'_>, Kind)| {
        json!({
            "name": constraint.name(),
            "expression": derived.vanishing(constraint).to_string(),
            "kind": kind_in_words(*kind),
        })
    };
    derived.constraints.iter().map(object).collect()
}

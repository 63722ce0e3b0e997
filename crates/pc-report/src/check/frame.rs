//! The frame and its brackets, in words.

use pc_algebra::{AlgebraError, LieAlgebra};
use pc_analysis::{FrameConstraints, FrameFacts, QuasiVelocityKind};
use pc_mech::{StructureCoefficients, Style};
use pc_print::{recognised, wrapped};
use serde_json::{Value, json};

/// The functions that the constraints of a frame keep constant, written with their variables.
fn of(of_time: bool) -> &'static str {
    if of_time { "f(x, t)" } else { "f(x)" }
}

/// The constraints that the frame imposes, in words.
pub(super) fn constraints(frame: &FrameFacts<'_>) -> Option<String> {
    frame.constraints.as_ref().map(|constraints| match constraints {
        FrameConstraints::Integrable { count: 1, of_time } => {
            format!("1 integrable constraint {} = const holds by the frame", of(*of_time))
        }
        FrameConstraints::Integrable { count, of_time } => {
            format!("{count} integrable constraints {} = const hold by the frame", of(*of_time))
        }
        FrameConstraints::NotIntegrable { pair: [r, s] } => {
            format!("the velocities are not integrable: [{r}, {s}] is not one of them")
        }
    })
}

/// The holonomic quasi-velocities, on lines of `width` characters; none if the frame does not determine which
/// quasi-velocities are holonomic.
pub(super) fn holonomic(frame: &FrameFacts<'_>, width: usize) -> Vec<String> {
    if frame.lagrangian && !frame.holonomy.is_empty() {
        return vec!["all, the velocities of the coordinates".to_owned()];
    }
    let holonomic = frame.holonomy.iter().filter_map(|(name, rate)| match rate {
        QuasiVelocityKind::RateOf(Some(pi)) => Some(format!("{name} = d({})/dt", pi.display(Style::Book))),
        QuasiVelocityKind::RateOf(None) | QuasiVelocityKind::RateOfNothing(_) => None,
    });
    let unknown = frame.holonomy.iter().filter(|(_, rate)| matches!(rate, QuasiVelocityKind::RateOf(None)));
    let unknown: Vec<&str> = unknown.map(|(name, _)| name.as_str()).collect();
    let unknown = match unknown.as_slice() {
        [] => None,
        [one] => Some(format!("{one}, the rate of a function that is not found")),
        all => Some(format!("{}, the rates of functions that are not found", all.join(", "))),
    };
    let lines = wrapped(holonomic.chain(unknown), width);
    if lines.is_empty() && !frame.holonomy.is_empty() { vec!["none".to_owned()] } else { lines }
}

/// `frame_constraints` and `holonomic` as JSON.
pub(super) fn objects(frame: &FrameFacts<'_>) -> (Value, Value) {
    let holonomic: Vec<Value> = frame
        .holonomy
        .iter()
        .map(|(name, rate)| match rate {
            QuasiVelocityKind::RateOf(pi) => {
                let coordinate = pi.map(|pi| pi.display(Style::Book));
                json!({ "name": name, "holonomic": true, "coordinate": coordinate })
            }
            QuasiVelocityKind::RateOfNothing(pair) => {
                json!({ "name": name, "holonomic": false, "bracket": pair })
            }
        })
        .collect();
    let constraints = match &frame.constraints {
        None => json!({ "count": 0 }),
        Some(FrameConstraints::Integrable { count, of_time }) => {
            json!({ "count": count, "integrable": true, "of": of(*of_time) })
        }
        Some(FrameConstraints::NotIntegrable { pair }) => json!({ "integrable": false, "bracket": pair }),
    };
    (constraints, json!(holonomic))
}

/// The algebra of the operators in words; `constant` is the phrase for constant structure coefficients.
pub(super) fn algebra(structure: &StructureCoefficients<'_>, constant: &str) -> String {
    if let Some(name) = recognised(structure) {
        return format!("{name}, {constant}");
    }
    if structure.nonzero().next().is_none() {
        return "commutative".to_owned();
    }
    if !structure.are_constant() {
        return "none: the structure coefficients depend on the state or on time".to_owned();
    }
    let facts = structure.lie_algebra().and_then(|algebra| facts(&algebra).ok());
    let facts = facts.map_or_else(String::new, |facts| format!(": {facts}"));
    format!("{constant}, not one of the catalogue{facts}")
}

/// The kind of an algebra, its rank and its index, in words.
fn facts(algebra: &LieAlgebra) -> Result<String, AlgebraError> {
    let kind = if algebra.is_abelian() {
        "commutative except for time"
    } else if algebra.is_nilpotent()? {
        "nilpotent"
    } else if algebra.is_solvable()? {
        "solvable"
    } else if algebra.is_semisimple()? {
        "semisimple"
    } else {
        "neither solvable nor semisimple"
    };
    Ok(format!("{kind}, rank {}, index {}", algebra.rank()?, algebra.index()?))
}

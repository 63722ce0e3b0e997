//! What the frame and its brackets say before any Lagrangian does.

use pc_algebra::{AlgebraError, Holonomy, Integrability, LieAlgebra};
use pc_mech::{Neighbourhood, StructureCoefficients, Style, System};
use pc_print::recognised;
use serde_json::{Value, json};

use crate::report::text::wrapped;

/// Quasi-velocities that are velocities of something, and functions that no motion changes.
#[derive(Clone, Debug)]
pub(super) struct FrameFacts {
    /// Of each quasi-velocity, if the frame determines it: rank b = k.
    holonomy: Vec<(String, Rate)>,
    /// Whether η = ẋ.
    lagrangian: bool,
    /// What holds by the frame alone, if n > rank b.
    constraints: Option<Constraints>,
}

/// Whether a quasi-velocity is dπ/dt.
#[derive(Clone, Debug)]
enum Rate {
    /// Of this π, or of one that is not elementary to find.
    Of(Option<String>),
    /// Of nothing, because of the bracket of this pair.
    OfNothing([String; 2]),
}

/// The n − rank b constraints that a frame stands for.
#[derive(Clone, Debug)]
enum Constraints {
    /// So many can be written f = const.
    Integrable { count: usize, of: &'static str },
    /// Not all can, because of the bracket of this pair.
    NotIntegrable { pair: [String; 2] },
}

impl FrameFacts {
    /// What the frame of a system says near a point.
    pub(super) fn of<'g>(system: &System<'g>, near: &Neighbourhood<'g>) -> FrameFacts {
        let (frame, structure, eta) = (system.frame(), system.structure(), system.quasi_velocities());
        let (n, k, rank) = (frame.coordinates().len(), eta.len(), frame.rank());
        let named = |s: usize| if s == 0 { "t".to_owned() } else { eta[s - 1].to_string() };
        let lagrangian = frame.velocities(eta) == eta;
        let rate = |m: usize| {
            if lagrangian {
                return Rate::Of(Some(frame.coordinates()[m - 1].to_string()));
            }
            match frame.holonomy(m, structure) {
                Holonomy::Holonomic { coordinate } => Rate::Of(coordinate.map(|pi| pi.display(Style::Book))),
                Holonomy::Nonholonomic { pair: (r, s) } => Rate::OfNothing([named(r), named(s)]),
            }
        };
        let determined = rank == k && structure.operators() == k;
        let moves = frame.b0().iter().any(|entry| !entry.is_zero())
            || frame.b().entries().iter().any(|entry| entry.depends_on(frame.time()));
        let constraints = (rank < n).then(|| match frame.integrability(near) {
            Integrability::Integrable { dimension } => {
                Constraints::Integrable { count: n - dimension, of: if moves { "f(x, t)" } else { "f(x)" } }
            }
            Integrability::NotIntegrable { pair: (r, s), .. } => {
                Constraints::NotIntegrable { pair: [named(r), named(s)] }
            }
        });
        FrameFacts {
            holonomy: (1..=k).filter(|_| determined).map(|m| (named(m), rate(m))).collect(),
            lagrangian,
            constraints,
        }
    }

    /// The constraints in words.
    pub(super) fn constraints(&self) -> Option<String> {
        self.constraints.as_ref().map(|constraints| match constraints {
            Constraints::Integrable { count: 1, of } => {
                format!("1 integrable constraint {of} = const holds by the frame")
            }
            Constraints::Integrable { count, of } => {
                format!("{count} integrable constraints {of} = const hold by the frame")
            }
            Constraints::NotIntegrable { pair: [r, s] } => {
                format!("the velocities are not integrable: [{r}, {s}] is not one of them")
            }
        })
    }

    /// Which quasi-velocities are holonomic, in lines of `width` characters; none where the frame leaves it open.
    pub(super) fn holonomic(&self, width: usize) -> Vec<String> {
        if self.lagrangian && !self.holonomy.is_empty() {
            return vec!["all, the velocities of the coordinates".to_owned()];
        }
        let holonomic = self.holonomy.iter().filter_map(|(name, rate)| match rate {
            Rate::Of(Some(pi)) => Some(format!("{name} = d({pi})/dt")),
            Rate::Of(None) => Some(format!("{name} = dπ/dt")),
            Rate::OfNothing(_) => None,
        });
        let lines = wrapped(holonomic, width);
        if lines.is_empty() && !self.holonomy.is_empty() { vec!["none".to_owned()] } else { lines }
    }

    /// `frame_constraints` and `holonomic` for programs.
    pub(super) fn objects(&self) -> (Value, Value) {
        let holonomic: Vec<Value> = self
            .holonomy
            .iter()
            .map(|(name, rate)| match rate {
                Rate::Of(pi) => json!({ "name": name, "holonomic": true, "coordinate": pi }),
                Rate::OfNothing(pair) => json!({ "name": name, "holonomic": false, "bracket": pair }),
            })
            .collect();
        let constraints = match &self.constraints {
            None => json!({ "count": 0 }),
            Some(Constraints::Integrable { count, of }) => {
                json!({ "count": count, "integrable": true, "of": of })
            }
            Some(Constraints::NotIntegrable { pair }) => json!({ "integrable": false, "bracket": pair }),
        };
        (constraints, json!(holonomic))
    }
}

/// The algebra of the operators in words, of which `constant` says that they are.
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

/// What kind of algebra it is, its rank and its index.
fn facts(algebra: &LieAlgebra) -> Result<String, AlgebraError> {
    let kind = if algebra.is_abelian() {
        "commutative but for time"
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

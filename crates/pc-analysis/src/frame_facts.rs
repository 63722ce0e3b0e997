//! Properties of the frame and its brackets, which need no Lagrangian.

use pc_algebra::{Holonomy, Integrability};
use pc_mech::{Expr, Neighbourhood, System};

/// The quasi-velocities that are rates of functions, and the functions that are constant along every motion.
#[derive(Clone, Debug)]
pub struct FrameFacts<'g> {
    /// The kind of each quasi-velocity, if the frame determines it, that is, if rank b = k.
    pub holonomy: Vec<(String, QuasiVelocityKind<'g>)>,
    /// Whether η = ẋ.
    pub lagrangian: bool,
    /// The constraints that the frame alone imposes, if n > rank b.
    pub constraints: Option<FrameConstraints>,
}

/// Whether a quasi-velocity is the rate dπ/dt of a function π.
#[derive(Clone, Debug)]
pub enum QuasiVelocityKind<'g> {
    /// The quasi-velocity is the rate of this π; `None` if π was not found.
    RateOf(Option<Expr<'g>>),
    /// The quasi-velocity is not the rate of a function, as the bracket of this pair shows.
    RateOfNothing([String; 2]),
}

/// The n − rank b constraints that a frame imposes.
#[derive(Clone, Debug)]
pub enum FrameConstraints {
    /// All the constraints can be written in the form f = const.
    Integrable {
        /// The number of constraints.
        count: usize,
        /// Whether the functions f depend on time.
        of_time: bool,
    },
    /// Not all the constraints can be written in the form f = const, as the bracket of this pair shows.
    NotIntegrable {
        /// Names of two quasi-velocities, or `t`.
        pair: [String; 2],
    },
}

impl<'g> FrameFacts<'g> {
    /// The properties of the frame of a system near a point.
    pub fn of(system: &System<'g>, near: &Neighbourhood<'g>) -> FrameFacts<'g> {
        let (frame, structure, eta) = (system.frame(), system.structure(), system.quasi_velocities());
        let (n, k, rank) = (frame.coordinates().len(), eta.len(), frame.rank());
        let named = |s: usize| if s == 0 { "t".to_owned() } else { eta[s - 1].to_string() };
        let lagrangian = frame.velocities(eta) == eta;
        let rate = |m: usize| {
            if lagrangian {
                return QuasiVelocityKind::RateOf(Some(frame.coordinates()[m - 1]));
            }
            match frame.holonomy(m, structure) {
                Holonomy::Holonomic { coordinate } => QuasiVelocityKind::RateOf(coordinate),
                Holonomy::Nonholonomic { pair: (r, s) } => {
                    QuasiVelocityKind::RateOfNothing([named(r), named(s)])
                }
            }
        };
        let determined = rank == k && structure.operators() == k;
        let moves = frame.b0().iter().any(|entry| !entry.is_zero())
            || frame.b().nonzero_entries().iter().any(|entry| entry.depends_on(frame.time()));
        let constraints = (rank < n).then(|| match frame.integrability(near) {
            Integrability::Integrable { dimension } => {
                FrameConstraints::Integrable { count: n - dimension, of_time: moves }
            }
            Integrability::NotIntegrable { pair: (r, s), .. } => {
                FrameConstraints::NotIntegrable { pair: [named(r), named(s)] }
            }
        });
        FrameFacts {
            holonomy: (1..=k).filter(|_| determined).map(|m| (named(m), rate(m))).collect(),
            lagrangian,
            constraints,
        }
    }
}

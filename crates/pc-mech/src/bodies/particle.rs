//! Mass points.

use pc_expr::Expr;

use crate::bodies::{Moving, Share};
use crate::error::{MechError, shape};

/// A mass point m at the place r(t, x), given by its one, two or three Cartesian components in an inertial frame.
///
/// Its velocity is ṙ = X_0 r + η_s X_s r, its kinetic energy ½ m |ṙ|². A force F on it, with components along the
/// same axes, gives Q_s = F · X_s r (8); it may depend on (t, x, η), and on ẋ by the symbols `x'`.
///
/// ```
/// use pc_mech::{Graph, Particle, System};
///
/// // A pendulum: a particle on a circle, under its weight.
/// let graph = Graph::new();
/// let [m, l, g] = graph.symbols(["m", "l", "g"]);
/// let pendulum = System::builder(&graph)
///     .coordinates(["φ"])
///     .particle(|_, x, _| {
///         Particle::new(m, [l * x[0].sin(), -l * x[0].cos()]).force([0.into(), -m * g])
///     })
///     .build()?;
/// let [phi, rate] = graph.symbols(["φ", "φ'"]);
/// assert_eq!(pendulum.lagrangian(), m * l.square() * rate.square() / 2.0);
/// assert_eq!(pendulum.forces()[0], -m * g * l * phi.sin());
/// # Ok::<(), pc_mech::MechError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Particle<'g> {
    mass: Expr<'g>,
    position: Vec<Expr<'g>>,
    force: Option<Vec<Expr<'g>>>,
    name: Option<String>,
}

impl<'g> Particle<'g> {
    /// A particle of that mass at r(t, x).
    pub fn new(
        mass: impl Into<Expr<'g>>,
        position: impl IntoIterator<Item = impl Into<Expr<'g>>>,
    ) -> Particle<'g> {
        let position = position.into_iter().map(Into::into).collect();
        Particle { mass: mass.into(), position, force: None, name: None }
    }

    /// The same particle with the force F on it, as long as the position.
    #[must_use]
    pub fn force(self, force: impl IntoIterator<Item = impl Into<Expr<'g>>>) -> Particle<'g> {
        Particle { force: Some(force.into_iter().map(Into::into).collect()), ..self }
    }

    /// The same particle with a name, by which its [reactions](crate::Multipliers::body_reactions) are known.
    #[must_use]
    pub fn named(self, name: impl Into<String>) -> Particle<'g> {
        Particle { name: Some(name.into()), ..self }
    }

    pub(crate) fn name(&self) -> Option<&str> {
        self.name.as_deref()
    }

    pub(crate) fn mass_and_position(&self) -> (Expr<'g>, &[Expr<'g>]) {
        (self.mass, &self.position)
    }

    pub(crate) fn share(&self, moving: &Moving<'_, 'g>) -> Result<Share<'g>, MechError> {
        let graph = moving.frame.graph();
        moving.check_at_rest("the mass", &[self.mass])?;
        let displacements = moving.operators("the position", &self.position)?;
        let velocity = moving.combine(&displacements);
        let kinetic = self.mass * graph.dot(velocity.iter().copied(), velocity.iter().copied()) / 2.0;
        let forces = match &self.force {
            None => vec![Expr::ZERO; moving.eta.len()],
            Some(force) => {
                shape("the force on a body", force.len(), self.position.len())?;
                moving.work(&moving.in_quasi_velocities(force), &displacements)
            }
        };
        Ok(Share { kinetic, forces, velocity, angular_velocity: None })
    }
}

//! Mass points.

use pc_algebra::Frame;
use pc_expr::{Expr, Number};

use crate::error::{MechError, shape};
use crate::system::bodies::moving::{Moving, Share};

/// A point mass m at the position r(t, x), given by its one, two or three Cartesian components in an inertial
/// frame.
///
/// Its velocity is ṙ = X_0 r + η_s X_s r, its kinetic energy ½ m |ṙ|². A force F on it, with components along
/// the same axes, gives Q_s = F · X_s r (8); it may depend on (t, x, η), and on ẋ through the symbols `x'`. A
/// force that depends on the position alone, is homogeneous in r and has a force function, F · X_s r = X_s U,
/// contributes to the energy: U is added to L, and nothing is added to Q_s. The same holds for a single
/// component with this property.
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
/// assert_eq!(pendulum.lagrangian(), m * l.square() * rate.square() / 2.0 + m * g * l * phi.cos());
/// assert_eq!(pendulum.forces()[0], 0.into());
/// assert_eq!(pendulum.energy(), m * l.square() * rate.square() / 2.0 - m * g * l * phi.cos());
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
    /// A particle of mass m at r(t, x).
    pub fn new(
        mass: impl Into<Expr<'g>>,
        position: impl IntoIterator<Item = impl Into<Expr<'g>>>,
    ) -> Particle<'g> {
        let position = position.into_iter().map(Into::into).collect();
        Particle { mass: mass.into(), position, force: None, name: None }
    }

    /// The same particle with the force F on it, which has as many components as the position.
    #[must_use]
    pub fn force(self, force: impl IntoIterator<Item = impl Into<Expr<'g>>>) -> Particle<'g> {
        Particle { force: Some(force.into_iter().map(Into::into).collect()), ..self }
    }

    /// The same particle with a name, under which its [reactions](crate::Multipliers::body_reactions) are
    /// listed.
    #[must_use]
    pub fn named(self, name: impl Into<String>) -> Particle<'g> {
        Particle { name: Some(name.into()), ..self }
    }

    /// U(t, x), the force function of its force or of those components of it that have one; a term of L.
    ///
    /// # Errors
    /// [`BodyError::OfVelocities`](crate::BodyError::OfVelocities) for a mass or position with velocities;
    /// [`ShapeError`](crate::ShapeError) for a force that has not as many components as the position.
    pub fn force_function_of(
        &self,
        frame: &Frame<'g>,
        quasi_velocities: &[Expr<'g>],
    ) -> Result<Expr<'g>, MechError> {
        match &self.force {
            None => Ok(Expr::ZERO),
            Some(_) => Ok(self.share(&Moving::new(frame, quasi_velocities, &[]))?.force_function),
        }
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
        let (mut forces, mut force_function) = (vec![Expr::ZERO; moving.eta.len()], Expr::ZERO);
        let mut in_lagrangian = Vec::new();
        if let Some(force) = &self.force {
            shape("the force on a body", force.len(), self.position.len())?;
            let force = moving.in_quasi_velocities(force);
            in_lagrangian = vec![true; force.len()];
            // The whole force, or those of its components that have a force function.
            let parts = match self.force_function(&force, moving, &displacements) {
                Some(function) => {
                    force_function = function;
                    Vec::new()
                }
                None => (0..force.len()).map(|i| component(&force, i)).collect(),
            };
            for (i, part) in parts.into_iter().enumerate() {
                match self.force_function(&part, moving, &displacements) {
                    Some(function) => force_function += function,
                    None => {
                        in_lagrangian[i] = false;
                        let work = moving.work(&part, &displacements);
                        forces.iter_mut().zip(work).for_each(|(q, work)| *q += work);
                    }
                }
            }
        }
        let (rotational, angular_velocity) = (Expr::ZERO, None);
        Ok(Share { kinetic, forces, force_function, in_lagrangian, rotational, velocity, angular_velocity })
    }

    /// The U(t, x) for which F · X_s r = X_s U, if the force depends on the position alone and such a U is
    /// found. If F is homogeneous of degree d in r, as are constant forces, springs and gravitation, U = F ·
    /// r/(d + 1) by Euler's theorem: where F · X_s r is the same multiple of X_s (F · r) for all s, its 1-form
    /// is exact.
    fn force_function(
        &self,
        force: &[Expr<'g>],
        moving: &Moving<'_, 'g>,
        displacements: &[Vec<Expr<'g>>],
    ) -> Option<Expr<'g>> {
        let graph = moving.frame.graph();
        let time = moving.frame.time();
        if force.iter().any(|f| f.depends_on(time) || moving.eta.iter().any(|&eta| f.depends_on(eta))) {
            return None;
        }
        let product = graph.dot(force.iter().copied(), self.position.iter().copied());
        // A uniform force needs no such test, which could fail because of rounding errors in the frame.
        if !force.iter().any(|f| moving.frame.coordinates().iter().any(|&x| f.depends_on(x))) {
            return Some(product);
        }
        let slopes: Vec<Expr<'g>> =
            (1..=moving.eta.len()).map(|s| moving.frame.apply(s, &[product])[0]).collect();
        let work = moving.work(force, displacements);
        let mut factor = Expr::ONE;
        if let Some(s) = (0..work.len()).find(|&s| !work[s].is_zero()) {
            if slopes[s].is_zero() {
                return None;
            }
            factor = Expr::from(simple((work[s] / slopes[s]).constant()?));
        }
        let is_exact = work.iter().zip(&slopes).all(|(&work, &slope)| (work - factor * slope).is_zero());
        is_exact.then(|| factor * product)
    }
}

/// The multiple of 1/12 to which a quotient is equal up to rounding errors, as a quotient of coefficients with
/// √2 may be; for the usual degrees d, 1/(d + 1) is such a multiple. Any other number is returned unchanged.
fn simple(quotient: Number) -> Number {
    let twelfths = (12.0 * quotient.to_f64()).round();
    let is_near = (12.0 * quotient.to_f64() - twelfths).abs() <= 1e-13 * twelfths.abs();
    if is_near && twelfths.abs() < 1e6 { Number::ratio(twelfths as i64, 12) } else { quotient }
}

/// The vector with the i-th component of the given vector, and zeros elsewhere.
fn component<'g>(vector: &[Expr<'g>], i: usize) -> Vec<Expr<'g>> {
    let mut part = vec![Expr::ZERO; vector.len()];
    part[i] = vector[i];
    part
}

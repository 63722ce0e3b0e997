//! A condition on positions or velocities.

use pc_algebra::affine;
use pc_expr::Expr;

use crate::error::{ConstraintError, MechError};
use crate::system::system::System;

/// A condition f(t, x) = 0 on positions, or g(t, x, η) = 0 on velocities.
#[derive(Clone, Debug)]
pub struct Constraint<'g> {
    pub(super) name: String,
    pub(super) expression: Expr<'g>,
    /// Whether g is allowed not to be affine in η.
    pub(super) nonlinear: bool,
}

impl<'g> Constraint<'g> {
    /// The condition that `expression` vanishes. It is a condition on velocities, affine in η, if it contains a
    /// quasi-velocity, and a condition on positions otherwise. The name is used in messages and reactions.
    pub fn new(name: impl Into<String>, expression: Expr<'g>) -> Constraint<'g> {
        Constraint { name: name.into(), expression, nonlinear: false }
    }

    /// The condition g(t, x, η) = 0 that need not be affine in η. Virtual displacements are those of
    /// Chetaev's condition, (∂g/∂η_s) δπ_s = 0, so that the reactions are λ ∂g/∂η_s [N. G. Chetaev, Izv.
    /// Kazan fiz.-mat. obshch. 6 (1932)].
    ///
    /// ```
    /// use pc_mech::{Constraint, Graph, System, VectorField};
    ///
    /// // A particle that keeps its speed under gravity: only its direction turns, v θ̇ = −g cos θ.
    /// let graph = Graph::new();
    /// let particle = System::builder(&graph)
    ///     .coordinates(["x", "y"])
    ///     .lagrangian(|_, x, v| (v[0].square() + v[1].square()) / 2.0 - 10.0 * x[1])
    ///     .build()?;
    /// let [vx, vy] = graph.symbols(["x'", "y'"]);
    /// let speed = Constraint::nonlinear("speed", vx.square() + vy.square() - 25.0);
    /// let mut motion = particle.with_multipliers(&[speed])?.compile()?;
    /// let mut rates = [0.0; 4];
    /// motion.rhs(0.0, &[0.0, 0.0, 3.0, 4.0], &mut rates)?; // cos θ = 3/5, θ̇ = −6/5
    /// assert!((rates[2] - 4.8).abs() < 1e-14 && (rates[3] + 3.6).abs() < 1e-14);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn nonlinear(name: impl Into<String>, expression: Expr<'g>) -> Constraint<'g> {
        Constraint { name: name.into(), expression, nonlinear: true }
    }

    /// Whether the constraint was declared [nonlinear](Constraint::nonlinear).
    pub fn is_nonlinear(&self) -> bool {
        self.nonlinear
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The expression that vanishes.
    pub fn expression(&self) -> Expr<'g> {
        self.expression
    }

    /// Whether it is a condition on the positions of the system.
    pub fn is_holonomic(&self, system: &System<'g>) -> bool {
        !system.quasi_velocities.iter().any(|&eta| self.expression.depends_on(eta))
    }

    /// The condition on velocities: the expression itself if it is a condition on velocities, X_0 f + η_s X_s f
    /// otherwise.
    pub fn velocity(&self, system: &System<'g>) -> Expr<'g> {
        if !self.is_holonomic(system) {
            return self.expression;
        }
        let (graph, frame) = (system.graph(), &system.frame);
        let rates = frame.coordinates().iter().copied().zip(frame.velocities(&system.quasi_velocities));
        let along: Vec<_> = rates.chain(graph.in_time(frame.time())).collect();
        graph.directional(&[self.expression], &along)[0]
    }

    /// The k coefficients C_s and the term c_0 of the [condition on velocities](Constraint::velocity) C_s η_s +
    /// c_0 = 0.
    ///
    /// # Errors
    /// [`ConstraintError::NotAffine`]
    pub fn coefficients(&self, system: &System<'g>) -> Result<(Vec<Expr<'g>>, Expr<'g>), MechError> {
        let (graph, eta) = (system.graph(), &system.quasi_velocities);
        let affine = |value: Expr<'g>| affine(graph, value, eta);
        let whole = affine(self.expression).and_then(|_| affine(self.velocity(system)));
        let error = || ConstraintError::NotAffine { constraint: self.name.clone() };
        Ok(whole.ok_or_else(error)?)
    }
}

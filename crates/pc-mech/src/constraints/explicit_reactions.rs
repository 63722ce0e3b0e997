//! Reactions as functions of the state, which bring constraints of any kind into the equations for all
//! velocities.

use pc_algebra::Matrix;
use pc_expr::Expr;

use crate::compiled::elimination::symbolic_ldl::Factors;
use crate::constraints::constraint::Constraint;
use crate::constraints::multipliers::Multipliers;
use crate::error::{ConstraintError, MechError};
use crate::system::system::System;

/// The reactions as functions of the state.
pub(super) struct ExplicitReactions<'g> {
    /// λ
    pub(super) values: Vec<Expr<'g>>,
    /// The rows of C M⁻¹.
    pub(super) pushed: Vec<Vec<Expr<'g>>>,
    /// C M⁻¹ Cᵀ
    pub(super) gram: Factors<'g>,
}

impl<'g> Constraint<'g> {
    /// Whether the reaction of this constraint does no work during the motion: the power of λ ∂g/∂η_s is λ η_s
    /// ∂g/∂η_s, which vanishes with g if it is a multiple of g. By Euler's theorem this holds if g is
    /// homogeneous in η, and for an affine g = C η + c_0 if c_0 = 0.
    pub fn is_workless(&self, system: &System<'g>) -> bool {
        if !self.is_nonlinear() {
            return self.coefficients(system).is_ok_and(|(_, drift)| drift.is_zero());
        }
        let (graph, eta) = (system.graph(), system.quasi_velocities());
        let g = self.velocity(system);
        let power = graph.dot(graph.gradient(g, eta), eta.iter().copied());
        let multiple = || graph.linear_relations(&[vec![power], vec![g]]);
        power.is_zero() || multiple().iter().any(|relation| !relation[0].is_zero())
    }
}

impl<'g> Multipliers<'g> {
    /// Whether one of the constraints is [nonlinear](Constraint::nonlinear) in the velocities.
    pub fn is_nonlinear(&self) -> bool {
        self.constraints().iter().any(Constraint::is_nonlinear)
    }

    /// The reactions as functions of the state: from M η̇ = r + Cᵀ λ and C η̇ = −ċ,
    ///
    ///   (C M⁻¹ Cᵀ) λ = −ċ − C M⁻¹ r,   ċ = (∂g/∂x) ẋ + ∂g/∂t.
    ///
    /// There are m of these expressions, in terms of (t, x, η). The reactions keep g constant, whatever its value.
    ///
    /// ```
    /// use pc_mech::{Constraint, Graph, System};
    ///
    /// // A particle that keeps its speed under gravity: λ = g ẏ/(2 |ṙ|²).
    /// let graph = Graph::new();
    /// let particle = System::builder(&graph)
    ///     .coordinates(["x", "y"])
    ///     .lagrangian(|_, x, v| (v[0].square() + v[1].square()) / 2.0 - 10.0 * x[1])
    ///     .build()?;
    /// let [vx, vy] = graph.symbols(["x'", "y'"]);
    /// let speed = Constraint::nonlinear("speed", vx.square() + vy.square() - 25.0);
    /// let held = particle.with_multipliers(&[speed])?;
    /// assert!((held.reactions_of_state()?[0] - 5.0 * vy / (vx.square() + vy.square())).is_zero());
    /// # Ok::<(), pc_mech::MechError>(())
    /// ```
    ///
    /// # Errors
    /// [`LagrangianError::Degenerate`](crate::LagrangianError::Degenerate) if M is singular everywhere,
    /// [`ConstraintError::Dependent`] if C M⁻¹ Cᵀ is.
    pub fn reactions_of_state(&self) -> Result<Vec<Expr<'g>>, MechError> {
        let (graph, reactions) = (self.graph(), self.explicit_reactions()?.values);
        graph.check(&reactions)?;
        Ok(graph.shorten(&reactions, &self.equations.system.collecting_order()))
    }

    /// The solution of these equations for λ, with what it is made of.
    pub(super) fn explicit_reactions(&self) -> Result<ExplicitReactions<'g>, MechError> {
        let (system, mass, c) = (&self.equations.system, self.equations.mass_matrix(), &self.coefficients);
        let graph = system.graph();
        // Without an inertia of its own a velocity has that of the constraints, Cᵀ C, which changes neither η̇ nor λ: to r is added
        // −Cᵀ ċ.
        let (mass, right) = match system.check_regular(mass) {
            Ok(()) => (mass.clone(), self.equations.right_hand_side().to_vec()),
            Err(error) => self.with_inertia_of_constraints().ok_or(error)?,
        };
        let factors = Factors::of(graph, &mass);
        let dot =
            |row: &[Expr<'g>], column: &[Expr<'g>]| graph.dot(row.iter().copied(), column.iter().copied());
        let pushed: Vec<Vec<Expr<'g>>> = (0..c.rows()).map(|a| factors.solve(graph, &c.row(a))).collect();
        let gram = Matrix::from_fn(c.rows(), c.rows(), |a, b| dot(&c.row(a.max(b)), &pushed[a.min(b)]));
        if let Some(constraint) = self.first_dependent(&gram) {
            return Err(ConstraintError::Dependent { constraint }.into());
        }
        let free = factors.solve(graph, &right);
        let gaps: Vec<Expr<'g>> = (0..c.rows()).map(|a| self.right[a] - dot(&c.row(a), &free)).collect();
        let gram = Factors::of(graph, &gram);
        Ok(ExplicitReactions { values: gram.solve(graph, &gaps), pushed, gram })
    }

    /// M + Cᵀ C and r − Cᵀ ċ, if that matrix is regular.
    fn with_inertia_of_constraints(&self) -> Option<(Matrix<Expr<'g>>, Vec<Expr<'g>>)> {
        let (graph, c, mass) = (self.graph(), &self.coefficients, self.equations.mass_matrix());
        let k = c.columns();
        let whole =
            Matrix::from_fn(k, k, |s, r| mass[(s, r)] + graph.dot(c.column(s.max(r)), c.column(s.min(r))));
        let right = self.equations.right_hand_side().iter().enumerate();
        let right = right.map(|(s, &r)| r + graph.dot(c.column(s), self.right.iter().copied())).collect();
        (graph.generic_rank(&whole.to_rows()) == k).then_some((whole, right))
    }

    /// The name of the first constraint whose row adds nothing to the rank of the rows before it.
    fn first_dependent(&self, gram: &Matrix<Expr<'g>>) -> Option<String> {
        let (graph, rows) = (self.equations.system.graph(), gram.to_rows());
        let dependent = (0..rows.len()).find(|&a| graph.generic_rank(&rows[..=a]) <= a)?;
        Some(self.constraints()[dependent].name().to_owned())
    }

    /// The system of all velocities on which the [reactions](Multipliers::reactions_of_state) act as forces, Q_s +
    /// C_αs λ_α, that depend on the state: its equations (9) are the equations of motion, in every form, and the
    /// constraints are integrals. Numerical drift from the constraints is not corrected.
    ///
    /// # Errors
    /// As for [`reactions_of_state`](Multipliers::reactions_of_state).
    pub fn with_reactions_put_in(&self) -> Result<System<'g>, MechError> {
        let system = &self.equations.system;
        let values = self.reactions_of_state()?;
        let known: Vec<(Expr<'g>, Expr<'g>)> = self.reactions.iter().copied().zip(values).collect();
        let forces = system.graph().substitute(&self.reaction_forces(), &known);
        system.with_observed(&known).with_added_forces(&forces)
    }
}

//! Coulomb's friction of constraints: forces proportional to reactions, which depend on these forces in turn.
//!
//! Where a body slides with the velocities s_i along orthogonal tangents, friction acts with T_i = −μ N u_i, u = s/|s|, on the
//! quasi-velocities with Q_s = T_i ∂s_i/∂η_s. The normal force N is a reaction λ, so that the equations for λ become
//!
//!   (C M⁻¹ Cᵀ) λ = −ċ − C M⁻¹ (r − Σ μ N u_i ∂s_i/∂η),
//!
//! and with λ⁰, the reactions without friction, and W_fg = μ_g u_gi e_f (C M⁻¹ Cᵀ)⁻¹ C M⁻¹ ∂s_gi/∂η,
//!
//!   N_f − W_fg N_g = λ⁰_f.

use pc_algebra::{Matrix, inverse};
use pc_expr::Expr;

use crate::constraints::multipliers::Multipliers;
use crate::error::{ConstraintError, MechError};

/// A constraint with dry friction.
#[derive(Clone, Debug)]
pub struct ConstraintFriction<'g> {
    /// The index of the constraint whose reaction is the normal force N.
    pub constraint: usize,
    /// The coefficient of friction μ.
    pub coefficient: Expr<'g>,
    /// The velocities along orthogonal tangents at which the body slides, in terms of (t, x, η) and affine in η: one or two.
    pub slips: Vec<Expr<'g>>,
    /// A velocity c that makes friction smooth, u = s/√(s² + c²). Without it friction jumps where the body comes to rest, and
    /// there may be one velocity s only.
    pub creep: Option<Expr<'g>>,
}

impl<'g> ConstraintFriction<'g> {
    /// Whether the friction jumps.
    fn jumps(&self) -> bool {
        self.creep.is_none() && !self.slips.is_empty()
    }

    /// u, where friction is smooth.
    fn smooth(&self, creep: Expr<'g>) -> Vec<Expr<'g>> {
        let squares = self.slips.iter().map(|slip| slip.square());
        let size = squares.fold(creep.square(), |sum, square| sum + square).sqrt();
        self.slips.iter().map(|&slip| slip / size).collect()
    }
}

/// The forces of friction of some constraints, as functions of (t, x, η).
#[derive(Clone, Debug)]
pub struct FrictionForces<'g> {
    /// T_i, for each constraint along its tangents.
    pub forces: Vec<Vec<Expr<'g>>>,
    /// 1 − W_ff for each constraint, the least on all sides of its jump. Where it is not positive a normal force has no value, or two
    /// (Painlevé 1895): the constraint jams.
    pub margins: Vec<Expr<'g>>,
    /// λ⁰, the normal forces without friction.
    pub without: Vec<Expr<'g>>,
}

/// What the normal forces depend on.
struct NormalForces<'a, 'g> {
    multipliers: &'a Multipliers<'g>,
    frictions: &'a [ConstraintFriction<'g>],
    /// λ⁰ of each constraint with friction.
    without: Vec<Expr<'g>>,
    /// The change of λ_f with a unit force along tangent i of constraint g: by g, by i, by f.
    by_force: Vec<Vec<Vec<Expr<'g>>>>,
}

impl<'g> Multipliers<'g> {
    /// The forces of friction T_i of some constraints, for each along its tangents, as functions of (t, x, η). A force that
    /// jumps is a [step](Expr::step) between its values on both sides of s = 0, so that values between these, which hold a body
    /// at rest, are combinations of them.
    ///
    /// ```
    /// use pc_mech::{Constraint, ConstraintFriction, Graph, System};
    ///
    /// // A body on a slope y = x: T = −μ N, N = m g cos 45°, does not change N.
    /// let graph = Graph::new();
    /// let body = System::builder(&graph)
    ///     .coordinates(["x", "y"])
    ///     .lagrangian(|_, x, v| (v[0].square() + v[1].square()) / 2.0 - 10.0 * x[1])
    ///     .build()?;
    /// let [x, y, u, v] = graph.symbols(["x", "y", "x'", "y'"]);
    /// let half = 0.5f64.sqrt();
    /// let slope = Constraint::new("slope", (y - x) * half);
    /// let held = body.with_multipliers(&[slope])?;
    /// let friction = ConstraintFriction {
    ///     constraint: 0,
    ///     coefficient: 0.3.into(),
    ///     slips: vec![(u + v) * half],
    ///     creep: None,
    /// };
    /// let forces = held.friction_forces(&[friction])?;
    /// let value = graph.evaluate(&forces.forces[0], &[(u, 1.0), (v, 1.0)])?[0];
    /// assert!((value + 0.3 * 10.0 * half).abs() < 1e-14);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// As for [`reactions_of_state`](Multipliers::reactions_of_state); [`ConstraintError::TwoSlips`] for friction without
    /// `creep` along two tangents.
    pub fn friction_forces(
        &self,
        frictions: &[ConstraintFriction<'g>],
    ) -> Result<FrictionForces<'g>, MechError> {
        if let Some(friction) = frictions.iter().find(|f| f.jumps() && f.slips.len() > 1) {
            let constraint = self.constraints()[friction.constraint].name().to_owned();
            return Err(ConstraintError::TwoSlips { constraint }.into());
        }
        let normal_forces = self.normal_forces(frictions)?;
        let forces = normal_forces.forces(&mut Vec::new());
        self.graph().check(&forces.concat())?;
        let margins = (0..frictions.len()).map(|f| normal_forces.margin(f)).collect();
        Ok(FrictionForces { forces, margins, without: normal_forces.without })
    }

    /// The forces Q_s = T_i ∂s_i/∂η_s on the quasi-velocities of these [forces](Multipliers::friction_forces).
    pub fn friction_on_quasi_velocities(
        &self,
        frictions: &[ConstraintFriction<'g>],
        forces: &[Vec<Expr<'g>>],
    ) -> Vec<Expr<'g>> {
        let mut sums = vec![Vec::new(); self.quasi_velocities().len()];
        for (friction, forces) in frictions.iter().zip(forces) {
            for (&slip, &force) in friction.slips.iter().zip(forces) {
                let slopes = self.graph().gradient(slip, self.quasi_velocities());
                sums.iter_mut().zip(slopes).for_each(|(sum, slope)| sum.push(force * slope));
            }
        }
        sums.into_iter().map(|terms| self.graph().sum(terms)).collect()
    }

    fn normal_forces<'a>(
        &'a self,
        frictions: &'a [ConstraintFriction<'g>],
    ) -> Result<NormalForces<'a, 'g>, MechError> {
        let graph = self.graph();
        let reactions = self.explicit_reactions()?;
        let along = |friction: &ConstraintFriction<'g>| {
            let of_slip = |&slip: &Expr<'g>| {
                let slopes = graph.gradient(slip, self.quasi_velocities());
                let gaps = reactions.pushed.iter().map(|row| -graph.dot(row.iter().copied(), slopes.clone()));
                let changes = reactions.gram.solve(graph, &gaps.collect::<Vec<_>>());
                frictions.iter().map(|f| changes[f.constraint]).collect::<Vec<Expr<'g>>>()
            };
            friction.slips.iter().map(of_slip).collect()
        };
        Ok(NormalForces {
            multipliers: self,
            frictions,
            without: frictions.iter().map(|f| reactions.values[f.constraint]).collect(),
            by_force: frictions.iter().map(along).collect(),
        })
    }
}

impl<'g> NormalForces<'_, 'g> {
    /// T, on the sides `chosen` of the first jumps, between the sides of the others.
    fn forces(&self, chosen: &mut Vec<Expr<'g>>) -> Vec<Vec<Expr<'g>>> {
        let mut jumping = self.frictions.iter().filter(|friction| friction.jumps());
        let Some(next) = jumping.nth(chosen.len()) else { return self.forces_on(chosen) };
        let mut on = |side: Expr<'g>| {
            chosen.push(side);
            let forces = self.forces(chosen);
            chosen.pop();
            forces
        };
        let (above, below) = (on(Expr::ONE), on(-Expr::ONE));
        let between = |(above, below): (Vec<Expr<'g>>, Vec<Expr<'g>>)| {
            above.into_iter().zip(below).map(|(a, b)| next.slips[0].step(a, b)).collect()
        };
        above.into_iter().zip(below).map(between).collect()
    }

    /// 1 − W_ff, the least on all sides.
    fn margin(&self, f: usize) -> Expr<'g> {
        let (friction, graph) = (&self.frictions[f], self.multipliers.graph());
        let on = |u: Vec<Expr<'g>>| {
            let terms = u.into_iter().zip(&self.by_force[f]);
            Expr::ONE + friction.coefficient * graph.sum(terms.map(|(u, by)| u * by[f]))
        };
        match friction.creep {
            Some(creep) => on(friction.smooth(creep)),
            None => on(vec![Expr::ONE]).min(on(vec![-Expr::ONE])),
        }
    }

    /// T where each friction that jumps acts on the side given for it.
    fn forces_on(&self, sides: &[Expr<'g>]) -> Vec<Vec<Expr<'g>>> {
        let (graph, count) = (self.multipliers.graph(), self.frictions.len());
        let mut sides = sides.iter().copied();
        let per_normal_force: Vec<Vec<Expr<'g>>> = (self.frictions.iter())
            .map(|friction| {
                let u = match friction.creep {
                    Some(creep) => friction.smooth(creep),
                    None => sides.by_ref().take(friction.slips.len()).collect(),
                };
                u.into_iter().map(|u| -friction.coefficient * u).collect()
            })
            .collect();
        let change = |f: usize, g: usize| {
            let terms = per_normal_force[g].iter().zip(&self.by_force[g]).map(|(&t, by)| t * by[f]);
            graph.sum(terms)
        };
        let own = |f: usize, g: usize| if f == g { Expr::ONE } else { Expr::ZERO };
        let matrix = Matrix::from_fn(count, count, |f, g| own(f, g) - change(f, g));
        let undefined = || Matrix::from_fn(count, count, |_, _| Expr::ONE / Expr::ZERO);
        let inverse = inverse(graph, &matrix).unwrap_or_else(undefined);
        let normal = |f: usize| graph.dot(inverse.row(f).to_vec(), self.without.iter().copied());
        let forces = per_normal_force.iter().enumerate();
        forces.map(|(f, list)| list.iter().map(|&t| t * normal(f)).collect()).collect()
    }
}

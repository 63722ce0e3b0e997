//! Chaplygin's reducing multiplier.

use pc_mech::{Expr, Number, System};
use pc_nonholo::Voronets;

use crate::error::AnalysisError;
use crate::measures::invariant_measure::invariant_measure;

/// A new time with which a Chaplygin system becomes a Lagrangian one.
#[derive(Clone, Debug)]
pub struct ReducingMultiplier<'g> {
    /// N in dτ = N dt, where τ is the new time: a positive function of the independent coordinates.
    pub multiplier: Expr<'g>,
    /// The system in that time: the independent coordinates, with their rates x_i' with respect to τ as
    /// velocities, and L* = (θ + U)(x, N x').
    pub system: System<'g>,
}

impl<'g> ReducingMultiplier<'g> {
    /// The reducing multiplier of a Chaplygin system that has only potential forces, if one is found: with dτ = N dt
    /// the equations (35) become
    ///
    ///   d/dτ ∂L*/∂x_i' = ∂L*/∂x_i,   L*(x, x') = (θ + U)(x, N x'),
    ///
    /// which are Lagrange's, without a term from the constraints. Their volume dx dP, P = N p, is N^l dx dp,
    /// and with respect to the old time N^(l−1) dx dp is invariant: N is sought as a root of the density of
    /// an invariant measure. With two degrees of freedom and T quadratic in the velocities a multiplier
    /// exists if and only if there is such a measure [Chaplygin 1911]; in other cases N is given only if the
    /// equations are proved to be the same.
    ///
    /// `None` for systems that are not [Chaplygin's](Voronets::is_chaplygin) or depend on time.
    ///
    /// # Errors
    /// [`LagrangianError::NotQuadratic`](pc_mech::LagrangianError::NotQuadratic) if the equations have no closed form.
    ///
    /// ```
    /// use pc_analysis::ReducingMultiplier;
    /// use pc_mech::{Constraint, Graph, System};
    /// use pc_nonholo::Voronets;
    ///
    /// // The particle with ż = y ẋ.
    /// let graph = Graph::new();
    /// let [y, vx, vy, vz] = graph.symbols(["y", "x'", "y'", "z'"]);
    /// let particle = System::builder(&graph)
    ///     .coordinates(["x", "y", "z"])
    ///     .lagrangian(|_, _, v| (v[0].square() + v[1].square() + v[2].square()) / 2.0)
    ///     .build()?;
    /// let held = particle.with_multipliers(&[Constraint::new("knife", vz - y * vx)])?;
    /// let at: Vec<_> = ["x", "y", "z", "x'", "y'", "z'", "t"].map(|name| (graph.symbol(name), 0.5)).into();
    /// let reduced = ReducingMultiplier::of(&Voronets::new(&held, &at)?)?.unwrap();
    /// assert_eq!(reduced.multiplier, 1.0 / (1.0 + y.square()).sqrt());
    /// assert_eq!(reduced.system.lagrangian(), vx.square() / 2.0 + vy.square() / (2.0 + 2.0 * y.square()));
    /// # Ok::<(), pc_analysis::AnalysisError>(())
    /// ```
    pub fn of(voronets: &Voronets<'g>) -> Result<Option<ReducingMultiplier<'g>>, AnalysisError> {
        if !voronets.is_chaplygin() || depends_on_time(voronets) || has_forces(voronets) {
            return Ok(None);
        }
        let in_time = voronets.system()?;
        let (graph, v) = (in_time.graph(), in_time.quasi_velocities());
        let Some(measure) = invariant_measure(&in_time, &[])? else { return Ok(None) };
        let multiplier = measure.density_to(Number::ratio(1, v.len().saturating_sub(1).max(1) as i64));
        let scaled: Vec<_> = v.iter().map(|&v| (v, multiplier * v)).collect();
        let lagrangian = graph.substitute(&[in_time.lagrangian()], &scaled)[0];
        let names: Vec<String> = voronets.independent().iter().map(ToString::to_string).collect();
        let builder = System::builder(graph).coordinates(names).lagrangian(|_, _, _| lagrangian);
        let parameters = in_time.parameters().iter();
        let system = parameters.fold(builder, |builder, &(p, value)| builder.parameter(p, value)).build()?;
        let reduced = ReducingMultiplier { multiplier, system };
        let proved = v.len() <= 2 && is_quadratic(voronets) || reduced.has_the_motions_of(&in_time)?;
        Ok(proved.then_some(reduced))
    }

    /// Whether x'' of the new system is (ẍ/N − (x'·∂N/∂x) x')/N with ẋ = N x', identically.
    fn has_the_motions_of(&self, in_time: &System<'g>) -> Result<bool, AnalysisError> {
        let (graph, n) = (self.system.graph(), self.multiplier);
        let (x, v) = (self.system.frame().coordinates(), self.system.quasi_velocities());
        let rates: Vec<_> = x.iter().copied().zip(v.iter().copied()).collect();
        let growth = graph.directional(&[n], &rates)[0];
        let scaled: Vec<_> = v.iter().map(|&v| (v, n * v)).collect();
        let accelerations = graph.substitute(&in_time.poincare()?.accelerations(), &scaled);
        let expected = accelerations.into_iter().zip(v).map(|(a, &v)| (a / n - growth * v) / n);
        let found = self.system.poincare()?.accelerations();
        Ok(found.into_iter().zip(expected).all(|(found, expected)| (found - expected).is_zero()))
    }
}

/// Whether L has no terms linear in the velocities.
fn is_quadratic(voronets: &Voronets<'_>) -> bool {
    let held = voronets.held();
    let (graph, v) = (held.graph(), held.quasi_velocities());
    let at_rest: Vec<_> = v.iter().map(|&v| (v, Expr::ZERO)).collect();
    graph.substitute(&graph.gradient(held.lagrangian(), v), &at_rest).iter().all(|p| p.is_zero())
}

fn has_forces(voronets: &Voronets<'_>) -> bool {
    voronets.held().forces().iter().any(|force| !force.is_zero())
}

fn depends_on_time(voronets: &Voronets<'_>) -> bool {
    let held = voronets.held();
    let mut parts = voronets.coefficients().nonzero_entries();
    parts.push(held.lagrangian());
    held.graph().directional(&parts, &held.graph().in_time(held.frame().time())).iter().any(|d| !d.is_zero())
}

//! Frames in which the mass matrix is the unit matrix.

use pc_algebra::{Matrix, quadratic};
use pc_expr::Expr;

use crate::compiled::elimination::symbolic_ldl::Factors;
use crate::equations::legendre::not_quadratic_in;
use crate::error::{LagrangianError, MechError, ShapeError};
use crate::system::system::System;
use crate::transform::quasi_velocities::QuasiVelocityChange;

impl<'g> System<'g> {
    /// The same system in quasi-velocities that are orthonormal in the kinetic metric, η' = D^½ Lᵀ η with M = L D Lᵀ,
    /// so that T = ½ η'_s η'_s up to parts of lower degree. One quasi-velocity η'_s is made for each of the `names`,
    /// out of the first quasi-velocities; the others, such as those that constraints keep at zero, are unchanged.
    ///
    /// # Errors
    /// [`LagrangianError::NotQuadratic`] unless L is quadratic in η, with a metric independent of η;
    /// [`LagrangianError::Degenerate`]; [`ShapeError`] if there are more names than quasi-velocities.
    ///
    /// ```
    /// use pc_mech::{Graph, System};
    ///
    /// // Polar coordinates: the velocities along and across the radius.
    /// let graph = Graph::new();
    /// let polar = System::builder(&graph)
    ///     .coordinates(["ρ", "φ"])
    ///     .lagrangian(|_, x, v| (v[0].square() + x[0].square() * v[1].square()) / 2.0)
    ///     .build()?;
    /// let orthonormal = polar.in_orthonormal_frame(["η1", "η2"])?;
    /// let equations = orthonormal.poincare()?;
    /// assert_eq!(equations.mass_matrix()[(1, 1)], 1.into());
    /// let velocities: Vec<String> = equations.velocities().iter().map(|v| v.to_string()).collect();
    /// assert_eq!(velocities, ["η1", "η2/sqrt(ρ^2)"]);
    /// # Ok::<(), pc_mech::MechError>(())
    /// ```
    pub fn in_orthonormal_frame<S: AsRef<str>>(
        &self,
        names: impl IntoIterator<Item = S>,
    ) -> Result<System<'g>, MechError> {
        Ok(self.orthonormal_change(names)?.system().clone())
    }

    /// The system, with the new quasi-velocities in terms of the old ones, and the old ones in terms of the
    /// new.
    ///
    /// # Errors
    /// As for [`in_orthonormal_frame`](System::in_orthonormal_frame).
    pub fn orthonormal_change<S: AsRef<str>>(
        &self,
        names: impl IntoIterator<Item = S>,
    ) -> Result<QuasiVelocityChange<'g>, MechError> {
        let (graph, eta) = (self.graph(), &self.quasi_velocities);
        let names: Vec<String> = names.into_iter().map(|name| name.as_ref().to_owned()).collect();
        let free = names.len();
        if free > eta.len() {
            let what = "the list of names";
            return Err(ShapeError { what, found: free, expected: eta.len() }.into());
        }
        let depends = |m: &Expr<'g>| eta.iter().any(|&eta| m.depends_on(eta));
        let form = quadratic(graph, self.lagrangian, &eta[..free]);
        let Some(form) = form.filter(|form| !form.matrix.entries().iter().any(depends)) else {
            return Err(
                LagrangianError::NotQuadratic { quasi_velocity: not_quadratic_in(self).to_string() }.into()
            );
        };
        let entries = graph.shorten(&form.matrix.entries(), &self.collecting_order());
        let mass = Matrix::from_fn(free, free, |r, s| entries[r.max(s) * free + r.min(s)]);
        self.check_regular(&mass)?;
        let Factors::Ldl(factors) = Factors::of(graph, &mass) else {
            // A regular matrix without a pivot on its diagonal is not a metric.
            let quasi_velocities = eta[..free].iter().map(Expr::to_string).collect();
            return Err(LagrangianError::Degenerate { rank: 0, size: free, quasi_velocities }.into());
        };
        let made = (0..free).map(|s| factors.orthonormal(graph, s, &eta[..free]));
        let definitions: Vec<Expr<'g>> = made.chain(eta[free..].iter().copied()).collect();
        let names = names.into_iter().chain(eta[free..].iter().map(Expr::to_string));
        self.quasi_velocity_change(names, &definitions)
    }
}

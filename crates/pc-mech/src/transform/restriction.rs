//! A system whose last quasi-velocities are zero.

use pc_expr::Expr;

use crate::error::{MechError, ShapeError};
use crate::system::bodies::velocity::Bodies;
use crate::system::system::System;

impl<'g> System<'g> {
    /// The system of the first `free` quasi-velocities whose equations (9) are those of the present system under the
    /// nonholonomic constraints η_α = 0, α > `free`, in the form (32):
    ///
    ///   d/dt ∂θ/∂η_s = (c_rs^m η_r + c_0s^m) ∂θ/∂η_m + (c_rs^α η_r + c_0s^α) (∂L/∂η_α)_0 + X_s (θ + U) + Q_s,
    ///
    /// r, s, m ≤ `free`, where θ + U is L with the constraints substituted. The second term, which substitution
    /// alone would lose, is included in the forces of the new system, so that its
    /// [canonical](System::canonical) equations are (34), with y_s = ∂θ/∂η_s.
    ///
    /// Its structure coefficients are the c_rs^m, m ≤ `free`, which are not those of its frame unless the
    /// constraints are integrable; the bracket that they define does not satisfy Jacobi's identity.
    ///
    /// # Errors
    /// [`ShapeError`] if there are fewer than `free` quasi-velocities.
    pub fn constrained(&self, free: usize) -> Result<System<'g>, MechError> {
        let (graph, all) = (self.graph(), &self.quasi_velocities);
        if free > all.len() {
            let what = "the list of free quasi-velocities";
            return Err(ShapeError { what, found: free, expected: all.len() }.into());
        }
        let restricted = self.restricted(free);
        let zeros: Vec<_> = all[free..].iter().map(|&eta| (eta, Expr::ZERO)).collect();
        // (∂L/∂η_α)_0, and zero for m ≤ l
        let mut dropped = graph.substitute(&self.momenta(), &zeros);
        dropped[..free].fill(Expr::ZERO);
        let lost = self.structure.gyroscopic(graph, &graph.substitute(all, &zeros), &dropped);
        let order = restricted.collecting_order();
        Ok(System {
            structure: self.structure.restricted(free),
            forces: restricted
                .forces
                .iter()
                .zip(graph.shorten(&lost[..free], &order))
                .map(|(&force, lost)| force + lost)
                .collect(),
            lagrangian: graph.shorten(&[restricted.lagrangian], &order)[0],
            ..restricted
        })
    }

    /// The system of the first `free` quasi-velocities, with the others set to zero. Its structure coefficients
    /// stay those of the whole frame, and only the energy may be derived from its Lagrangian.
    pub(crate) fn restricted(&self, free: usize) -> System<'g> {
        let graph = self.graph();
        let dropped = &self.quasi_velocities[free..];
        let rates = self.accelerations();
        let zeros: Vec<_> =
            dropped.iter().chain(&rates[free..]).map(|&symbol| (symbol, Expr::ZERO)).collect();
        let free_ones = System {
            frame: self.frame.restricted(free),
            quasi_velocities: self.quasi_velocities[..free].to_vec(),
            forces: self.forces[..free].to_vec(),
            bodies: Bodies { others: None, ..self.bodies.clone() },
            ..self.clone()
        };
        let zeros = graph.substitution(&zeros);
        free_ones.map_expressions(|list| zeros.apply(list))
    }
}

//! Poincaré's equations (9), solved for the accelerations.

use pc_algebra::Matrix;
use pc_expr::Expr;

use crate::error::MechError;
use crate::ldl::Ldl;
use crate::system::System;

/// The equations of motion ẋ = b η + b_0, M η̇ = r.
#[derive(Clone, Debug)]
pub struct Equations<'g> {
    pub(crate) system: System<'g>,
    pub(crate) velocities: Vec<Expr<'g>>,
    pub(crate) mass: Matrix<Expr<'g>>,
    pub(crate) right: Vec<Expr<'g>>,
    pub(crate) energy: Expr<'g>,
}

impl<'g> System<'g> {
    /// Poincaré's equations (9)
    ///
    ///   d/dt ∂L/∂η_s = (c_rs^m η_r + c_0s^m) ∂L/∂η_m + X_s L + Q_s
    ///
    /// in the form M η̇ = r with M = ∂²L/∂η∂η and r = v + X L + Q − (∂²L/∂η∂x) ẋ − ∂²L/∂η∂t.
    ///
    /// # Errors
    /// [`MechError::DegenerateLagrangian`] if M is singular everywhere.
    pub fn poincare(&self) -> Result<Equations<'g>, MechError> {
        let graph = self.graph();
        let (x, eta, t) = (self.frame.coordinates(), &self.quasi_velocities, self.frame.time());
        let velocities = self.frame.velocities(eta);

        let variables: Vec<Expr<'g>> = eta.iter().chain(x).copied().collect();
        let gradient = graph.gradient(self.lagrangian, &variables);
        let (momenta, slope) = gradient.split_at(eta.len());

        let hessian: Vec<Vec<Expr<'g>>> = momenta.iter().map(|&p| graph.gradient(p, eta)).collect();
        let mass = Matrix::from_fn(eta.len(), eta.len(), |r, s| hessian[r.max(s)][r.min(s)]);
        self.check_regular(&mass)?;

        let along: Vec<_> =
            x.iter().copied().zip(velocities.iter().copied()).chain([(t, Expr::ONE)]).collect();
        let transport = graph.directional(momenta, &along);
        let gyroscopic = self.structure.gyroscopic(graph, eta, momenta);
        let potential = self.frame.contract(slope);
        let right = (0..eta.len())
            .map(|s| graph.sum([gyroscopic[s], potential[s], self.forces[s], -transport[s]]))
            .collect();

        let energy = graph.dot(momenta.iter().copied(), eta.iter().copied()) - self.lagrangian;
        graph.check()?;
        Ok(Equations { system: self.clone(), velocities, mass, right, energy })
    }

    fn check_regular(&self, mass: &Matrix<Expr<'g>>) -> Result<(), MechError> {
        let size = mass.rows();
        let graph = self.graph();
        let rank = graph.generic_rank(&mass.to_rows());
        if rank == size {
            return Ok(());
        }
        // A row that adds nothing to the rank of those before it belongs to an undetermined quasi-velocity.
        let rows = mass.to_rows();
        let rank_of_first = |count: usize| graph.generic_rank(&rows[..count]);
        let undetermined = (0..size).filter(|&s| rank_of_first(s + 1) == rank_of_first(s));
        let quasi_velocities = undetermined.map(|s| self.quasi_velocities[s].to_string()).collect();
        Err(MechError::DegenerateLagrangian { rank, size, quasi_velocities })
    }
}

impl<'g> Equations<'g> {
    /// The system they were derived from.
    pub fn system(&self) -> &System<'g> {
        &self.system
    }

    /// ẋ = b η + b_0 (3), length n.
    pub fn velocities(&self) -> &[Expr<'g>] {
        &self.velocities
    }

    /// M = ∂²L/∂η∂η, k × k and symmetric.
    pub fn mass_matrix(&self) -> &Matrix<Expr<'g>> {
        &self.mass
    }

    /// The right-hand side r of M η̇ = r, length k.
    pub fn right_hand_side(&self) -> &[Expr<'g>] {
        &self.right
    }

    /// The energy y_s η_s − L.
    pub fn energy(&self) -> Expr<'g> {
        self.energy
    }

    /// The accelerations η̇ = M⁻¹ r, length k.
    pub fn accelerations(&self) -> Vec<Expr<'g>> {
        Ldl::of(self.system.graph(), &self.mass).solve(&self.right)
    }
}

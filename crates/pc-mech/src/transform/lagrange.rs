//! The same system in the velocities of its coordinates: Lagrange's equations.

use pc_algebra::{AlgebraError, Frame, LieAlgebra};
use pc_expr::Expr;

use crate::error::{LagrangianError, MechError};
use crate::system::system::System;

impl<'g> System<'g> {
    /// The system with η = ẋ: its equations (9) are Lagrange's equations, d/dt ∂L/∂ẋ_i − ∂L/∂x_i = Q_i.
    ///
    /// With η = a ẋ + a_0 (2) for the n = k old quasi-velocities, Q_i = a_si Q_s.
    ///
    /// # Errors
    /// [`LagrangianError::RedundantCoordinates`] if there are not as many quasi-velocities as coordinates, and
    /// [`MechError::Algebra`] if the quasi-velocities do not determine the velocities.
    pub fn in_velocities(&self) -> Result<System<'g>, MechError> {
        let graph = self.graph();
        let (coordinates, k) = (self.frame.coordinates(), self.quasi_velocities.len());
        if coordinates.len() != k {
            return Err(LagrangianError::RedundantCoordinates {
                coordinates: coordinates.len(),
                quasi_velocities: k,
            }
            .into());
        }
        let (rank, operators) = (self.frame.rank(), k);
        if rank < k {
            return Err(AlgebraError::DependentOperators { rank, operators }.into());
        }
        let velocities: Vec<Expr<'g>> = coordinates.iter().map(|x| graph.symbol(&format!("{x}'"))).collect();
        let change = self.change(&self.frame.velocities(&self.quasi_velocities))?;
        let frame = Frame::coordinate(graph, self.frame.time(), coordinates.to_vec());
        let structure = LieAlgebra::commutative(k).structure_coefficients(); // ∂/∂x_i commute
        self.changed(velocities, &change, frame, structure)
    }
}

//! The same system in the velocities of its coordinates: Lagrange's equations.

use pc_algebra::Frame;
use pc_expr::Expr;

use crate::error::MechError;
use crate::system::System;

impl<'g> System<'g> {
    /// The system with η = ẋ: its equations (9) are Lagrange's, d/dt ∂L/∂ẋ_i − ∂L/∂x_i = Q_i.
    ///
    /// With η = a ẋ + a_0 (2) for the old quasi-velocities, Q_i = a_si Q_s.
    ///
    /// # Errors
    /// [`MechError::Redundant`] if there are not as many quasi-velocities as coordinates, and
    /// [`MechError::Algebra`] if these do not determine them.
    pub fn in_velocities(&self) -> Result<System<'g>, MechError> {
        let graph = self.graph();
        let (coordinates, k) = (self.frame.coordinates(), self.quasi_velocities.len());
        if coordinates.len() != k {
            return Err(MechError::Redundant { coordinates: coordinates.len(), quasi_velocities: k });
        }
        let (a, a0) = self.frame.definitions()?;
        let prime = |x: &Expr<'g>, marks: &str| graph.symbol(&format!("{x}{marks}"));
        let velocities: Vec<Expr<'g>> = coordinates.iter().map(|x| prime(x, "'")).collect();
        let accelerations = coordinates.iter().map(|x| prime(x, "''"));
        let eta: Vec<Expr<'g>> =
            (0..k).map(|s| graph.dot(a.row(s).iter().copied(), velocities.iter().copied()) + a0[s]).collect();

        // η̇ along ẋ and ẍ, for the integrals and outputs that contain it.
        let moving = coordinates.iter().chain(&velocities).copied();
        let rates = velocities.iter().copied().chain(accelerations).chain([Expr::ONE]);
        let along: Vec<_> = moving.chain([self.frame.time()]).zip(rates).collect();
        let eta_rates = graph.directional(&eta, &along);
        let old = self.quasi_velocities.iter().copied().chain(self.accelerations());
        let values: Vec<_> = old.zip(eta.iter().copied().chain(eta_rates)).collect();
        let put = |x: Expr<'g>| graph.substitute(&[x], &values)[0];
        let named =
            |list: &[(String, Expr<'g>)]| list.iter().map(|(name, x)| (name.clone(), put(*x))).collect();

        let frame = Frame::coordinate(graph, self.frame.time(), coordinates.to_vec());
        let structure = frame.structure_coefficients(&Default::default())?;
        let forces: Vec<Expr<'g>> = self.forces.iter().map(|&q| put(q)).collect();
        let order: Vec<Expr<'g>> =
            velocities.iter().copied().chain(self.parameters.iter().map(|&(symbol, _)| symbol)).collect();
        Ok(System {
            forces: (0..k).map(|i| graph.dot(a.column(i), forces.iter().copied())).collect(),
            lagrangian: graph.shorten(&[put(self.lagrangian)], &order)[0],
            integrals: named(&self.integrals),
            outputs: named(&self.outputs),
            parameters: self.parameters.clone(),
            quasi_velocities: velocities,
            frame,
            structure,
        })
    }
}

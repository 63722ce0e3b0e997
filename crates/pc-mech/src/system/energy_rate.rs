//! The rate of the energy along the motion.

use pc_expr::Expr;

use crate::system::system::System;

impl<'g> System<'g> {
    /// The rate of the energy H = y_s η_s − L along the motion,
    ///
    ///   dH/dt = X_0 H + c_0r^m η_r y_m + Q_s η_s − ż ∂L/∂z − u̇ ∂L/∂u,
    ///
    /// where z are first-order states and u signals, in terms of (t, x, η): X_0 H at fixed y is −X_0 L at fixed η, so
    /// y = ∂L/∂η need not be solved for η. Where neither L nor the frame depends on time and b_0 = 0, the rate is the
    /// power Q_s η_s of the forces.
    pub fn energy_rate(&self) -> Expr<'g> {
        let (graph, eta) = (self.graph(), self.quasi_velocities());
        let explicit = self.frame.apply(0, &[self.lagrangian])[0];
        let beside = [self.states.as_slice(), &self.signal_rates()].concat();
        let of_states = graph.directional(&[self.lagrangian], &beside)[0];
        let y = self.momenta();
        let drift = self.structure.nonzero().filter(|&(r, ..)| r == 0);
        let drift = drift.map(|(_, r, m, c)| c * eta[r - 1] * y[m - 1]);
        let power = self.forces.iter().zip(eta).map(|(&q, &eta)| q * eta);
        graph.sum(drift.chain(power).chain([-explicit, -of_states]))
    }
}

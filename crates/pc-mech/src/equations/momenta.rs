//! Functions of velocities in terms of momenta.

use pc_expr::Expr;

use crate::compiled::elimination::symbolic_ldl::Factors;
use crate::equations::canonical::Canonical;

impl<'g> Canonical<'g> {
    /// The function f(t, x, η) in terms of (t, x, y); f itself where the equations are not
    /// [closed](Canonical::is_closed).
    #[must_use]
    pub fn in_momenta(&self, f: Expr<'g>) -> Expr<'g> {
        let (system, eta) = (self.system(), self.quasi_velocities());
        let values: Vec<_> = system.quasi_velocities().iter().copied().zip(eta.iter().copied()).collect();
        system.graph().substitute(&[f], &values)[0]
    }

    /// The k symbols of y, each paired with y_s = ∂L/∂η_s in terms of (t, x, η).
    pub fn values_of_momenta(&self) -> Vec<(Expr<'g>, Expr<'g>)> {
        self.momenta().iter().copied().zip(self.momenta_of_velocities().iter().copied()).collect()
    }

    /// The k accelerations η̇ in terms of (t, x, η), from ẏ = ∂p/∂t + ∂p/∂x ẋ + M η̇ with
    /// p = ∂L/∂η.
    pub fn accelerations(&self) -> Vec<Expr<'g>> {
        let (system, graph) = (self.system(), self.system().graph());
        let x = system.frame().coordinates().iter().copied().zip(self.velocities().iter().copied());
        let states = system.states.iter().copied();
        let along: Vec<_> = x.chain(graph.in_time(system.frame().time())).chain(states).collect();
        let transport = graph.directional(self.momenta_of_velocities(), &along);
        let rates = graph.substitute(self.right_hand_side(), &self.values_of_momenta());
        let right: Vec<Expr<'g>> =
            rates.iter().zip(transport).map(|(&rate, transport)| rate - transport).collect();
        Factors::of(graph, &self.legendre.mass).solve(graph, &right)
    }
}

//! Systems in which some quasi-velocities are kept at zero.

use pc_mech::{Equations, Expr, System};

use crate::error::NonholoError;

/// A system with the nonholonomic constraints η_α = 0, its equations (30), and the reactions that enforce the
/// constraints.
#[derive(Clone, Debug)]
pub struct Constrained<'g> {
    /// The whole system, with the free quasi-velocities first.
    system: System<'g>,
    equations: Equations<'g>,
}

impl<'g> Constrained<'g> {
    /// The `system` with the quasi-velocities whose symbols are `vanishing` kept at zero; the others stay in
    /// their order.
    ///
    /// # Errors
    /// [`NonholoError::NotAQuasiVelocity`]; [`NonholoError::Twice`];
    /// [`LagrangianError::Degenerate`](pc_mech::LagrangianError::Degenerate) if the free quasi-velocities have no
    /// inertia.
    pub fn new(system: &System<'g>, vanishing: &[Expr<'g>]) -> Result<Constrained<'g>, NonholoError> {
        let all = system.quasi_velocities();
        for (i, eta) in vanishing.iter().enumerate() {
            let name = eta.to_string();
            if !all.contains(eta) {
                return Err(NonholoError::NotAQuasiVelocity { name });
            }
            if vanishing[..i].contains(eta) {
                return Err(NonholoError::Twice { name });
            }
        }
        let (fixed, free): (Vec<usize>, Vec<usize>) =
            (0..all.len()).partition(|&s| vanishing.contains(&all[s]));
        let order: Vec<usize> = free.iter().chain(&fixed).copied().collect();
        let system = system.permuted(&order);
        let equations = system.poincare_constrained(free.len())?;
        Ok(Constrained { system, equations })
    }

    /// The whole system of k quasi-velocities, with the l free ones first.
    pub fn system(&self) -> &System<'g> {
        &self.system
    }

    /// The symbols of the k − l quasi-velocities that are kept at zero.
    pub fn vanishing(&self) -> &[Expr<'g>] {
        &self.system.quasi_velocities()[self.equations.right_hand_side().len()..]
    }

    /// The l equations (30) of the free quasi-velocities, with ẋ_i = b_is η_s + b_i0 (29), s = 1..l.
    pub fn equations(&self) -> &Equations<'g> {
        &self.equations
    }

    /// The system of the free quasi-velocities, with the constraints substituted into L; the terms that this
    /// substitution loses are added to its forces. Its equations are (32), and in momenta (34).
    ///
    /// # Errors
    /// [`NonholoError::Mech`] if the parts were inconsistent, which cannot happen.
    pub fn free_system(&self) -> Result<System<'g>, NonholoError> {
        Ok(self.system.constrained(self.equations.right_hand_side().len())?)
    }

    /// The k − l reactions λ_α conjugate to the vanishing η_α, in the order of the system: the residuals
    ///
    ///   λ_α = D_t p_α − (c_rα^m η_r + c_0α^m) p_m − X_α L − Q_α
    ///
    /// of the dropped equations along the motion, as functions of (t, x, free η). They are Lagrange's
    /// multipliers.
    pub fn reactions(&self) -> Vec<Expr<'g>> {
        self.reactions_by(&self.equations.accelerations())
    }

    /// The reactions in terms of these accelerations of the free η, which may be symbols.
    pub fn reactions_by(&self, accelerations: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let (system, graph) = (&self.system, self.system.graph());
        let frame = system.frame();
        let (x, all) = (frame.coordinates(), system.quasi_velocities());
        let free = self.equations.right_hand_side().len();
        let zeros: Vec<_> = all[free..].iter().map(|&eta| (eta, Expr::ZERO)).collect();
        let on_constraints = |expressions: &[Expr<'g>]| graph.substitute(expressions, &zeros);

        let momenta = on_constraints(&system.momenta());
        let slope = on_constraints(&graph.gradient(system.lagrangian(), x));
        let forces = on_constraints(system.forces());
        let gyroscopic = system.structure().gyroscopic(graph, &on_constraints(all), &momenta);
        let potential = frame.contract(&slope);

        let mut rates: Vec<_> = x.iter().copied().zip(self.equations.velocities().iter().copied()).collect();
        rates.extend(all.iter().copied().zip(accelerations.iter().copied()));
        rates.extend(graph.in_time(frame.time()));
        rates.extend(self.equations.system().states().iter().copied());
        let transport = graph.directional(&momenta[free..], &rates);
        let reactions: Vec<Expr<'g>> = (free..all.len())
            .map(|a| graph.sum([transport[a - free], -gyroscopic[a], -potential[a], -forces[a]]))
            .collect();
        let parameters = system.parameters().iter().map(|&(symbol, _)| symbol);
        let order: Vec<Expr<'g>> = all[..free].iter().copied().chain(parameters).collect();
        graph.shorten(&reactions, &order)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pc_mech::Graph;

    /// The blade pushes the mass centre sideways with m (v ω + a ω̇), ω̇ = −m a v ω/(J + m a²).
    #[test]
    fn the_blade_of_the_sleigh_carries_the_lateral_force() {
        let graph = Graph::new();
        let [m, j, a, u, v, w] = graph.symbols(["m", "J", "a", "u", "v", "w"]);
        let sleigh = System::builder(&graph)
            .coordinates(["x", "y", "phi"])
            .quasi_velocities(["u", "v", "w"])
            .kinematics(|_, x, eta| {
                let (s, c) = (x[2].sin(), x[2].cos());
                [eta[1] * c - eta[0] * s, eta[1] * s + eta[0] * c, eta[2]]
            })
            .lagrangian(|_, _, eta| {
                (m * (eta[1].square() + (eta[0] + a * eta[2]).square()) + j * eta[2].square()) / 2.0
            })
            .build()
            .unwrap();
        let constrained = Constrained::new(&sleigh, &[u]).unwrap();
        let expected = m * v * w - m.square() * a.square() * v * w / (j + m * a.square());
        assert!((constrained.reactions()[0] - expected).is_zero());
        let error = Constrained::new(&sleigh, &[u, u]).unwrap_err();
        assert_eq!(error.to_string(), "`u` is constrained twice");
    }
}

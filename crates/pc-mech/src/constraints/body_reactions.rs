//! Reactions of constraints as forces and torques on bodies.

use pc_algebra::Matrix;
use pc_expr::{Expr, Graph};

use crate::compiled::elimination::symbolic_ldl::Factors;
use crate::constraints::multipliers::Multipliers;
use crate::system::bodies::velocity::BodyVelocity;
use crate::system::system::System;

/// The reactions of constraints on one body: for each constraint a force at the body's point, along the axes of its
/// position, and a torque about this point, along the axes of its angular velocity.
#[derive(Clone, Debug)]
pub struct BodyReaction<'g> {
    name: String,
    turns: bool,
    forces: Option<Vec<Vec<Expr<'g>>>>,
    torques: Option<Vec<Vec<Expr<'g>>>>,
}

impl<'g> BodyReaction<'g> {
    /// The name of the body.
    pub fn body(&self) -> &str {
        &self.name
    }

    /// Whether the body has an angular velocity.
    pub fn turns(&self) -> bool {
        self.turns
    }

    /// The force λ_α f_α of the constraint with that index, with the symbol λ_α and otherwise in terms of (t,
    /// x, η). It has as many components as the position. None if it is not determined.
    pub fn force(&self, constraint: usize) -> Option<&[Expr<'g>]> {
        self.forces.as_ref()?.get(constraint).map(Vec::as_slice)
    }

    /// The torque λ_α n_α, with the same symbols, and with 3 components. None if it is not determined or the
    /// body does not turn.
    pub fn torque(&self, constraint: usize) -> Option<&[Expr<'g>]> {
        self.torques.as_ref()?.get(constraint).map(Vec::as_slice)
    }
}

impl<'g> System<'g> {
    /// The bodies from which the system was built, in order, with their velocities.
    pub fn bodies(&self) -> &[BodyVelocity<'g>] {
        &self.bodies.list
    }
}

impl<'g> Multipliers<'g> {
    /// The reactions on each body, found by virtual work: forces F at the points r of the bodies and torques N
    /// with
    ///
    ///   Σ (F · ∂ṙ/∂η_s + N · ∂ω/∂η_s) = λ_α C_αs,   s = 1..k.
    ///
    /// The condition determines the force on a body if ṙ can be varied independently of the velocities of all
    /// other bodies, of its own ω, and of other velocities in the kinetic energy: the rank of the derivatives
    /// of all of these with respect to η must be the rank of ∂ṙ/∂η plus the rank of the other derivatives. The
    /// force is determined up to a part normal to all ṙ that the coordinates allow; this part is left out,
    /// since it belongs to the supports implied by the coordinates. The same holds for torques, with ω in
    /// place of ṙ.
    ///
    /// If the choice of coordinates ties velocities together, as the angle of a rod does for two masses on it,
    /// the forces between them are not reactions of constraints, and virtual work does not determine how they
    /// share the load.
    ///
    /// ```
    /// use pc_mech::{Constraint, Graph, Particle, System};
    ///
    /// // A pendulum in the plane: the rod pulls with 2λ r, λ = −½ m (|ṙ|² + g l cos θ)/l².
    /// let graph = Graph::new();
    /// let pendulum = System::builder(&graph)
    ///     .coordinates(["x", "y"])
    ///     .particle(|_, x, _| Particle::new(3, [x[0], x[1]]).force([0, -30]).named("bob"))
    ///     .build()?;
    /// let [x, y, reaction] = graph.symbols(["x", "y", "λ_length"]);
    /// let length = Constraint::new("length", x.square() + y.square() - 1.0);
    /// let bob = &pendulum.with_multipliers(&[length])?.body_reactions()[0];
    /// assert_eq!(bob.body(), "bob");
    /// assert_eq!(bob.force(0), Some(&[2.0 * x * reaction, 2.0 * y * reaction][..]));
    /// # Ok::<(), pc_mech::MechError>(())
    /// ```
    pub fn body_reactions(&self) -> Vec<BodyReaction<'g>> {
        let system = &self.equations.system;
        let velocities = Velocities::of(system);
        let displacements = velocities.of_reactions(&self.coefficients);
        let along = |block: usize| -> Option<Vec<Vec<Expr<'g>>>> {
            let displacements = displacements.as_ref().filter(|_| velocities.is_independent(block))?;
            let pairs = displacements.iter().zip(&self.reactions);
            Some(pairs.map(|(z, &reaction)| velocities.component(block, z, reaction)).collect())
        };
        let mut block = 0;
        let mut next = || {
            block += 1;
            along(block - 1)
        };
        let reaction = |body: &BodyVelocity<'g>| BodyReaction {
            name: body.name.clone(),
            turns: body.angular_velocity.is_some(),
            forces: next(),
            torques: body.angular_velocity.as_ref().and_then(|_| next()),
        };
        system.bodies().iter().map(reaction).collect()
    }
}

/// The derivatives of velocities with respect to η, in blocks: ṙ and ω of the bodies, in their order, then the
/// other velocities in L.
struct Velocities<'a, 'g> {
    system: &'a System<'g>,
    blocks: Vec<Vec<Vec<Expr<'g>>>>,
}

impl<'a, 'g> Velocities<'a, 'g> {
    fn of(system: &'a System<'g>) -> Velocities<'a, 'g> {
        let (graph, eta) = (system.graph(), system.quasi_velocities());
        let rows = |list: &[Expr<'g>]| list.iter().map(|&v| graph.gradient(v, eta)).collect::<Vec<_>>();
        let bodies = system.bodies().iter();
        let of_bodies = bodies.flat_map(|body| std::iter::once(&body.velocity).chain(&body.angular_velocity));
        let mut blocks: Vec<Vec<Vec<Expr<'g>>>> = of_bodies.map(|v| rows(v)).collect();
        blocks.push(rows(&graph.gradient(system.bodies.rest, eta)));
        Velocities { system, blocks }
    }

    fn graph(&self) -> &'g Graph {
        self.system.graph()
    }

    /// Whether block number `b` varies independently of the others.
    fn is_independent(&self, b: usize) -> bool {
        let rank = |rows: &[Vec<Expr<'g>>]| self.graph().generic_rank(rows);
        let others = [&self.blocks[..b], &self.blocks[b + 1..]].concat().concat();
        rank(&self.blocks.concat()) == rank(&self.blocks[b]) + rank(&others)
    }

    /// The z_α that solve (JᵀJ) z_α = C_α, where J consists of all blocks: J z_α are the smallest possible
    /// forces. None if the blocks do not determine all quasi-velocities.
    fn of_reactions(&self, coefficients: &Matrix<Expr<'g>>) -> Option<Vec<Vec<Expr<'g>>>> {
        let (graph, rows, k) = (self.graph(), self.blocks.concat(), coefficients.columns());
        if graph.generic_rank(&rows) < k {
            return None;
        }
        let product = |r: usize, s: usize| graph.dot(rows.iter().map(|j| j[r]), rows.iter().map(|j| j[s]));
        let order = self.system.collecting_order();
        let entries: Vec<Expr<'g>> =
            (0..k * k).map(|i| product((i / k).max(i % k), (i / k).min(i % k))).collect();
        let entries = graph.shorten(&entries, &order);
        let factors = Factors::of(graph, &Matrix::from_fn(k, k, |r, s| entries[r * k + s]));
        Some((0..coefficients.rows()).map(|a| factors.solve(graph, &coefficients.row(a))).collect())
    }

    /// λ J_b z
    fn component(&self, b: usize, z: &[Expr<'g>], reaction: Expr<'g>) -> Vec<Expr<'g>> {
        let graph = self.graph();
        let forces = self.blocks[b].iter().map(|j| graph.dot(j.iter().copied(), z.iter().copied()));
        let forces: Vec<Expr<'g>> = forces.collect();
        let short = graph.shorten(&forces, &self.system.collecting_order());
        short.into_iter().map(|force| reaction * force).collect()
    }
}

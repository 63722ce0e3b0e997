//! Forward and inverse dynamics of a tree, one link at a time.
//!
//! From the root to the tips each link has its angular velocity and its accelerations along its own axes,
//!
//!   ω = Rᵀ ω_p + ω_r,   α = Rᵀ α_p + ω × ω_r + ω̇_r,   a = Rᵀ (a_p + B_p r) + (2ω − ω_r) × v_r + v̇_r,
//!
//! with ω_r, v_r relative to the parent and B = α̂ + ω̂ω̂; the world accelerates by −g, which replaces the
//! weights. The force on the link is f = m a + B h, n = I α + ω × I ω + h × a, with the first moment h = m c.
//! The difference between η̇ and the accelerations in a reference motion is computed with [articulated
//! inertias](crate::tree::articulated). In the reference motion the components of α and a that the joint
//! leaves free are zero, an arbitrary choice.
//!
//! These are Poincaré's equations (9) with the velocities of all links as auxiliary quasi-velocities: d/dt
//! ∂T/∂ω + ω × ∂T/∂ω for each link is (18) on its Lie algebra, and the joints are constraints that relate the
//! velocities of the links to η.

use pc_expr::{Expr, Graph};

use crate::tree::articulated::Articulated;
use crate::tree::inertia6::{Spatial, force_seen, joined};
use crate::tree::link::Link;
use crate::tree::spatial::{Tensor, Vector, ZERO, cross, tensor, vector};
use crate::tree::tree::{MassOnLink, Tree};

/// The acceleration of a link.
#[derive(Clone, Copy, Debug)]
struct Acceleration<'g> {
    omega: Vector<'g>,
    /// ω_i ω_j
    squares: Tensor<'g>,
    /// B = α̂ + ω̂ω̂
    field: Tensor<'g>,
    alpha: Vector<'g>,
    a: Vector<'g>,
}

impl<'g> Acceleration<'g> {
    fn new(graph: &'g Graph, omega: Vector<'g>, alpha: Vector<'g>, a: Vector<'g>) -> Acceleration<'g> {
        let squares = tensor(|i, j| graph.keep(omega[i] * omega[j]));
        let field = tensor(|i, j| {
            graph.keep(if i == j {
                -(squares[(i + 1) % 3][(i + 1) % 3] + squares[(i + 2) % 3][(i + 2) % 3])
            } else if j == (i + 1) % 3 {
                squares[i][j] - alpha[(i + 2) % 3]
            } else {
                squares[i][j] + alpha[(i + 1) % 3]
            })
        });
        Acceleration { omega, squares, field, alpha, a }
    }

    /// a + B r
    fn of_point(&self, graph: &'g Graph, r: &Vector<'g>) -> Vector<'g> {
        vector(|i| graph.keep(graph.sum((0..3).map(|j| r[j] * self.field[i][j]).chain([self.a[i]]))))
    }

    /// The moment and force that accelerate a body with this mass.
    fn force(&self, graph: &'g Graph, body: &MassOnLink<'g>) -> Spatial<'g> {
        let MassOnLink { mass, moment: h, inertia } = body;
        let f = vector(|i| {
            let terms = (0..3).map(|j| h[j] * self.field[i][j]).chain([*mass * self.a[i]]);
            graph.keep(graph.sum(terms))
        });
        let n = vector(|i| {
            let (j, l) = ((i + 1) % 3, (i + 2) % 3);
            let euler = (0..3).map(|r| inertia[i][r] * self.alpha[r]);
            let gyroscopic = [
                (inertia[l][l] - inertia[j][j]) * self.squares[j][l],
                inertia[j][l] * self.squares[j][j],
                -(inertia[j][l] * self.squares[l][l]),
                inertia[l][i] * self.squares[i][j],
                -(inertia[j][i] * self.squares[i][l]),
            ];
            let carried = [h[j] * self.a[l], -(h[l] * self.a[j])];
            graph.keep(graph.sum(euler.chain(gyroscopic).chain(carried)))
        });
        joined(&n, &f)
    }
}

/// The equations of a tree, with τ: the components of Q + X U on its joints, link by link.
#[derive(Clone, Debug)]
pub(crate) struct TreeDynamics<'g> {
    graph: &'g Graph,
    links: Vec<Link<'g>>,
    masses: Vec<MassOnLink<'g>>,
    gravity: Vector<'g>,
    applied: Vec<Vec<Expr<'g>>>,
    pub(crate) articulated: Articulated<'g>,
}

impl<'g> TreeDynamics<'g> {
    pub(crate) fn new(tree: &Tree<'g>, gravity: Vector<'g>, applied: Vec<Vec<Expr<'g>>>) -> TreeDynamics<'g> {
        let masses = tree.regrouped();
        let own: Vec<MassOnLink<'g>> = (0..tree.links.len()).map(|link| tree.mass_on(link)).collect();
        TreeDynamics {
            graph: tree.graph,
            articulated: Articulated::of(
                tree.graph,
                &tree.links,
                &masses,
                tree.is_definite().then_some(&own),
            ),
            links: tree.links.clone(),
            masses,
            gravity,
            applied,
        }
    }

    /// Gravity, then the components of τ: all that is not made of masses and positions.
    pub(crate) fn forces(&self) -> Vec<Expr<'g>> {
        self.gravity.iter().chain(self.applied.iter().flatten()).copied().collect()
    }

    /// The equations with others in place of the [`forces`](TreeDynamics::forces).
    pub(crate) fn with_forces(self, forces: &[Expr<'g>]) -> TreeDynamics<'g> {
        let (gravity, mut rest) = forces.split_at(3);
        let mut take = |own: &Vec<Expr<'g>>| {
            let (taken, left) = rest.split_at(own.len());
            rest = left;
            taken.to_vec()
        };
        let applied = self.applied.iter().map(&mut take).collect();
        TreeDynamics { gravity: std::array::from_fn(|i| gravity[i]), applied, ..self }
    }

    /// The accelerations η̇, link by link.
    pub(crate) fn accelerations(&self) -> Vec<Vec<Expr<'g>>> {
        let (motions, dropped) = self.motions(None);
        let forces =
            motions.iter().zip(&self.masses).map(|(motion, mass)| Some(motion.force(self.graph, mass)));
        let relative = self.articulated.solve(forces.collect(), &self.applied);
        let total = |(relative, dropped): (Vec<Expr<'g>>, &Vec<Expr<'g>>)| {
            relative.into_iter().zip(dropped).map(|(w, &dropped)| w - dropped).collect()
        };
        relative.into_iter().zip(&dropped).map(total).collect()
    }

    /// The moments and forces that give bodies with these masses, each on a link or in the world, the motion with
    /// the accelerations `unknowns`, along the axes of the links and about their origins.
    pub(crate) fn required(
        &self,
        unknowns: &[Vec<Expr<'g>>],
        masses: impl Iterator<Item = (Option<usize>, MassOnLink<'g>)>,
    ) -> Vec<Spatial<'g>> {
        let (motions, _) = self.motions(Some(unknowns));
        let world = self.world();
        masses
            .map(|(link, mass)| link.map_or(&world, |link| &motions[link]).force(self.graph, &mass))
            .collect()
    }

    /// The acceleration of the world in which the weights are no forces.
    fn world(&self) -> Acceleration<'g> {
        Acceleration::new(self.graph, ZERO, ZERO, self.gravity.map(|g| -g))
    }

    /// The moments and forces of the joints on the links for the accelerations `unknowns`.
    fn forces_on_joints(&self, unknowns: &[Vec<Expr<'g>>]) -> Vec<Spatial<'g>> {
        let graph = self.graph;
        let (motions, _) = self.motions(Some(unknowns));
        let taken = motions.iter().zip(&self.masses).map(|(motion, mass)| motion.force(graph, mass));
        let mut forces: Vec<Spatial<'g>> = taken.collect();
        for (i, link) in self.articulated.links.iter().enumerate().rev() {
            if let Some(parent) = link.parent {
                let seen = force_seen(graph, &link.turning, &link.place, &forces[i]);
                forces[parent] = std::array::from_fn(|c| graph.keep(forces[parent][c] + seen[c]));
            }
        }
        forces
    }

    /// The difference between τ and the forces that the accelerations `unknowns` require, link by link; zero
    /// for the solution.
    pub(crate) fn balance(&self, unknowns: &[Vec<Expr<'g>>]) -> Vec<Vec<Expr<'g>>> {
        let forces = self.forces_on_joints(unknowns);
        let left = |(i, applied): (usize, &Vec<Expr<'g>>)| {
            let needed = self.articulated.along(i, &forces, &unknowns[i]);
            applied.iter().zip(needed).map(|(&applied, needed)| applied - needed).collect()
        };
        self.applied.iter().enumerate().map(left).collect()
    }

    /// The accelerations of the links for these η̇, or, without η̇, in the reference motion, where the free
    /// components are zero.
    fn motions(&self, unknowns: Option<&[Vec<Expr<'g>>]>) -> (Vec<Acceleration<'g>>, Vec<Vec<Expr<'g>>>) {
        let graph = self.graph;
        let world = self.world();
        let mut motions: Vec<Acceleration<'g>> = Vec::with_capacity(self.links.len());
        let mut dropped = Vec::with_capacity(self.links.len());
        for (i, (link, known)) in self.links.iter().zip(&self.articulated.links).enumerate() {
            let parent = link.parent.map_or(world, |parent| motions[parent]);
            let (turn, shift) = (link.hinge.omega(), link.hinge.velocity());
            let carried = known.turning.to_link(graph, &parent.omega);
            let omega = vector(|c| graph.keep(carried[c] + turn[c]));
            let gained = cross(&omega, &turn);
            let alpha = known.turning.to_link(graph, &parent.alpha);
            let twice = vector(|c| 2.0 * omega[c] - turn[c]);
            let coriolis = cross(&twice, &shift);
            let a = known.turning.to_link(graph, &parent.of_point(graph, &known.place));
            let mut total = joined(
                &vector(|c| graph.keep(alpha[c] + gained[c])),
                &vector(|c| graph.keep(a[c] + coriolis[c])),
            );
            let mut left_out = vec![Expr::ZERO; link.quasi_velocities().len()];
            for (j, freedom) in known.freedoms.iter().enumerate() {
                match unknowns {
                    Some(unknowns) => freedom.accelerate(graph, &mut total, unknowns[i][j]),
                    None => left_out[j] = freedom.leave_out(&mut total),
                }
            }
            if let (Some(moved), Some(unknowns)) = (&known.moved, unknowns) {
                let shared = self.articulated.shared_by(i, unknowns).unwrap_or(Expr::ZERO);
                moved.accelerate(graph, &mut total, shared);
            }
            dropped.push(left_out);
            let (alpha, a) = (vector(|c| total[c]), vector(|c| total[c + 3]));
            motions.push(Acceleration::new(graph, omega, alpha, a));
        }
        (motions, dropped)
    }
}

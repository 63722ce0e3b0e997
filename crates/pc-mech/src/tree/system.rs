//! A system that is a tree.

use pc_algebra::Frame;
use pc_expr::{Expr, Graph};

use crate::error::{MechError, TreeError};
use crate::tree::dynamics::TreeDynamics;
use crate::tree::link::Link;
use crate::tree::spatial::Vector;
use crate::tree::tree::Tree;

/// A system whose inertia is entirely that of a tree: L consists of the kinetic energy of the tree, its
/// weight, and a force function U(t, x).
#[derive(Clone, Debug)]
pub(crate) struct TreeSystem<'g> {
    pub(crate) tree: Tree<'g>,
    pub(crate) gravity: Vector<'g>,
    /// U(t, x)
    pub(crate) others: Expr<'g>,
    /// The own quasi-velocities of each link, by their indices in the system.
    pub(crate) places: Vec<Vec<usize>>,
}

impl<'g> TreeSystem<'g> {
    /// The system of a tree with the rest of the Lagrangian; `None` if anything else has inertia, if the
    /// bodies do not move as the joints prescribe, if the tree lacks a quasi-velocity, or if gravity depends
    /// on the position, since the world then has no single acceleration.
    pub(crate) fn of(
        tree: Tree<'g>,
        gravity: Vector<'g>,
        others: Expr<'g>,
        frame: &Frame<'g>,
        eta: &[Expr<'g>],
    ) -> Option<TreeSystem<'g>> {
        let place = |symbol: &Expr<'g>| eta.iter().position(|eta| eta == symbol);
        let of_link =
            |link: &Link<'g>| -> Option<Vec<usize>> { link.quasi_velocities().iter().map(place).collect() };
        let places: Vec<Vec<usize>> = tree.links.iter().map(of_link).collect::<Option<_>>()?;
        let moved: usize = places.iter().map(Vec::len).sum();
        if moved != eta.len() || eta.iter().any(|&eta| others.depends_on(eta)) {
            return None;
        }
        if gravity.iter().any(|g| frame.coordinates().iter().any(|&x| g.depends_on(x))) {
            return None;
        }
        let velocities = frame.velocities(eta);
        let follows = |(x, velocity): (Expr<'g>, Expr<'g>)| {
            let i = frame.coordinates().iter().position(|known| *known == x);
            i.is_some_and(|i| (velocities[i] - velocity).is_zero())
        };
        let of_joints = tree.coordinates().into_iter().zip(tree.velocities());
        of_joints.into_iter().all(follows).then_some(TreeSystem { tree, gravity, others, places })
    }

    /// Whether the tree has too many quasi-velocities for its mass matrix to be written out as a whole.
    pub(crate) fn is_large(&self) -> bool {
        self.tree.is_large()
    }

    /// The energy T − U, where T is a quadratic form in η.
    pub(crate) fn energy(&self) -> Expr<'g> {
        let (kinetic, potential) = self.parts();
        kinetic - potential
    }

    /// L = T + U
    pub(crate) fn lagrangian(&self) -> Expr<'g> {
        let (kinetic, potential) = self.parts();
        kinetic + potential
    }

    /// T and U.
    fn parts(&self) -> (Expr<'g>, Expr<'g>) {
        let share = self.tree.motions().share(&self.gravity, &[]);
        let graph = self.tree.graph;
        (graph.sum(share.kinetic), graph.sum(share.weight) + self.others)
    }

    /// The equations of the tree, with the forces Q.
    pub(crate) fn dynamics(&self, frame: &Frame<'g>, forces: &[Expr<'g>]) -> TreeDynamics<'g> {
        let graph = self.tree.graph;
        let slopes = frame.contract(&graph.gradient(self.others, frame.coordinates()));
        let applied = |s: &usize| graph.keep(forces[*s] + slopes[*s]);
        let applied = self.places.iter().map(|places| places.iter().map(applied).collect()).collect();
        TreeDynamics::new(&self.tree, self.gravity, applied)
    }

    /// Puts components given link by link into the order of the quasi-velocities of the system.
    pub(crate) fn in_order(&self, by_link: &[Vec<Expr<'g>>]) -> Vec<Expr<'g>> {
        let count = self.places.iter().map(Vec::len).sum();
        let mut ordered = vec![Expr::ZERO; count];
        for (places, values) in self.places.iter().zip(by_link) {
            places.iter().zip(values).for_each(|(&place, &value)| ordered[place] = value);
        }
        ordered
    }

    /// The inverse of [`in_order`](TreeSystem::in_order).
    pub(crate) fn by_link(&self, ordered: &[Expr<'g>]) -> Vec<Vec<Expr<'g>>> {
        self.places.iter().map(|places| places.iter().map(|&place| ordered[place]).collect()).collect()
    }

    /// The system with `put` applied to each expression, in another graph.
    pub(crate) fn map<'n>(&self, graph: &'n Graph, put: impl Fn(Expr<'g>) -> Expr<'n>) -> TreeSystem<'n> {
        TreeSystem {
            tree: self.tree.map(graph, &put),
            gravity: self.gravity.map(&put),
            others: put(self.others),
            places: self.places.clone(),
        }
    }
}

impl<'g> Tree<'g> {
    /// Checks that masses and positions are constant along their axes.
    ///
    /// # Errors
    /// [`TreeError::NotConstant`] with the first of `moving` that occurs in one of them.
    pub(crate) fn check_constant(&self, moving: &[Expr<'g>]) -> Result<(), MechError> {
        for body in &self.bodies {
            let parts = [
                ("mass", vec![body.mass]),
                ("mass centre", body.centre.to_vec()),
                ("inertia", body.inertia.matrix().entries().to_vec()),
                ("place of the joint", body.joint.place.to_vec()),
                ("rotation of the joint", body.joint.rotation.concat()),
                ("armature of the joint", vec![body.joint.drive.armature]),
                ("ratio of the joint", body.joint.follows.iter().map(|follows| follows.ratio).collect()),
                ("offset of the joint", body.joint.follows.iter().map(|follows| follows.offset).collect()),
            ];
            for (what, parts) in parts {
                let known = self.graph.symbols_of(&parts);
                if let Some(symbol) = known.iter().find(|symbol| moving.contains(symbol)) {
                    let (body, symbol) = (body.name.clone(), symbol.to_string());
                    return Err(TreeError::NotConstant { body, what, symbol }.into());
                }
            }
        }
        Ok(())
    }
}

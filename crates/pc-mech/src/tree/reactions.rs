//! Forces on joints, and their reactions.

use pc_expr::Expr;

use crate::system::system::System;
use crate::tree::body::TreeBody;
use crate::tree::inertia6::{Spatial, force_seen, moving_part, turning_part};
use crate::tree::spatial::{apply, apply_transpose, cross, vector};
use crate::tree::system::TreeSystem;
use crate::tree::tree::Stand;

/// The force and the moment that a joint exerts on its body, in terms of (t, x, η, η̇).
///
/// Force and moment are along the axes of the body, and the moment is about its origin. Their components in
/// the free directions of a joint that moves by itself are the generalised forces on it, less what accelerates its
/// armature.
#[derive(Clone, Debug)]
pub struct JointReaction<'g> {
    pub(crate) body: String,
    pub(crate) force: [Expr<'g>; 3],
    pub(crate) moment: [Expr<'g>; 3],
    force_in_world: [Expr<'g>; 3],
}

/// A force and a torque on a body of a tree in addition to those of joints, weight and its own force and torque, such as
/// those of a constraint; along the axes of the world.
#[derive(Clone, Debug)]
pub struct PointLoad<'g> {
    /// The name of the body.
    pub body: String,
    /// The point at which the force acts, along the axes of the body from its origin.
    pub point: [Expr<'g>; 3],
    /// The force.
    pub force: [Expr<'g>; 3],
    /// The torque.
    pub torque: [Expr<'g>; 3],
}

impl<'g> JointReaction<'g> {
    /// The name of the body.
    pub fn body(&self) -> &str {
        &self.body
    }

    /// The force.
    pub fn force(&self) -> &[Expr<'g>; 3] {
        &self.force
    }

    /// The force along the axes of the world.
    pub fn force_in_world(&self) -> &[Expr<'g>; 3] {
        &self.force_in_world
    }

    /// The moment about the origin of the body.
    pub fn moment(&self) -> &[Expr<'g>; 3] {
        &self.moment
    }
}

impl<'g> System<'g> {
    /// The forces and moments of the joints of a [tree](crate::Tree) on their bodies (Newton's and Euler's
    /// equations from the tips to the root), in the order of declaration; none for a system that is not a tree. If
    /// added as [outputs](System::with_more_outputs), they are observed along a motion.
    pub fn joint_reactions(&self) -> Vec<JointReaction<'g>> {
        self.joint_reactions_under(&[])
    }

    /// The same with further forces and torques on bodies; those on bodies that are not of the tree are ignored.
    pub fn joint_reactions_under(&self, loads: &[PointLoad<'g>]) -> Vec<JointReaction<'g>> {
        let Some(tree) = &self.tree else { return Vec::new() };
        tree.reactions(self, loads)
    }

    /// The k generalised forces on the joints of the [tree](System::tree): Q + X U without the forces and
    /// torques on bodies, and without their weight. For a system that is not a tree, these are Q.
    pub fn joint_forces(&self) -> Vec<Expr<'g>> {
        self.tree.as_ref().map_or_else(|| self.forces.clone(), |tree| tree.joint_forces(self))
    }
}

impl<'g> TreeSystem<'g> {
    /// The forces on the joints: Q + X U without the forces and torques on the bodies.
    fn joint_forces(&self, system: &System<'g>) -> Vec<Expr<'g>> {
        let graph = self.tree.graph;
        let frame = &system.frame;
        let slopes = frame.contract(&graph.gradient(self.others, frame.coordinates()));
        let loads = self.tree.motions().share(&self.gravity, &system.quasi_velocities).forces;
        (0..slopes.len()).map(|s| system.forces[s] + slopes[s] - loads[s]).collect()
    }

    fn reactions(&self, system: &System<'g>, loads: &[PointLoad<'g>]) -> Vec<JointReaction<'g>> {
        let graph = self.tree.graph;
        let dynamics = self.dynamics(&system.frame, &system.forces);
        let unknowns = self.by_link(&system.accelerations());
        let motions = self.tree.motions();
        // What accelerates each body, less F and N, which act in addition to the joints.
        let bodies = self.tree.bodies.iter().zip(&self.tree.stands);
        let masses = bodies.clone().map(|(body, stand)| (stand.link, self.tree.mass_of(body, stand)));
        let mut borne = dynamics.required(&unknowns, masses);
        for (borne, (body, stand)) in borne.iter_mut().zip(bodies) {
            let force = apply_transpose(graph, &motions.of_stand(stand).rotation, &body.force);
            let arm = cross(&stand.point(graph, &body.centre), &force);
            let torque = apply(graph, &stand.rotation, &body.torque);
            for i in 0..3 {
                borne[i] = graph.keep(borne[i] - torque[i] - arm[i]);
                borne[i + 3] = graph.keep(borne[i + 3] - force[i]);
            }
        }
        for load in loads {
            let Some(body) = self.tree.place_of(&load.body) else { continue };
            let stand = &self.tree.stands[body];
            let rotation = motions.of_stand(stand).rotation;
            let force = apply_transpose(graph, &rotation, &load.force);
            let torque = apply_transpose(graph, &rotation, &load.torque);
            let arm = cross(&stand.point(graph, &load.point), &force);
            for i in 0..3 {
                borne[body][i] = graph.keep(borne[body][i] - torque[i] - arm[i]);
                borne[body][i + 3] = graph.keep(borne[body][i + 3] - force[i]);
            }
        }
        // From the tips to the root.
        for &(body, parent) in self.tree.order.iter().rev() {
            let Some(parent) = parent else { continue };
            let links = &dynamics.articulated.links[self.tree.own[body].clone()];
            let seen = links
                .iter()
                .rev()
                .fold(borne[body], |p, link| force_seen(graph, &link.turning, &link.place, &p));
            borne[parent] = std::array::from_fn(|i| graph.keep(borne[parent][i] + seen[i]));
        }
        let reaction = |(borne, (body, stand)): (&Spatial<'g>, (&TreeBody<'g>, &Stand<'g>))| {
            let (n, f) = (turning_part(borne), moving_part(borne));
            let arm = cross(&stand.place, &f);
            JointReaction {
                body: body.name.clone(),
                force: apply_transpose(graph, &stand.rotation, &f),
                moment: apply_transpose(graph, &stand.rotation, &vector(|i| n[i] - arm[i])),
                force_in_world: apply(graph, &motions.of_stand(stand).rotation, &f),
            }
        };
        borne.iter().zip(self.tree.bodies.iter().zip(&self.tree.stands)).map(reaction).collect()
    }
}

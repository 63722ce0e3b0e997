//! Forces on joints, and their reactions.

use pc_expr::Expr;

use crate::system::system::System;
use crate::tree::articulated::{Spatial, moving_part, turning_part};
use crate::tree::spatial::{apply, apply_transpose, cross};
use crate::tree::system::TreeSystem;

/// The force and the moment that a joint exerts on its body, in terms of (t, x, η, η̇).
///
/// Force and moment are along the axes of the body, and the moment is about its origin. Their components in
/// the free directions of the joint are the generalised forces on the joint.
#[derive(Clone, Debug)]
pub struct JointReaction<'g> {
    pub(crate) body: String,
    pub(crate) force: [Expr<'g>; 3],
    pub(crate) moment: [Expr<'g>; 3],
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

    /// The moment about the origin of the body.
    pub fn moment(&self) -> &[Expr<'g>; 3] {
        &self.moment
    }
}

impl<'g> System<'g> {
    /// The forces and moments of the joints of a [tree](crate::Tree) on their bodies (Newton's and Euler's
    /// equations from the tips to the root); none for a system that is not a tree, or for bodies fixed to
    /// others. If added as [outputs](System::with_more_outputs), they are observed along a motion.
    pub fn joint_reactions(&self) -> Vec<JointReaction<'g>> {
        let Some(tree) = &self.tree else { return Vec::new() };
        tree.reactions(self)
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

    fn reactions(&self, system: &System<'g>) -> Vec<JointReaction<'g>> {
        let graph = self.tree.graph;
        let dynamics = self.dynamics(&system.frame, &system.forces).with_own_masses(&self.tree);
        let unknowns = self.by_link(&system.accelerations());
        let motions = self.tree.motions();
        // F and N act in addition to the joints.
        let mut loads: Vec<Spatial<'g>> = vec![[Expr::ZERO; 6]; self.tree.links.len()];
        for (body, stand) in self.tree.bodies.iter().zip(&self.tree.stands) {
            let Some(link) = stand.link else { continue };
            let force = apply_transpose(graph, &motions.links[link].rotation, &body.force);
            let arm = cross(&stand.point(graph, &body.centre), &force);
            let torque = apply(graph, &stand.rotation, &body.torque);
            for i in 0..3 {
                loads[link][i] += torque[i] + arm[i];
                loads[link][i + 3] += force[i];
            }
        }
        let borne = dynamics.forces_on_joints(&unknowns, &loads);
        let mut reactions = Vec::new();
        for (body, (stand, own)) in self.tree.bodies.iter().zip(self.tree.stands.iter().zip(&self.tree.own)) {
            let Some(link) = stand.link.filter(|_| !own.is_empty()) else { continue };
            let (n, f) = (turning_part(&borne[link]), moving_part(&borne[link]));
            reactions.push(JointReaction {
                body: body.name.clone(),
                force: apply_transpose(graph, &stand.rotation, &f),
                moment: apply_transpose(graph, &stand.rotation, &n),
            });
        }
        reactions
    }
}

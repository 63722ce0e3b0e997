//! The forces and torques of joints on their bodies, as outputs.

use pc_mech::{Expr, JointReaction, System};

use crate::assembly::assembler::Assembler;
use crate::assembly::resultant::{joint_force_names, joint_torque_names};
use crate::diagnostics::error::ModelError;
use crate::diagnostics::meaning::MeaningError;

impl<'g> Assembler<'g, '_> {
    /// The system, with the forces and torques of joints substituted in its integrals and outputs. If all reactions
    /// are to be observed, those of all joints are added to the outputs.
    ///
    /// # Errors
    /// [`MeaningError::JointForceUnknown`] if the model names one that the motion of the bodies does not determine:
    /// where constraints act on bodies too, or energy belongs to no body.
    pub(crate) fn with_joint_reactions(&self, system: System<'g>) -> Result<System<'g>, ModelError> {
        let observes = self.model.observes_reactions() && !self.model.document().tree.is_empty();
        if !observes && self.scope.of_joints.is_empty() {
            return Ok(system);
        }
        let cause = if !self.model.document().constraints.is_empty() {
            "constraints act on bodies beside the joints"
        } else if system.tree().is_none() {
            "not all energy is that of bodies on joints"
        } else {
            let columns: Vec<(String, Expr<'g>)> = system.joint_reactions().iter().flat_map(named).collect();
            let known: Vec<_> =
                columns.iter().map(|(name, value)| (self.graph.symbol(name), *value)).collect();
            let more = if observes { columns } else { Vec::new() };
            return Ok(system.with_observed(&known).with_more_outputs(more));
        };
        match self.scope.of_joints.first() {
            None => Ok(system),
            Some((symbol, place)) => {
                let fault = MeaningError::JointForceUnknown { name: symbol.to_string(), cause };
                Err(self.model.document().error(place, fault))
            }
        }
    }
}

/// The components of a reaction with their names.
fn named<'g>(reaction: &JointReaction<'g>) -> Vec<(String, Expr<'g>)> {
    let body = reaction.body();
    let names = joint_force_names(body).into_iter().chain(joint_torque_names(body));
    names.zip(reaction.force_in_world().iter().chain(reaction.moment()).copied()).collect()
}

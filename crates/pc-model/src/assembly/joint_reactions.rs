//! The forces and torques of joints on their bodies, as outputs.

use pc_mech::{Expr, JointReaction, PointLoad, System};

use crate::assembly::assembler::Assembler;
use crate::assembly::resultant::{joint_force_names, joint_torque_names};
use crate::diagnostics::error::ModelError;
use crate::diagnostics::meaning::MeaningError;
use crate::names::momenta::cross;
use crate::names::scope::Scope;
use crate::names::stage::Stage;

impl<'g> Assembler<'g, '_> {
    /// The system, with the forces and torques of joints substituted in its integrals and outputs. If all reactions
    /// are to be observed, those of all joints are added to the outputs.
    ///
    /// # Errors
    /// [`MeaningError::JointForceUnknown`] if the model names one that the motion of the bodies does not determine:
    /// where constraints act on more than points of bodies, or energy belongs to no body.
    pub(crate) fn with_joint_reactions(&self, system: System<'g>) -> Result<System<'g>, ModelError> {
        let document = self.model.document();
        let observes =
            self.model.observes_reactions() && !document.tree.is_empty() && document.constraints.is_empty();
        if !observes && self.scope.of_joints.is_empty() {
            return Ok(system);
        }
        let loads = if system.tree().is_some() { self.loads_of_constraints()? } else { Some(Vec::new()) };
        let cause = if system.tree().is_none() {
            "not all energy is that of bodies on joints"
        } else if let Some(loads) = loads {
            let reactions = system.joint_reactions_under(&loads);
            let columns: Vec<(String, Expr<'g>)> = reactions.iter().flat_map(named).collect();
            let known: Vec<_> =
                columns.iter().map(|(name, value)| (self.graph.symbol(name), *value)).collect();
            let more = if observes { columns } else { Vec::new() };
            return Ok(system.with_observed(&known).with_more_outputs(more));
        } else {
            "a constraint is not a relation between points of bodies"
        };
        self.refuse_joint_reactions(cause)?;
        Ok(system)
    }

    /// # Errors
    /// [`MeaningError::JointForceUnknown`] if the model names a force or torque of a joint.
    pub(crate) fn refuse_joint_reactions(&self, cause: &'static str) -> Result<(), ModelError> {
        match self.scope.of_joints.first() {
            None => Ok(()),
            Some((symbol, place)) => {
                let fault = MeaningError::JointForceUnknown { name: symbol.to_string(), cause };
                Err(self.model.document().error(place, fault))
            }
        }
    }

    /// The forces λ ∂f/∂p at points p, and the torques λ Σ r_j × ∂f/∂r_j with the columns r_j of the rotations there, of the
    /// constraints f = 0 on positions; none if a constraint depends on more than points and time.
    fn loads_of_constraints(&self) -> Result<Option<Vec<PointLoad<'g>>>, ModelError> {
        let (graph, document) = (self.graph, self.model.document());
        let mut scope = Scope::new(graph, document);
        let names: Vec<&str> = document
            .points
            .iter()
            .flat_map(|point| &point.components)
            .map(|name| name.text.as_str())
            .collect();
        // No name of a text has a blank.
        let free: Vec<Expr<'g>> = names.iter().map(|name| graph.symbol(&format!("free {name}"))).collect();
        let mut values = Vec::with_capacity(names.len());
        for name in &names {
            values.push(scope.point(name)?);
        }
        let put: Vec<_> = free.iter().copied().zip(values.iter().copied()).collect();
        let by_name = names.iter().map(|&name| name.to_owned()).zip(free.iter().copied());
        let mut of_points = Scope::new(graph, document).with_points(by_name.collect());
        let moving = [scope.coordinates(), scope.velocities(), scope.quasi_velocities()].concat();
        let mut slopes = vec![Expr::ZERO; free.len()];
        for constraint in &document.constraints {
            let whole = scope.resolve(&constraint.expression, Stage::Constraint)?;
            let value = of_points.resolve(&constraint.expression, Stage::Constraint)?;
            let velocities = &moving[document.coordinates.len()..];
            let depends =
                |value: Expr<'g>, on: &[Expr<'g>]| on.iter().any(|&symbol| value.depends_on(symbol));
            if depends(whole, velocities) || depends(value, &moving) {
                return Ok(None);
            }
            let reaction = graph.symbol(&format!("λ_{}", constraint.name.text));
            let gradient = graph.substitute(&graph.gradient(value, &free), &put);
            slopes.iter_mut().zip(gradient).for_each(|(slope, own)| *slope += reaction * own);
        }
        let mut loads = Vec::new();
        for ((point, slopes), values) in
            document.points.iter().zip(slopes.chunks(OF_POINT)).zip(values.chunks(OF_POINT))
        {
            let Some(body) = point.body().filter(|_| slopes.iter().any(|slope| !slope.is_zero())) else {
                continue;
            };
            let at = match &point.at {
                Some(at) => scope.constants(at)?,
                None => [Expr::ZERO; 3],
            };
            let column = |of: &[Expr<'g>], j: usize| [of[3 + j], of[6 + j], of[9 + j]];
            let torques = [0, 1, 2].map(|j| cross(&column(values, j), &column(slopes, j)));
            loads.push(PointLoad {
                body: body.to_owned(),
                point: at,
                force: [slopes[0], slopes[1], slopes[2]],
                torque: [0, 1, 2].map(|i| graph.sum(torques.iter().map(|torque| torque[i]))),
            });
        }
        Ok(Some(loads))
    }
}

/// The components of a point: its position, and the rotation of its body row by row.
const OF_POINT: usize = 12;

/// The components of a reaction with their names.
fn named<'g>(reaction: &JointReaction<'g>) -> Vec<(String, Expr<'g>)> {
    let body = reaction.body();
    let names = joint_force_names(body).into_iter().chain(joint_torque_names(body));
    names.zip(reaction.force_in_world().iter().chain(reaction.moment()).copied()).collect()
}

//! The common state of the assembly: the model, the graph, and the names in scope.

use pc_mech::{Expr, Graph};

use crate::diagnostics::error::ModelError;
use crate::diagnostics::meaning::MeaningError;
use crate::document::{Expression, Name, QuasiVelocity};
use crate::model::model::Model;
use crate::names::scope::{Scope, entry};
use crate::names::stage::Stage;

/// Assembles a model as expressions of a graph; each part of the work has its own file.
pub(super) struct Assembler<'g, 'm> {
    pub(super) model: &'m Model,
    pub(super) graph: &'g Graph,
    pub(super) scope: Scope<'g, 'm>,
}

impl<'g> Assembler<'g, '_> {
    /// Whether η_s = ẋ_s because no quasi-velocity is declared.
    pub(super) fn is_lagrangian_form(&self) -> bool {
        self.model.document().quasi_velocities.is_empty()
    }

    /// Whether all quasi-velocities, apart from velocities x', belong to joints.
    pub(super) fn is_moved_by_joints(&self) -> bool {
        !self.model.document().tree.is_empty() && self.first_own_quasi_velocity().is_none()
    }

    /// The first quasi-velocity that neither belongs to a joint nor is a velocity x'.
    pub(super) fn first_own_quasi_velocity(&self) -> Option<&QuasiVelocity> {
        let document = self.model.document();
        let of_joints: usize = document.tree.iter().map(|body| body.joint.quasi_velocities.len()).sum();
        let is_velocity = |eta: &&QuasiVelocity| {
            let coordinate = eta.name.text.strip_suffix('\'');
            coordinate.is_some_and(|x| entry(&document.coordinates, x).is_some())
        };
        document.quasi_velocities.iter().skip(of_joints).find(|eta| !is_velocity(eta))
    }

    pub(super) fn not_a_coordinate(&self, name: &Name) -> ModelError {
        let coordinates = self.model.document().coordinates.iter().map(|c| c.name.text.clone()).collect();
        self.model
            .document()
            .error(&name.place, MeaningError::NotACoordinate { name: name.text.clone(), coordinates })
    }

    /// An expression of the dynamics with ẋ = b η + b_0 substituted.
    pub(super) fn dynamic(
        &mut self,
        expression: &Expression,
        x_dot: &[(Expr<'g>, Expr<'g>)],
    ) -> Result<Expr<'g>, ModelError> {
        let value = self.scope.resolve(expression, Stage::Dynamics)?;
        Ok(self.graph.substitute(&[value], x_dot)[0])
    }
}

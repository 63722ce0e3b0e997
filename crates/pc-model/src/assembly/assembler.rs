//! What the parts of the assembly share: the model, the graph, and the names in scope.

use pc_mech::{Expr, Graph};

use crate::diagnostics::error::ModelError;
use crate::diagnostics::meaning::MeaningError;
use crate::document::{Expression, Name};
use crate::model::model::Model;
use crate::names::scope::Scope;
use crate::names::stage::Stage;

/// Puts a model together as expressions of a graph; each part has a file of its own.
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

    pub(super) fn not_a_coordinate(&self, name: &Name) -> ModelError {
        let coordinates = self.model.document().coordinates.iter().map(|c| c.name.text.clone()).collect();
        self.model
            .document()
            .error(&name.place, MeaningError::NotACoordinate { name: name.text.clone(), coordinates })
    }

    /// An expression of the dynamics with ẋ = b η + b_0 put in.
    pub(super) fn dynamic(
        &mut self,
        expression: &Expression,
        x_dot: &[(Expr<'g>, Expr<'g>)],
    ) -> Result<Expr<'g>, ModelError> {
        let value = self.scope.resolve(expression, Stage::Dynamics)?;
        Ok(self.graph.substitute(&[value], x_dot)[0])
    }
}

//! The solution of Hamilton–Jacobi's equation given by a model.

use pc_mech::Expr;

use crate::assembly::assembler::Assembler;
use crate::diagnostics::error::ModelError;
use crate::names::scope::Scope;
use crate::names::stage::Stage;

/// The function S(t, x, α), with values of its constants α near which S is defined.
#[derive(Clone, Debug)]
pub struct Action<'g> {
    /// S.
    pub value: Expr<'g>,
    /// The constants α, each with its value.
    pub constants: Vec<(Expr<'g>, f64)>,
}

impl<'g> Assembler<'g, '_> {
    /// The action of `[hamilton_jacobi]`. The motion does not use the action, so that it need not have a
    /// value at the start: (x − α)²/(2t), for example, has none at t = 0. Its names are therefore resolved
    /// separately from those in expressions that need a value.
    pub(super) fn action(&self) -> Result<Option<Action<'g>>, ModelError> {
        let document = self.model.document();
        let Some(given) = &document.hamilton_jacobi else { return Ok(None) };
        let mut scope = Scope::new(self.graph, document);
        let value = scope.resolve(&given.action, Stage::Action)?;
        let constants =
            given.constants.iter().map(|(name, near)| (self.graph.symbol(&name.text), near.value));
        Ok(Some(Action { value, constants: constants.collect() }))
    }
}

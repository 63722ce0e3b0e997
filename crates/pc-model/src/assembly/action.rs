//! The solution of Hamilton–Jacobi's equation given by a model.

use pc_mech::Expr;

use crate::assembly::assembler::Assembler;
use crate::diagnostics::error::ModelError;
use crate::names::scope::Scope;
use crate::names::stage::Stage;

/// The function S(t, x, α), with values of its constants α near which it is defined.
#[derive(Clone, Debug)]
pub struct Action<'g> {
    /// S.
    pub value: Expr<'g>,
    /// The constants α, with these values.
    pub constants: Vec<(Expr<'g>, f64)>,
}

impl<'g> Assembler<'g, '_> {
    /// The action of `[hamilton_jacobi]`. The motion does not use it, so it need not have a value at the
    /// start, just as (x − α)²/(2t) has none at t = 0: its names are resolved separately from those that need
    /// one.
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

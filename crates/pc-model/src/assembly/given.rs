//! Quasi-velocities given in addition to those of the text.

use pc_algebra::affine;
use pc_mech::Expr;

use crate::assembly::assembler::Assembler;
use crate::diagnostics::error::ModelError;
use crate::diagnostics::error_kind::ErrorKind;
use crate::diagnostics::meaning::MeaningError;
use crate::names::scope::Scope;
use crate::names::stage::Stage;

impl<'g> Assembler<'g, '_> {
    /// The symbols of the given quasi-velocities, each with its definition in terms of (t, x, η). A
    /// definition that does not vanish for η = 0 is refused: it would change the energy y·η − L.
    pub(super) fn given_quasi_velocities(
        &self,
        eta: &[Expr<'g>],
        x_dot: &[(Expr<'g>, Expr<'g>)],
    ) -> Result<Vec<(Expr<'g>, Expr<'g>)>, ModelError> {
        let given = self.model.given_quasi_velocities().iter().map(|given| {
            let mut scope = Scope::new(self.graph, self.model.document()).elsewhere(&given.source);
            let value = scope.resolve(&given.expression, Stage::Function)?;
            let value = self.graph.substitute(&[value], x_dot)[0];
            let (whole, symbol) = (given.expression.whole(), self.graph.symbol(given.name()));
            let text = given.expression.text.clone();
            let refuse = |fault| Err(given.source.error(&whole, ErrorKind::Meaning(fault)));
            let of_motion = |symbol: &Expr<'g>| {
                let is_input = self.model.document().inputs.iter().any(|i| i.name.text == symbol.to_string());
                is_input || self.scope.states().contains(symbol)
            };
            if let Some(stray) = self.graph.symbols_of(&[value]).into_iter().find(of_motion) {
                let (name, allowed) = (stray.to_string(), "parameters, coordinates, velocities and t");
                return refuse(MeaningError::NotHere {
                    name,
                    place: "the definition of a quasi-velocity",
                    allowed,
                });
            }
            match affine(self.graph, value, eta) {
                Some((c, rest)) if rest.is_zero() => match c.iter().all(|c| c.is_zero()) {
                    true => refuse(MeaningError::NoVelocity { text }),
                    false => Ok((symbol, value)),
                },
                _ => refuse(MeaningError::NotLinear { text }),
            }
        });
        given.collect()
    }
}

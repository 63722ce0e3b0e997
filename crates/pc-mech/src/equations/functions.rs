//! Functions of the state of the equations.

use pc_expr::{Backend, Evaluator, Expr, Inputs, Program};

use crate::equations::poincare::Equations;
use crate::error::MechError;

impl<'g> Equations<'g> {
    /// An evaluator of `values` as functions of t, (x, η), the parameters and, after these, the symbols in `more`, for
    /// occasional evaluation.
    ///
    /// # Errors
    /// [`MechError`] for a value that contains another symbol.
    pub fn functions(&self, values: &[Expr<'g>], more: &[Expr<'g>]) -> Result<Evaluator, MechError> {
        let system = self.system();
        let parameters = system.parameters().iter().map(|&(symbol, _)| symbol);
        let inputs = Inputs {
            time: Some(system.frame().time()),
            state: system.state(),
            parameters: parameters.chain(more.iter().copied()).collect(),
        };
        Ok(Evaluator::new(Program::new(system.graph(), &inputs, values)?, Backend::Interpreter))
    }
}

//! Conditions that follow from the constraints and are checked during a projection.

use pc_expr::{Backend, Evaluator, Expr, ExprError, Graph, Inputs, Program};
use serde::{Deserialize, Serialize};

use crate::compiled::failure::EvaluationFailure;

/// The greatest error allowed in a derived condition, as a displacement of a component of the state,
/// absolute or relative, whichever is larger. Constraints hold up to rounding errors, and this is a hundred
/// times the tolerance for an initial state.
const OFF: f64 = 1e-6;

/// Functions of the state that vanish where the constraints hold, each representing a constraint.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Followers {
    names: Vec<String>,
    /// Computes each function, followed by its derivatives with respect to the components of the state.
    functions: Evaluator,
    values: Vec<f64>,
    state: usize,
}

impl Followers {
    /// The given functions, each with the name of the constraint that it represents.
    ///
    /// # Errors
    /// As for [`Program::new`].
    pub(crate) fn new<'g>(
        graph: &'g Graph,
        inputs: &Inputs<'g>,
        named: &[(String, Expr<'g>)],
    ) -> Result<Followers, ExprError> {
        let with_slopes = |&(_, function): &(String, Expr<'g>)| {
            std::iter::once(function).chain(graph.gradient(function, &inputs.state)).collect::<Vec<_>>()
        };
        let outputs: Vec<Expr<'g>> = named.iter().flat_map(with_slopes).collect();
        Ok(Followers {
            names: named.iter().map(|(name, _)| name.clone()).collect(),
            functions: Evaluator::new(Program::new(graph, inputs, &outputs)?, Backend::Interpreter),
            values: vec![0.0; outputs.len()],
            state: inputs.state.len(),
        })
    }

    /// Checks that all functions vanish at a state.
    ///
    /// # Errors
    /// [`EvaluationFailure::Departed`] for the first that does not vanish.
    pub(crate) fn check(&mut self, t: f64, y: &[f64], p: &[f64]) -> Result<(), EvaluationFailure> {
        if self.names.is_empty() {
            return Ok(());
        }
        self.functions.eval(t, y, p, &mut self.values);
        for (name, values) in self.names.iter().zip(self.values.chunks_exact(self.state + 1)) {
            let reach = values[1..].iter().zip(y).map(|(slope, y)| slope.abs() * y.abs().max(1.0));
            let reach = reach.fold(0.0, f64::max);
            let is_kept = values[0].abs() <= OFF * if reach > 0.0 { reach } else { 1.0 };
            if !is_kept {
                return Err(EvaluationFailure::Departed { constraint: name.clone() });
            }
        }
        Ok(())
    }
}

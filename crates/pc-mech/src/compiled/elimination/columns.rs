//! A matrix of expressions that computes only what is not zero.

use pc_expr::{Backend, Evaluator, Expr, ExprError, Graph, Inputs, Pattern, Program};

use crate::compiled::failure::{EvaluationFailure, check_finite};

/// A derivative of more operations is interpreted: integrators ask for it once in dozens of steps, and
/// machine code for it would take longer to make than a run.
const LONG_DERIVATIVE: usize = 5000;

/// How the entries of a matrix are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Storage {
    /// All, column after column.
    Dense,
    /// Those of its pattern, in order.
    Sparse,
}

/// The evaluator of a derivative.
///
/// # Errors
/// As for [`Program::new`].
pub(crate) fn derivative<'g>(
    graph: &'g Graph,
    inputs: &Inputs<'g>,
    values: &[Expr<'g>],
    backend: Backend,
) -> Result<Evaluator, ExprError> {
    let program = Program::new(graph, inputs, values)?;
    let long = program.code().len() > LONG_DERIVATIVE;
    Ok(Evaluator::new(program, if long { Backend::Interpreter } else { backend }))
}

/// The places of a matrix that are not zero everywhere, and what stands there, column after column.
pub(crate) fn nonzeros<'g>(rows: usize, columns: &[Vec<Expr<'g>>]) -> (Pattern, Vec<Expr<'g>>) {
    let pattern = Pattern::from_columns(
        rows,
        columns.iter().map(|column| (0..rows).filter(|&i| !column[i].is_zero()).collect::<Vec<_>>()),
    );
    let values = pattern.entries().map(|(i, j)| columns[j][i]).collect();
    (pattern, values)
}

/// A matrix of functions of (t, y, p), compiled.
#[derive(Clone, Debug)]
pub(crate) struct Columns {
    pattern: Pattern,
    entries: Evaluator,
    values: Vec<f64>,
}

impl Columns {
    /// The matrix of the columns given.
    ///
    /// # Errors
    /// As for [`Program::new`].
    pub(crate) fn new<'g>(
        graph: &'g Graph,
        inputs: &Inputs<'g>,
        columns: &[Vec<Expr<'g>>],
        backend: Backend,
    ) -> Result<Columns, ExprError> {
        let (pattern, values) = nonzeros(inputs.state.len(), columns);
        let entries = derivative(graph, inputs, &values, backend)?;
        Ok(Columns { values: vec![0.0; pattern.len()], pattern, entries })
    }

    pub(crate) fn pattern(&self) -> &Pattern {
        &self.pattern
    }

    /// Writes the entries.
    pub(crate) fn eval(
        &mut self,
        (t, y, p): (f64, &[f64], &[f64]),
        entries: &mut [f64],
        storage: Storage,
    ) -> Result<(), EvaluationFailure> {
        if storage == Storage::Sparse || self.pattern.is_full() {
            self.entries.eval(t, y, p, entries);
            return check_finite(entries, &self.entries, (t, y, p));
        }
        self.entries.eval(t, y, p, &mut self.values);
        self.pattern.scatter(&self.values, entries);
        check_finite(&self.values, &self.entries, (t, y, p))
    }
}

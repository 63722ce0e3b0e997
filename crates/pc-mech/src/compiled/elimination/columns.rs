//! A matrix of expressions of which only the nonzero entries are computed.

use pc_expr::{Backend, Evaluator, Expr, ExprError, Graph, Inputs, Pattern, Program};
use serde::{Deserialize, Serialize};

use crate::compiled::failure::{EvaluationFailure, check_finite};
use crate::compiled::point::Point;

/// A derivative with more operations than this is interpreted: integrators evaluate it once in dozens
/// of steps, and compiling it would take longer than a run.
const LONG_DERIVATIVE: usize = 5000;

/// Which entries of a matrix are written, and in what order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Storage {
    /// All entries, column by column.
    Dense,
    /// The entries in its pattern, in order.
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

/// The nonzero entries of a column with their row indices, or of a row with their column indices.
pub(crate) type SparseColumn<'g> = Vec<(usize, Expr<'g>)>;

/// The nonzero entries of a column.
pub(crate) fn sparse<'g>(column: &[Expr<'g>]) -> SparseColumn<'g> {
    column.iter().copied().enumerate().filter(|(_, x)| !x.is_zero()).collect()
}

/// The pattern of a matrix, and its nonzero entries, column by column.
pub(crate) fn nonzeros<'g>(
    rows: usize,
    columns: impl IntoIterator<Item = SparseColumn<'g>>,
) -> (Pattern, Vec<Expr<'g>>) {
    let columns: Vec<SparseColumn<'g>> = columns.into_iter().collect();
    let places = columns.iter().map(|column| column.iter().map(|&(row, _)| row));
    let pattern = Pattern::from_columns(rows, places);
    let values = columns.iter().flatten().map(|&(_, value)| value).collect();
    (pattern, values)
}

/// A compiled matrix of functions of (t, y, p).
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) struct Columns {
    pattern: Pattern,
    entries: Evaluator,
    values: Vec<f64>,
}

impl Columns {
    /// The matrix with the given number of rows and the given columns.
    ///
    /// # Errors
    /// As for [`Program::new`].
    pub(crate) fn new<'g>(
        graph: &'g Graph,
        inputs: &Inputs<'g>,
        (rows, columns): (usize, Vec<SparseColumn<'g>>),
        backend: Backend,
    ) -> Result<Columns, ExprError> {
        let (pattern, values) = nonzeros(rows, columns);
        let entries = derivative(graph, inputs, &values, backend)?;
        Ok(Columns { values: vec![0.0; pattern.len()], pattern, entries })
    }

    /// Compiles the entries, which are otherwise compiled on first use.
    pub(crate) fn prepare(&mut self) {
        self.entries.prepare();
    }

    pub(crate) fn pattern(&self) -> &Pattern {
        &self.pattern
    }

    /// Evaluates the matrix and writes its entries.
    pub(crate) fn eval(
        &mut self,
        Point { t, y, p }: Point<'_>,
        entries: &mut [f64],
        storage: Storage,
    ) -> Result<(), EvaluationFailure> {
        if storage == Storage::Sparse || self.pattern.is_full() {
            self.entries.eval(t, y, p, entries);
            return check_finite(entries, &self.entries, Point { t, y, p });
        }
        self.entries.eval(t, y, p, &mut self.values);
        self.pattern.scatter(&self.values, entries);
        check_finite(&self.values, &self.entries, Point { t, y, p })
    }
}

//! The symmetric equations of unknowns and multipliers, in numbers.

use pc_expr::Pattern;

use crate::compiled::dense_ldl::DenseLdl;
use crate::compiled::fault::Fault;
use crate::compiled::saddle::Saddle;

/// A symmetric matrix to be factorised and solved with.
#[derive(Clone, Debug)]
pub(crate) enum Solver {
    /// A mass matrix.
    Ldl(DenseLdl),
    /// A mass matrix bordered by constraints.
    Saddle(Box<Saddle>),
}

impl Solver {
    /// That of `size` unknowns, the last `multipliers` of which are multipliers.
    pub(crate) fn new(size: usize, multipliers: usize) -> Solver {
        match multipliers {
            0 => Solver::Ldl(DenseLdl::new(size)),
            m => Solver::Saddle(Box::new(Saddle::new(size - m, m))),
        }
    }

    /// Factorises the matrix, of which `values` stand at the places `lower` on and below the diagonal; all are
    /// finite.
    ///
    /// # Errors
    /// [`Fault::Pivot`] with the index of the unknown whose pivot vanishes, or [`Fault::Constraint`].
    pub(crate) fn factorise(&mut self, lower: &Pattern, values: &[f64]) -> Result<(), Fault> {
        match self {
            Solver::Ldl(ldl) => ldl.factorise(lower, values),
            Solver::Saddle(saddle) => saddle.factorise(lower, values),
        }
    }

    /// Replaces each of the columns, as long as there are unknowns, by the solution.
    pub(crate) fn solve(&mut self, columns: &mut [f64]) {
        match self {
            Solver::Ldl(ldl) => ldl.solve(columns),
            Solver::Saddle(saddle) => saddle.solve(columns),
        }
    }
}

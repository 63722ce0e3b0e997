//! The numerical solution of the symmetric equations for unknowns and multipliers.

use pc_expr::Pattern;
use serde::{Deserialize, Serialize};

use crate::compiled::elimination::dense_ldl::DenseLdl;
use crate::compiled::elimination::saddle_point::{Independence, Saddle};
use crate::compiled::failure::EvaluationFailure;

/// A symmetric matrix, to be factorised and used for solving.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(crate) enum Solver {
    /// A mass matrix.
    Ldl(DenseLdl),
    /// A mass matrix bordered by constraints.
    Saddle(Box<Saddle>),
}

impl Solver {
    /// The matrix of `size` unknowns, the last `multipliers` of which are multipliers of independent
    /// constraints.
    pub(crate) fn new(size: usize, multipliers: usize) -> Solver {
        Solver::of_rank(size, multipliers, multipliers)
    }

    /// The same matrix for constraints of which only `rank` are independent.
    pub(crate) fn of_rank(size: usize, multipliers: usize, rank: usize) -> Solver {
        match multipliers {
            0 => Solver::Ldl(DenseLdl::new(size)),
            m => Solver::Saddle(Box::new(Saddle::of_rank(size - m, m, rank))),
        }
    }

    /// Factorises the matrix, given by its `values` at the indices `lower` on and below the diagonal; all
    /// values must be finite.
    ///
    /// # Errors
    /// [`EvaluationFailure::Pivot`] with the index of the unknown whose pivot vanishes, or
    /// [`EvaluationFailure::Constraint`].
    pub(crate) fn factorise(&mut self, lower: &Pattern, values: &[f64]) -> Result<(), EvaluationFailure> {
        match self {
            Solver::Ldl(ldl) => ldl.factorise(lower, values),
            Solver::Saddle(saddle) => saddle.factorise(lower, values),
        }
    }

    /// The approximate number of operations needed to factorise a matrix with this many unknowns and
    /// multipliers and to solve with it once.
    pub(crate) fn operations(&self, size: usize, multipliers: usize) -> usize {
        let k = size - multipliers;
        match self {
            Solver::Ldl(_) => k * k * k / 6 + 2 * k * k,
            Solver::Saddle(saddle) => {
                let (m, rank) = (multipliers, saddle.dependent().len());
                let free = k - rank;
                let pivoting = 2 * rank * m * k;
                let reducing = free * rank * rank + 2 * k * free * rank + free * free * rank;
                pivoting + reducing + free * free * free / 6 + 4 * k * k
            }
        }
    }

    /// Whether multipliers of spare constraints have replaced others.
    pub(crate) fn takes_spare(&self) -> bool {
        match self {
            Solver::Ldl(_) => false,
            Solver::Saddle(saddle) => saddle.takes_spare(),
        }
    }

    /// Writes how far the constraints are from losing rank; false if there are none.
    pub(crate) fn independence_to(&self, found: &mut Independence) -> bool {
        match self {
            Solver::Ldl(_) => false,
            Solver::Saddle(saddle) => {
                saddle.independence_to(found);
                true
            }
        }
    }

    /// Replaces each of the columns, with one entry per unknown, by the solution.
    pub(crate) fn solve(&mut self, columns: &mut [f64]) {
        match self {
            Solver::Ldl(ldl) => ldl.solve(columns),
            Solver::Saddle(saddle) => saddle.solve(columns),
        }
    }
}

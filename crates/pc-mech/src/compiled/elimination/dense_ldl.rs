//! The numerical factorisation M = L D Lᵀ, with pivoting where a minor of a regular M vanishes.

use std::mem::MaybeUninit;

use faer::dyn_stack::MemStack;
use faer::linalg::cholesky::ldlt::factor::{LdltError, LdltRegularization, cholesky_in_place};
use faer::linalg::cholesky::ldlt::{factor, solve};
use faer::linalg::solvers::FullPivLu;
use faer::prelude::Solve;
use faer::{Mat, MatMut, Par};
use pc_expr::Pattern;
use serde::{Deserialize, Serialize};

use crate::compiled::elimination::pivots;
use crate::compiled::failure::EvaluationFailure;

/// In complete pivoting, pivots this small relative to the largest are treated as rounding errors.
const DEPENDENT: f64 = 1e-13;

/// A symmetric k × k matrix and, once it is factorised, L below the diagonal and D on it. Only k is stored.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(into = "usize", from = "usize")]
pub(crate) struct DenseLdl {
    matrix: Mat<f64>,
    /// The sizes against which pivots are compared: the diagonal of M unless others are given.
    sizes: Vec<f64>,
    pivots: Vec<f64>,
    scratch: Vec<MaybeUninit<u8>>,
    /// The factors found with complete pivoting, if elimination without it fails.
    pivoted: Option<Box<FullPivLu<f64>>>,
}

impl From<usize> for DenseLdl {
    fn from(k: usize) -> DenseLdl {
        DenseLdl::new(k)
    }
}

impl From<DenseLdl> for usize {
    fn from(factors: DenseLdl) -> usize {
        factors.sizes.len()
    }
}

impl DenseLdl {
    pub(crate) fn new(k: usize) -> DenseLdl {
        let scratch = factor::cholesky_in_place_scratch::<f64>(k, Par::Seq, Default::default());
        DenseLdl {
            matrix: Mat::zeros(k, k),
            sizes: vec![0.0; k],
            pivots: vec![0.0; k],
            scratch: vec![MaybeUninit::uninit(); scratch.unaligned_bytes_required()],
            pivoted: None,
        }
    }

    /// Factorises M, given by its `values` at the indices `lower` on and below the diagonal; all values must
    /// be finite.
    ///
    /// # Errors
    /// [`EvaluationFailure::Pivot`] for the first pivot that vanishes.
    pub(crate) fn factorise(&mut self, lower: &Pattern, values: &[f64]) -> Result<(), EvaluationFailure> {
        self.take(lower, values);
        for s in 0..self.sizes.len() {
            self.sizes[s] = self.matrix[(s, s)];
        }
        self.eliminate().or_else(|failure| self.eliminate_pivoted(lower, values, failure))
    }

    /// Factorises M, whose diagonal entries are sums of terms with the given sizes.
    ///
    /// # Errors
    /// As there.
    pub(crate) fn factorise_sum(
        &mut self,
        lower: &Pattern,
        values: &[f64],
        sizes: impl Iterator<Item = f64>,
    ) -> Result<(), EvaluationFailure> {
        self.take(lower, values);
        self.sizes.iter_mut().zip(sizes).for_each(|(place, size)| *place = size);
        self.eliminate().or_else(|failure| self.eliminate_pivoted(lower, values, failure))
    }

    fn take(&mut self, lower: &Pattern, values: &[f64]) {
        self.matrix.fill(0.0);
        for ((i, j), &value) in lower.entries().zip(values) {
            self.matrix[(i, j)] = value;
        }
    }

    /// Factorises with complete pivoting: an indefinite matrix such as ((0, 1), (1, 0)) may be regular
    /// though a leading minor vanishes.
    ///
    /// # Errors
    /// The given `failure`, which is that of elimination without pivoting, if M is singular.
    #[cold]
    fn eliminate_pivoted(
        &mut self,
        lower: &Pattern,
        values: &[f64],
        failure: EvaluationFailure,
    ) -> Result<(), EvaluationFailure> {
        self.take(lower, values);
        let (k, m) = (self.sizes.len(), &self.matrix);
        let factors = FullPivLu::new(Mat::from_fn(k, k, |i, j| m[(i.max(j), i.min(j))]).as_ref());
        let pivots = || (0..k).map(|s| factors.U()[(s, s)].abs());
        // The terms of an entry may be larger than the entry.
        let largest = pivots().chain(self.sizes.iter().map(|size| size.abs())).fold(0.0, f64::max);
        if !pivots().all(|pivot| pivot > DEPENDENT * largest) {
            return Err(failure);
        }
        self.pivoted = Some(Box::new(factors));
        Ok(())
    }

    fn eliminate(&mut self) -> Result<(), EvaluationFailure> {
        self.pivoted = None;
        let k = self.sizes.len();
        let outcome = cholesky_in_place(
            self.matrix.as_mut(),
            LdltRegularization::default(),
            Par::Seq,
            MemStack::new(&mut self.scratch),
            Default::default(),
        );
        let known = match outcome {
            Ok(_) => k,
            Err(LdltError::ZeroPivot { index }) => index + 1,
        };
        for s in 0..known {
            self.pivots[s] = self.matrix[(s, s)];
        }
        pivots::check(&self.pivots[..known], &self.sizes[..known])?;
        match outcome {
            Ok(_) => Ok(()),
            Err(LdltError::ZeroPivot { index }) => {
                Err(EvaluationFailure::Pivot { index, pivot: self.pivots[index] })
            }
        }
    }

    /// Replaces each of the columns v, of length k, by M⁻¹ v.
    pub(crate) fn solve(&mut self, columns: &mut [f64]) {
        let k = self.sizes.len();
        if let Some(factors) = &self.pivoted {
            let columns = MatMut::from_column_major_slice_mut(columns, k, columns.len() / k.max(1));
            factors.solve_in_place(columns);
            return;
        }
        let (l, d) = (self.matrix.as_ref(), self.matrix.as_ref().diagonal());
        let columns = MatMut::from_column_major_slice_mut(columns, k, columns.len() / k.max(1));
        solve::solve_in_place(l, d, columns, Par::Seq, MemStack::new(&mut []));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn factorised(entries: [f64; 6]) -> Result<DenseLdl, EvaluationFailure> {
        let mut ldl = DenseLdl::new(3);
        ldl.factorise(&Pattern::from_columns(3, [vec![0, 1, 2], vec![1, 2], vec![2]]), &entries).map(|()| ldl)
    }

    #[test]
    fn an_indefinite_matrix_is_factorised() {
        let mut ldl = factorised([2.0, 1.0, 0.0, -3.0, 1.0, 4.0]).unwrap();
        // M (1, 2, 3) = (4, −2, 14), M (0, 1, 0) = (1, −3, 1)
        let mut columns = [4.0, -2.0, 14.0, 1.0, -3.0, 1.0];
        ldl.solve(&mut columns);
        for (found, expected) in columns.iter().zip([1.0, 2.0, 3.0, 0.0, 1.0, 0.0]) {
            assert!((found - expected).abs() < 1e-15);
        }
    }

    /// The second leading minor of ((a², a, 1), (a, 1, 0), (1, 0, 1)) is 0, its determinant −1.
    #[test]
    fn a_vanishing_minor_is_not_a_singularity() {
        let a = 1.0 / 3.0f64;
        let mut ldl = factorised([a * a, a, 1.0, 1.0, 0.0, 1.0]).unwrap();
        let mut column = [a * a + 2.0 * a + 3.0, a + 2.0, 4.0];
        ldl.solve(&mut column);
        for (found, expected) in column.iter().zip([1.0, 2.0, 3.0]) {
            // 27 operations with numbers up to 4
            assert!((found - expected).abs() < 27.0 * 4.0 * f64::EPSILON, "{column:?}");
        }
        // A second factorisation without pivoting.
        ldl.factorise(
            &Pattern::from_columns(3, [vec![0, 1, 2], vec![1, 2], vec![2]]),
            &[2.0, 0.0, 0.0, 4.0, 0.0, 1.0],
        )
        .unwrap();
        let mut column = [2.0, 4.0, 1.0];
        ldl.solve(&mut column);
        assert_eq!(column, [1.0, 1.0, 1.0]);
    }

    #[test]
    fn units_do_not_matter() {
        // The mass of a satellite beside that of the Earth is not a rounding error.
        assert!(factorised([6e24, 0.0, 0.0, 1e3, 0.0, 1e-3]).is_ok());
        // sin² π beside 1
        assert!(matches!(
            factorised([1.0, 0.0, 0.0, 1.5e-32, 0.0, 1.0]),
            Err(EvaluationFailure::Pivot { index: 1, .. })
        ));
    }

    #[test]
    fn a_vanishing_pivot_is_found() {
        for (entries, vanishing) in
            [([1.0, 1.0, 0.0, 1.0, 0.0, 1.0], 1), ([0.0; 6], 0), ([3.0, 1.0, 0.0, 1.0 / 3.0, 0.0, 1.0], 1)]
        {
            assert!(
                matches!(factorised(entries), Err(EvaluationFailure::Pivot { index, .. }) if index == vanishing)
            );
        }
    }
}

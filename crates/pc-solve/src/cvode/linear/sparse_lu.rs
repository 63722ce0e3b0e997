//! LU factors of sparse matrices.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::sparse::linalg::lu::{LuRef, NumericLu, SymbolicLu, factorize_symbolic_lu};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par};
use pc_expr::Pattern;
use sundials_sys as sys;

use super::direct::{self, Factors, Singular};
use super::handles::{Matrix, Solver};
use super::sparse;
use crate::cvode::context::Context;
use crate::error::SolveError;

/// The solver for a `matrix` in compressed-column form with this pattern.
pub(super) fn solver(
    context: &mut Context,
    matrix: &Matrix,
    pattern: &Pattern,
) -> Result<Solver, SolveError> {
    let out_of_memory = |_| SolveError::Setup {
        function: "sparse LU",
        code: sys::CV_MEM_FAIL,
        message: format!("{} entries", pattern.len()),
    };
    direct::solver(context, matrix, SparseLu::new(pattern).map_err(out_of_memory)?)
}

/// P A Q = L U. The order Q of the columns, which keeps L and U sparse for every P, is found once,
/// from the pattern; the order P of the rows is found for each matrix, by choosing the largest
/// pivot in each column.
struct SparseLu {
    symbolic: SymbolicLu<usize>,
    numeric: NumericLu<usize, f64>,
    memory: MemBuffer,
}

impl SparseLu {
    fn new(pattern: &Pattern) -> Result<SparseLu, faer::sparse::FaerError> {
        let symbolic = factorize_symbolic_lu(columns(pattern), Default::default())?;
        let request = symbolic
            .factorize_numeric_lu_scratch::<f64>(Par::Seq, Default::default())
            .or(symbolic.solve_in_place_scratch::<f64>(1, Par::Seq));
        let memory = MemBuffer::try_new(request).map_err(|_| faer::sparse::FaerError::OutOfMemory)?;
        Ok(SparseLu { symbolic, numeric: NumericLu::new(), memory })
    }

    /// Factorises the matrix with the pattern of [`new`](SparseLu::new) and these entries.
    fn set(&mut self, pattern: &Pattern, values: &[f64]) -> Result<(), Singular> {
        let matrix = SparseColMatRef::new(columns(pattern), values);
        let stack = MemStack::new(&mut self.memory);
        self.symbolic
            .factorize_numeric_lu(&mut self.numeric, matrix, Par::Seq, stack, Default::default())
            .map(|_| ())
            .map_err(|_| Singular)
    }

    /// Replaces b by x with A x = b; some numbers are not finite if a pivot is 0.
    fn solve_in_place(&mut self, b: &mut [f64]) {
        let rows = b.len();
        LuRef::new_unchecked(&self.symbolic, &self.numeric).solve_in_place_with_conj(
            Conj::No,
            MatMut::from_column_major_slice_mut(b, rows, 1),
            Par::Seq,
            MemStack::new(&mut self.memory),
        );
    }
}

fn columns(pattern: &Pattern) -> SymbolicSparseColMatRef<'_, usize> {
    let (rows, columns) = (pattern.rows(), pattern.columns());
    SymbolicSparseColMatRef::new_checked(rows, columns, pattern.column_starts(), None, pattern.row_indices())
}

impl Factors for SparseLu {
    unsafe fn factorise(&mut self, matrix: sys::SUNMatrix) -> Result<(), Singular> {
        // SAFETY: the matrix the solver was made for is one of ours, and nobody else uses it during
        // the call.
        let matrix = unsafe { sparse::content(matrix) };
        self.set(matrix.pattern(), matrix.values())
    }

    unsafe fn solve(&mut self, _matrix: sys::SUNMatrix, b: &mut [f64]) -> Result<(), Singular> {
        self.solve_in_place(b);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use faer::Mat;
    use faer::prelude::Solve;
    use proptest::prelude::*;

    fn residual(pattern: &Pattern, values: &[f64], x: &[f64], b: &[f64]) -> f64 {
        let mut residual = b.to_vec();
        for ((i, j), value) in pattern.entries().zip(values) {
            residual[i] -= value * x[j];
        }
        residual.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()))
    }

    /// A pattern of n rows and columns with a full diagonal, and two sets of entries for it.
    fn matrices() -> impl Strategy<Value = (Pattern, Vec<f64>, Vec<f64>)> {
        (1_usize..40).prop_flat_map(|n| {
            let column = prop::collection::vec(0..n, 0..6);
            prop::collection::vec(column, n).prop_flat_map(move |columns| {
                let with_diagonal = columns.into_iter().enumerate().map(|(j, mut column)| {
                    column.push(j);
                    column
                });
                let pattern = Pattern::from_columns(n, with_diagonal);
                let values = || prop::collection::vec(-1.0..1.0_f64, pattern.len());
                let (first, second) = (values(), values());
                (Just(pattern), first, second)
            })
        })
    }

    proptest! {
        #![proptest_config(ProptestConfig {
            cases: 200,
            rng_seed: prop::test_runner::RngSeed::Fixed(11),
            ..ProptestConfig::default()
        })]

        /// The matrices are diagonally dominant, hence well conditioned: the errors amount to a few
        /// times the rounding errors of n operations.
        #[test]
        fn sparse_factors_are_the_dense_ones((pattern, first, second) in matrices()) {
            let n = pattern.rows();
            let mut factors = SparseLu::new(&pattern).unwrap();
            for mut values in [first, second] {
                // Each column has at most 7 entries of at most 1.
                for ((i, j), value) in pattern.entries().zip(&mut values) {
                    *value += if i == j { 8.0 } else { 0.0 };
                }
                let mut dense = vec![0.0; n * n];
                pattern.scatter(&values, &mut dense);
                let b: Vec<f64> = (0..n).map(|i| (i as f64).sin()).collect();
                let mut x = b.clone();
                factors.set(&pattern, &values).unwrap();
                factors.solve_in_place(&mut x);
                let expected = Mat::from_fn(n, n, |i, j| dense[i + j * n]).partial_piv_lu()
                    .solve(Mat::from_fn(n, 1, |i, _| b[i]));
                for i in 0..n {
                    prop_assert!((x[i] - expected[(i, 0)]).abs() < 1e-14);
                }
                prop_assert!(residual(&pattern, &values, &x, &b) < 1e-13);
            }
        }
    }

    #[test]
    fn rows_are_exchanged() {
        let pattern = Pattern::full(2, 2);
        let mut factors = SparseLu::new(&pattern).unwrap();
        factors.set(&pattern, &[1e-20, 1.0, 1.0, 1.0]).unwrap();
        let mut x = [1.0, 2.0];
        factors.solve_in_place(&mut x);
        assert_eq!(x, [1.0, 1.0]);
    }

    #[test]
    fn a_singular_matrix_is_refused() {
        let pattern = Pattern::from_columns(3, [vec![0, 1], vec![0, 1], vec![2]]);
        let mut factors = SparseLu::new(&pattern).unwrap();
        for values in [[1.0, 2.0, 2.0, 4.0, 1.0], [1.0, 0.0, 0.0, 1.0, 0.0], [0.0; 5]] {
            for b in [[1.0, 1.0, 1.0], [0.0, 0.0, 0.0], [1.0, 2.0, 0.0]] {
                let mut x = b;
                let factorised = factors.set(&pattern, &values).is_ok();
                if factorised {
                    factors.solve_in_place(&mut x);
                }
                assert!(!factorised || x.iter().any(|value| !value.is_finite()), "{values:?} {b:?}: {x:?}");
            }
        }
        // The next matrix is not affected.
        factors.set(&pattern, &[2.0, 0.0, 0.0, 2.0, 2.0]).unwrap();
        let mut x = [2.0, 4.0, 6.0];
        factors.solve_in_place(&mut x);
        assert_eq!(x, [1.0, 2.0, 3.0]);
    }
}

//! Numerical factors of a mass matrix.

use pc_expr::Pattern;
use serde::{Deserialize, Serialize};

use crate::compiled::elimination::dense_ldl::DenseLdl;
use crate::compiled::failure::EvaluationFailure;

/// The factors of a symmetric matrix, M = L D Lᵀ, with pivoting if elimination meets a vanishing minor of a
/// regular M.
///
/// ```
/// let mut factors = pc_mech::MassFactors::new(2);
/// factors.factorise(&[2.0, 1.0, 1.0, 1.0])?;
/// let mut right = [3.0, 2.0];
/// factors.solve(&mut right);
/// assert_eq!(right, [1.0, 1.0]);
/// # Ok::<(), pc_mech::SingularMatrix>(())
/// ```
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct MassFactors {
    factors: DenseLdl,
    lower: Pattern,
    /// The entries on and below the diagonal.
    values: Vec<f64>,
}

/// A matrix that is numerically singular.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("the matrix is singular: its pivot number {index} (from 0) is {pivot}")]
pub struct SingularMatrix {
    /// The row of the pivot that vanishes, or of the first entry that is not finite.
    pub index: usize,
    /// The pivot.
    pub pivot: f64,
}

impl MassFactors {
    /// Workspace for the factors of a k × k matrix.
    pub fn new(k: usize) -> MassFactors {
        let lower = Pattern::from_columns(k, (0..k).map(|j| j..k));
        MassFactors { factors: DenseLdl::new(k), values: vec![0.0; lower.len()], lower }
    }

    /// Factorises a matrix, given by all its entries.
    ///
    /// # Errors
    /// [`SingularMatrix`]
    ///
    /// # Panics
    /// If `matrix` does not consist of k² numbers.
    pub fn factorise(&mut self, matrix: &[f64]) -> Result<(), SingularMatrix> {
        let k = self.lower.rows();
        assert_eq!(matrix.len(), k * k, "a square matrix");
        for (value, (i, j)) in self.values.iter_mut().zip(self.lower.entries()) {
            *value = matrix[i * k + j];
            if !value.is_finite() {
                return Err(SingularMatrix { index: i, pivot: *value });
            }
        }
        self.factors.factorise(&self.lower, &self.values).map_err(|failure| match failure {
            EvaluationFailure::Pivot { index, pivot } => SingularMatrix { index, pivot },
            _ => SingularMatrix { index: 0, pivot: f64::NAN }, // factorisation fails in no other way
        })
    }

    /// Replaces each of the columns v by M⁻¹ v.
    pub fn solve(&mut self, columns: &mut [f64]) {
        self.factors.solve(columns);
    }
}

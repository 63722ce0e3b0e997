//! Singular values of small dense matrices of numbers.

use faer::Mat;
use pc_algebra::Matrix;

use crate::error::{MatrixError, MechError};

/// The decomposition A = U Σ Vᵀ, with U and V orthogonal and square.
#[derive(Clone, Debug)]
pub struct SingularValues {
    /// U, rows × rows.
    pub left: Matrix<f64>,
    /// The diagonal of Σ, in descending order, as many as there are rows or columns, whichever
    /// is fewer.
    pub values: Vec<f64>,
    /// V, columns × columns.
    pub right: Matrix<f64>,
}

impl SingularValues {
    /// The singular values of `matrix`.
    ///
    /// # Errors
    /// [`MatrixError::NoEigenvalues`] for a matrix with an entry that is not finite.
    pub fn of(matrix: &Matrix<f64>) -> Result<SingularValues, MechError> {
        let (rows, columns) = (matrix.rows(), matrix.columns());
        if rows == 0 || columns == 0 {
            return Ok(SingularValues { left: unit(rows), values: Vec::new(), right: unit(columns) });
        }
        let failure = || MechError::Matrix(MatrixError::NoEigenvalues { rows, columns });
        let factors = finite(matrix).ok_or_else(failure)?.svd().map_err(|_| failure())?;
        let values = factors.S().column_vector();
        Ok(SingularValues {
            left: Matrix::from_fn(rows, rows, |i, j| factors.U()[(i, j)]),
            values: (0..rows.min(columns)).map(|i| values[i]).collect(),
            right: Matrix::from_fn(columns, columns, |i, j| factors.V()[(i, j)]),
        })
    }

    /// The number of singular values above `tolerance`.
    pub fn rank(&self, tolerance: f64) -> usize {
        self.values.iter().filter(|&&value| value > tolerance).count()
    }

    /// Columns that span the kernel of the matrix, if it has this rank.
    pub fn kernel(&self, rank: usize) -> Matrix<f64> {
        let columns = self.right.rows();
        Matrix::from_fn(columns, columns - rank, |i, j| self.right[(i, rank + j)])
    }
}

fn unit(size: usize) -> Matrix<f64> {
    Matrix::from_fn(size, size, |i, j| f64::from(u8::from(i == j)))
}

/// The matrix, if all its entries are finite.
fn finite(matrix: &Matrix<f64>) -> Option<Mat<f64>> {
    let finite = matrix.entries().iter().all(|entry| entry.is_finite());
    finite.then(|| Mat::from_fn(matrix.rows(), matrix.columns(), |i, j| matrix[(i, j)]))
}

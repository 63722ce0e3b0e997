//! Small dense matrices of numbers: singular values and eigenvalues.

use faer::{Mat, Side};
use pc_algebra::Matrix;

use crate::error::MechError;

/// A = U Σ Vᵀ, with U and V orthogonal and square.
#[derive(Clone, Debug)]
pub(crate) struct SingularValues {
    /// U, rows × rows.
    pub(crate) left: Matrix<f64>,
    /// The diagonal of Σ, falling, as many as the lesser of rows and columns.
    pub(crate) values: Vec<f64>,
    /// V, columns × columns.
    pub(crate) right: Matrix<f64>,
}

impl SingularValues {
    /// Those of `matrix`.
    ///
    /// # Errors
    /// [`MechError::NoEigenvalues`] for a matrix with an entry that is not finite.
    pub(crate) fn of(matrix: &Matrix<f64>) -> Result<SingularValues, MechError> {
        let (rows, columns) = (matrix.rows(), matrix.columns());
        if rows == 0 || columns == 0 {
            return Ok(SingularValues { left: unit(rows), values: Vec::new(), right: unit(columns) });
        }
        let failure = || MechError::NoEigenvalues { rows, columns };
        let factors = finite(matrix).ok_or_else(failure)?.svd().map_err(|_| failure())?;
        let values = factors.S().column_vector();
        Ok(SingularValues {
            left: Matrix::from_fn(rows, rows, |i, j| factors.U()[(i, j)]),
            values: (0..rows.min(columns)).map(|i| values[i]).collect(),
            right: Matrix::from_fn(columns, columns, |i, j| factors.V()[(i, j)]),
        })
    }

    /// The number of singular values above `tolerance`.
    pub(crate) fn rank(&self, tolerance: f64) -> usize {
        self.values.iter().filter(|&&value| value > tolerance).count()
    }

    /// Columns that span the kernel of a matrix of that rank.
    pub(crate) fn kernel(&self, rank: usize) -> Matrix<f64> {
        let columns = self.right.rows();
        Matrix::from_fn(columns, columns - rank, |i, j| self.right[(i, rank + j)])
    }
}

/// The eigenvalues of a square matrix, as pairs of real and imaginary part.
///
/// # Errors
/// [`MechError::NoEigenvalues`] for a matrix with an entry that is not finite.
pub(crate) fn eigenvalues(matrix: &Matrix<f64>) -> Result<Vec<(f64, f64)>, MechError> {
    let size = matrix.rows();
    if size == 0 {
        return Ok(Vec::new());
    }
    let failure = || MechError::NoEigenvalues { rows: size, columns: size };
    let values = finite(matrix).ok_or_else(failure)?.eigenvalues().map_err(|_| failure())?;
    Ok(values.iter().map(|value| (value.re, value.im)).collect())
}

/// Eigenvalues of a symmetric matrix, rising, and orthonormal eigenvectors as columns.
///
/// # Errors
/// [`MechError::NoEigenvalues`] for a matrix with an entry that is not finite.
pub(crate) fn symmetric_eigenvalues(matrix: &Matrix<f64>) -> Result<(Vec<f64>, Matrix<f64>), MechError> {
    let size = matrix.rows();
    if size == 0 {
        return Ok((Vec::new(), unit(0)));
    }
    let failure = || MechError::NoEigenvalues { rows: size, columns: size };
    let factors =
        finite(matrix).ok_or_else(failure)?.self_adjoint_eigen(Side::Lower).map_err(|_| failure())?;
    let values = factors.S().column_vector();
    let vectors = Matrix::from_fn(size, size, |i, j| factors.U()[(i, j)]);
    Ok(((0..size).map(|i| values[i]).collect(), vectors))
}

/// A B
pub(crate) fn product(a: &Matrix<f64>, b: &Matrix<f64>) -> Matrix<f64> {
    Matrix::from_fn(a.rows(), b.columns(), |i, j| (0..a.columns()).map(|l| a[(i, l)] * b[(l, j)]).sum())
}

/// √Σ a_ij²
pub(crate) fn norm(entries: &[f64]) -> f64 {
    entries.iter().fold(0.0f64, |sum, &a| sum.hypot(a))
}

fn unit(size: usize) -> Matrix<f64> {
    Matrix::from_fn(size, size, |i, j| f64::from(u8::from(i == j)))
}

/// The matrix, if all its entries are finite.
fn finite(matrix: &Matrix<f64>) -> Option<Mat<f64>> {
    let finite = matrix.entries().iter().all(|entry| entry.is_finite());
    finite.then(|| Mat::from_fn(matrix.rows(), matrix.columns(), |i, j| matrix[(i, j)]))
}

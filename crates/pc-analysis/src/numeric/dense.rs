//! Small dense matrices of numbers: eigenvalues and norms.

use faer::{Mat, Side};
use pc_mech::{Matrix, MatrixError, MechError};

/// The eigenvalues of a square matrix, as pairs of real and imaginary part.
///
/// # Errors
/// [`MatrixError::NoEigenvalues`] for a matrix with an entry that is not finite.
pub(crate) fn eigenvalues(matrix: &Matrix<f64>) -> Result<Vec<(f64, f64)>, MechError> {
    let size = matrix.rows();
    if size == 0 {
        return Ok(Vec::new());
    }
    let failure = || MechError::Matrix(MatrixError::NoEigenvalues { rows: size, columns: size });
    let values = finite(matrix).ok_or_else(failure)?.eigenvalues().map_err(|_| failure())?;
    Ok(values.iter().map(|value| (value.re, value.im)).collect())
}

/// Eigenvalues of a symmetric matrix, rising, and orthonormal eigenvectors as columns.
///
/// # Errors
/// [`MatrixError::NoEigenvalues`] for a matrix with an entry that is not finite.
pub(crate) fn symmetric_eigenvalues(matrix: &Matrix<f64>) -> Result<(Vec<f64>, Matrix<f64>), MechError> {
    let size = matrix.rows();
    if size == 0 {
        return Ok((Vec::new(), unit(0)));
    }
    let failure = || MechError::Matrix(MatrixError::NoEigenvalues { rows: size, columns: size });
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

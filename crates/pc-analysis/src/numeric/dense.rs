//! Small dense matrices of numbers: eigenvalues and norms.

use faer::linalg::solvers::Solve;
use faer::{Mat, Side};
use pc_mech::{Matrix, MatrixError, MechError};

/// An eigenvalue, as a pair of real and imaginary parts, with the components of an eigenvector as such pairs.
pub(crate) type Eigenpair = ((f64, f64), Vec<(f64, f64)>);

/// The eigenvalues of a square matrix, each with an eigenvector.
///
/// # Errors
/// [`MatrixError::NoEigenvalues`] for a matrix with an entry that is not finite.
pub(crate) fn eigenvectors(matrix: &Matrix<f64>) -> Result<Vec<Eigenpair>, MechError> {
    let size = matrix.rows();
    if size == 0 {
        return Ok(Vec::new());
    }
    let failure = || MechError::Matrix(MatrixError::NoEigenvalues { rows: size, columns: size });
    let factors = finite(matrix).ok_or_else(failure)?.eigen().map_err(|_| failure())?;
    let (values, vectors) = (factors.S().column_vector(), factors.U());
    let pair = |z: faer::c64| (z.re, z.im);
    let column = |j: usize| (0..size).map(|i| pair(vectors[(i, j)])).collect();
    Ok((0..size).map(|j| (pair(values[j]), column(j))).collect())
}

/// A⁻¹ B of a regular A.
pub(crate) fn solve(a: &Matrix<f64>, b: &Matrix<f64>) -> Matrix<f64> {
    let copy = |m: &Matrix<f64>| Mat::from_fn(m.rows(), m.columns(), |i, j| m[(i, j)]);
    let solution = copy(a).partial_piv_lu().solve(copy(b));
    Matrix::from_fn(b.rows(), b.columns(), |i, j| solution[(i, j)])
}

/// The eigenvalues of a symmetric matrix in ascending order, and orthonormal eigenvectors as columns.
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

//! Small dense matrices, with pivoting.

use nalgebra::{DMatrix, DVector};

use crate::error::Irregular;
use crate::rounding::within;

/// Singular values below this part of the largest count as zero.
const RANK: f64 = 1e-9;

/// Pivots below this part of the largest make equations singular.
const PIVOT: f64 = 1e-13;

/// The matrix of these rows, of `columns` entries each.
pub(crate) fn matrix(rows: &[Vec<f64>], columns: usize) -> DMatrix<f64> {
    DMatrix::from_fn(rows.len(), columns, |i, j| rows[i][j])
}

/// The pseudo-inverse, with the rank.
pub(crate) fn pseudo_inverse(a: &DMatrix<f64>) -> Option<(DMatrix<f64>, usize)> {
    if a.is_empty() {
        return Some((DMatrix::zeros(a.ncols(), a.nrows()), 0));
    }
    if a.iter().any(|entry| !entry.is_finite()) {
        return None;
    }
    let svd = a.clone().svd(true, true);
    let threshold = RANK * svd.singular_values.max();
    let rank = svd.singular_values.iter().filter(|&&value| value > threshold).count();
    let inverse = svd.pseudo_inverse(threshold.max(f64::MIN_POSITIVE)).ok()?;
    // The decomposition may be wrong by some thousand roundings: a step of Schulz squares that, and leaves the rank.
    let product = a * &inverse;
    Some((&inverse * 2.0 - &inverse * product, rank))
}

/// The numbers of rows none of which is a combination of those before, by the method of Gram and Schmidt.
pub(crate) fn independent_rows(rows: &[Vec<f64>]) -> Vec<usize> {
    let mut basis: Vec<DVector<f64>> = Vec::new();
    let mut independent = Vec::new();
    for (i, row) in rows.iter().enumerate() {
        let row = DVector::from_column_slice(row);
        let length = row.norm();
        let mut rest = row / length;
        for _ in 0..2 {
            for known in &basis {
                rest -= known * known.dot(&rest);
            }
        }
        if length > 0.0 && rest.norm() > RANK {
            basis.push(rest.normalize());
            independent.push(i);
        }
    }
    independent
}

/// The solution of A z = r and the size of its terms, |A⁻¹| times the largest terms of A z and r in each equation.
pub(crate) struct Solution {
    pub(crate) values: Vec<f64>,
    pub(crate) sizes: Vec<f64>,
    /// A⁻¹
    pub(crate) inverse: DMatrix<f64>,
    /// ‖A‖‖A⁻¹‖ of the matrix with its rows and columns scaled.
    pub(crate) condition: f64,
}

/// Solves by elimination with complete pivoting, rows and columns being scaled by powers of two. `terms` has the largest
/// term of each right-hand side.
pub(crate) fn solve(a: &DMatrix<f64>, right: &[f64], terms: &[f64]) -> Result<Solution, Irregular> {
    let size = right.len();
    if a.iter().chain(right).any(|entry| !entry.is_finite()) {
        return Err(Irregular::NotFinite { what: "the mass matrix or the force" });
    }
    if size == 0 {
        let inverse = DMatrix::zeros(0, 0);
        return Ok(Solution { values: Vec::new(), sizes: Vec::new(), inverse, condition: 1.0 });
    }
    let (rows, columns) = scales(a);
    let scaled = DMatrix::from_fn(size, size, |i, j| rows[i] * a[(i, j)] * columns[j]);
    let lu = scaled.clone().full_piv_lu();
    let pivots = lu.u().diagonal().abs();
    if !within(PIVOT * pivots.max(), pivots.min()) {
        return Err(Irregular::Singular);
    }
    let inverse = lu.try_inverse().ok_or(Irregular::Singular)?;
    let condition = scaled.norm() * inverse.norm();
    let inverse = DMatrix::from_fn(size, size, |i, j| columns[i] * inverse[(i, j)] * rows[j]);
    let right = DVector::from_column_slice(right);
    let mut values = &inverse * &right;
    values += &inverse * (&right - a * &values);
    let largest = |i: usize| (0..size).map(|j| (a[(i, j)] * values[j]).abs()).fold(terms[i].abs(), f64::max);
    let largest: Vec<f64> = (0..size).map(largest).collect();
    let led = |i: usize| (0..size).map(|j| inverse[(i, j)].abs() * largest[j]).fold(0.0, f64::max);
    let sizes = (0..size).map(led).collect();
    Ok(Solution { values: values.iter().copied().collect(), sizes, inverse, condition })
}

/// Powers of two by which rows and columns are multiplied so that their largest entries are near 1.
fn scales(a: &DMatrix<f64>) -> (Vec<f64>, Vec<f64>) {
    let (mut rows, mut columns) = (vec![1.0; a.nrows()], vec![1.0; a.ncols()]);
    let power = |largest: f64| if largest > 0.0 { (-largest.log2() / 2.0).round().exp2() } else { 1.0 };
    for _ in 0..4 {
        let entry =
            |rows: &[f64], columns: &[f64], i: usize, j: usize| (rows[i] * a[(i, j)] * columns[j]).abs();
        let of_row = |i: usize| (0..a.ncols()).map(|j| entry(&rows, &columns, i, j)).fold(0.0, f64::max);
        let of_column = |j: usize| (0..a.nrows()).map(|i| entry(&rows, &columns, i, j)).fold(0.0, f64::max);
        let by_row: Vec<f64> = (0..a.nrows()).map(|i| power(of_row(i))).collect();
        let by_column: Vec<f64> = (0..a.ncols()).map(|j| power(of_column(j))).collect();
        rows.iter_mut().zip(by_row).for_each(|(scale, factor)| *scale *= factor);
        columns.iter_mut().zip(by_column).for_each(|(scale, factor)| *scale *= factor);
    }
    (rows, columns)
}

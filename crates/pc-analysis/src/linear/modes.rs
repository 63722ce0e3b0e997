//! Eigenvectors.

use pc_mech::{Matrix, SingularValues};

use crate::error::AnalysisError;
use crate::numeric::dense::eigenvectors;
use crate::stability::spectrum::{Eigenvalue, Spectrum};

/// A motion near the state, δy = Re(c v e^λt).
#[derive(Clone, Debug, PartialEq)]
pub struct Mode {
    /// λ
    pub eigenvalue: Eigenvalue,
    /// v, as a pair of real and imaginary parts for each component; the largest component is 1. None for a
    /// multiple zero eigenvalue beyond the dimension of the kernel: there deviations grow with a power of t.
    pub vector: Option<Vec<(f64, f64)>>,
}

/// An eigenvector for each eigenvalue of the spectrum of a matrix, in its order.
pub(super) fn modes(matrix: &Matrix<f64>, spectrum: &Spectrum) -> Result<Vec<Mode>, AnalysisError> {
    let mut known = eigenvectors(matrix)?;
    let zeros = spectrum.zero_blocks().first().copied().unwrap_or(0);
    let mut kernel = kernel(matrix, zeros)?.into_iter();
    let is_zero = |value: &Eigenvalue| zeros > 0 && value.real == 0.0 && value.imaginary == 0.0;
    // Zero eigenvalues are computed as small numbers: those farthest from all nonzero ones are left over for
    // them.
    let mut taken = Vec::new();
    for value in spectrum.eigenvalues().iter().filter(|value| !is_zero(value)) {
        let distance =
            |((re, im), _): &((f64, f64), Vec<(f64, f64)>)| (re - value.real).hypot(im - value.imaginary);
        let nearest = (0..known.len()).min_by(|&i, &j| distance(&known[i]).total_cmp(&distance(&known[j])));
        taken.push(nearest.map(|i| normalised(known.remove(i).1)));
    }
    let mut taken = taken.into_iter();
    let vector = |value: &Eigenvalue| match is_zero(value) {
        true => kernel.next().map(|v| v.into_iter().map(|x| (x, 0.0)).collect()),
        false => taken.next().flatten(),
    };
    let vectors: Vec<_> = spectrum.eigenvalues().iter().map(vector).collect();
    Ok(spectrum
        .eigenvalues()
        .iter()
        .zip(vectors)
        .map(|(&eigenvalue, vector)| Mode { eigenvalue, vector })
        .collect())
}

/// Vectors that span the kernel, of the given dimension, in echelon form, so that they do not depend on the
/// choice of a basis.
fn kernel(matrix: &Matrix<f64>, dimension: usize) -> Result<Vec<Vec<f64>>, AnalysisError> {
    let n = matrix.rows();
    let basis = SingularValues::of(matrix)?.kernel(n - dimension);
    let mut rows = basis.transpose().to_rows();
    let mut pivots = Vec::new();
    for r in 0..rows.len() {
        let free = |j: &usize| !pivots.contains(j);
        let largest =
            rows[r..].iter().flat_map(|row| (0..n).filter(free).map(|j| row[j].abs())).fold(0.0, f64::max);
        let is_pivot = |i: usize, j: usize| rows[i][j].abs() >= 0.5 * largest;
        let place = (0..n).filter(free).find_map(|j| Some(((r..rows.len()).find(|&i| is_pivot(i, j))?, j)));
        let Some((i, j)) = place else { break };
        rows.swap(r, i);
        let pivot = rows[r][j];
        rows[r].iter_mut().for_each(|x| *x /= pivot);
        let own = rows[r].clone();
        for (_, row) in rows.iter_mut().enumerate().filter(|&(i, _)| i != r) {
            let factor = row[j];
            row.iter_mut().zip(&own).for_each(|(x, own)| *x -= factor * own);
        }
        pivots.push(j);
    }
    Ok(rows
        .into_iter()
        .map(|row| normalised(row.into_iter().map(|x| (x, 0.0)).collect()))
        .map(real)
        .collect())
}

fn real(vector: Vec<(f64, f64)>) -> Vec<f64> {
    vector.into_iter().map(|(re, _)| re).collect()
}

/// Components this small, in a vector of length about 1, are treated as rounding errors.
const ROUNDING: f64 = 1e-13;

/// The vector scaled so that its largest component, or the first of several such, is 1.
fn normalised(vector: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    let sizes: Vec<f64> = vector.iter().map(|&(re, im)| re.hypot(im)).collect();
    let largest = sizes.iter().fold(0.0f64, |largest, &size| largest.max(size));
    let Some(first) = sizes.iter().position(|&size| size >= largest * (1.0 - 1e-9) && size > 0.0) else {
        return vector;
    };
    let ((a, b), size) = (vector[first], sizes[first]);
    let clean = |x: f64| if x.abs() <= ROUNDING { 0.0 } else { x };
    let by = |(re, im): (f64, f64)| {
        (clean((re * a + im * b) / size / size), clean((im * a - re * b) / size / size))
    };
    vector.into_iter().map(by).collect()
}

//! Independent coordinates of the states that a motion can reach.

use pc_mech::{Matrix, SingularValues};

use crate::error::AnalysisError;
use crate::numeric::dense::{norm, product};

/// Singular values, and rows of an orthonormal basis, below this fraction of the largest count as zero.
/// Entries of frames and slopes of constraints are accurate to within ten to a hundred rounding errors.
pub(super) const ZERO: f64 = 1e-10;

/// The directions δx in which coordinates can move: the image of b, tangent to the leaf of an integrable
/// frame (Frobenius), within the kernel of the slopes of position constraints.
#[derive(Clone, Debug)]
pub(super) struct Directions {
    /// An orthonormal basis, stored as columns, n × d.
    basis: Matrix<f64>,
}

/// Some coordinates in terms of independent ones among them, δx = T δξ.
#[derive(Clone, Debug)]
pub(super) struct Chart {
    /// The indices of the independent ones, ascending.
    pub(super) independent: Vec<usize>,
    /// T, with a row for each of the coordinates.
    pub(super) of_independent: Matrix<f64>,
}

impl Directions {
    /// The directions for the frame b, n × k, and the slopes of the position constraints, m × n.
    pub(super) fn new(b: &Matrix<f64>, slopes: &Matrix<f64>) -> Result<Directions, AnalysisError> {
        let n = b.rows();
        let frame = SingularValues::of(b)?;
        let rank = frame.rank(ZERO * frame.values.first().copied().unwrap_or(0.0));
        // Slopes are scaled to length one.
        let sizes: Vec<f64> = (0..slopes.rows()).map(|a| norm(&slopes.row(a))).collect();
        let across = |i: usize, j: usize| match i.checked_sub(n - rank) {
            None => frame.left[(j, rank + i)],
            Some(a) if sizes[a] > 0.0 => slopes[(a, j)] / sizes[a],
            Some(_) => 0.0,
        };
        let normals = Matrix::from_fn(n - rank + slopes.rows(), n, across);
        let factors = SingularValues::of(&normals)?;
        Ok(Directions { basis: factors.kernel(factors.rank(ZERO)) })
    }

    /// Independent coordinates among the given ones: those that move most freely; ties go to the first.
    pub(super) fn chart(&self, coordinates: &[usize]) -> Result<Chart, AnalysisError> {
        let d = self.basis.columns();
        let all = Matrix::from_fn(coordinates.len(), d, |i, j| self.basis[(coordinates[i], j)]);
        let picked = independent_rows(&all, ZERO);
        let rows = Matrix::from_fn(picked.len(), d, |i, j| all[(picked[i], j)]);
        let inverse = pseudo_inverse(&rows)?;
        let through = product(&all, &inverse);
        let entry = |i: usize, j: usize| match picked.iter().position(|&known| known == i) {
            Some(own) => f64::from(u8::from(own == j)),
            None if through[(i, j)].abs() <= ROUNDING => 0.0,
            None => through[(i, j)],
        };
        Ok(Chart {
            of_independent: Matrix::from_fn(coordinates.len(), picked.len(), entry),
            independent: picked.into_iter().map(|i| coordinates[i]).collect(),
        })
    }
}

/// Quasi-velocities under conditions g(x, η) = 0 in terms of independent ones among them, δη = T δζ + S δx.
#[derive(Clone, Debug)]
pub(super) struct Velocities {
    /// The indices of the independent ones, ascending.
    pub(super) independent: Vec<usize>,
    /// T, k × l.
    pub(super) of_independent: Matrix<f64>,
    /// S, k × n, zero in the rows of the independent ones.
    pub(super) of_coordinates: Matrix<f64>,
}

impl Velocities {
    /// The velocities for conditions with these slopes with respect to n coordinates and k quasi-velocities.
    pub(super) fn new(slopes: &Matrix<f64>, n: usize, k: usize) -> Result<Velocities, AnalysisError> {
        let by_velocities = Matrix::from_fn(slopes.rows(), k, |a, s| slopes[(a, n + s)]);
        let by_coordinates = Matrix::from_fn(slopes.rows(), n, |a, i| -slopes[(a, i)]);
        let unit = Matrix::from_fn(k, k, |i, j| f64::from(u8::from(i == j)));
        let all: Vec<usize> = (0..k).collect();
        let Chart { independent, of_independent } = Directions::new(&unit, &by_velocities)?.chart(&all)?;
        let some = product(&pseudo_inverse(&by_velocities)?, &by_coordinates);
        let own = Matrix::from_fn(independent.len(), n, |i, j| some[(independent[i], j)]);
        let back = product(&of_independent, &own);
        let of_coordinates = Matrix::from_fn(k, n, |i, j| some[(i, j)] - back[(i, j)]);
        Ok(Velocities { independent, of_independent, of_coordinates })
    }
}

/// The remainder that some rounding errors in products of numbers up to 1 leave in place of a zero.
const ROUNDING: f64 = 1e-14;

/// The indices of rows that form a basis of all rows, ascending: each step takes the row with the greatest
/// remainder orthogonal to those already taken (ties go to the first), as long as this remainder exceeds
/// `zero`.
pub(super) fn independent_rows(matrix: &Matrix<f64>, zero: f64) -> Vec<usize> {
    let mut left: Vec<Vec<f64>> = matrix.to_rows();
    let mut picked = Vec::new();
    while picked.len() < matrix.columns() {
        let sizes: Vec<f64> = left.iter().map(|row| norm(row)).collect();
        let largest = sizes.iter().fold(0.0f64, |largest, &size| largest.max(size));
        // Equality up to rounding counts.
        let Some(next) = sizes.iter().position(|&size| size >= largest * (1.0 - ZERO)) else { break };
        if largest <= zero {
            break;
        }
        let direction: Vec<f64> = left[next].iter().map(|x| x / sizes[next]).collect();
        for row in &mut left {
            let along: f64 = row.iter().zip(&direction).map(|(a, b)| a * b).sum();
            row.iter_mut().zip(&direction).for_each(|(x, d)| *x -= along * d);
        }
        left[next].fill(0.0);
        picked.push(next);
    }
    picked.sort_unstable();
    picked
}

/// The pseudo-inverse of E. H. Moore and R. Penrose.
fn pseudo_inverse(matrix: &Matrix<f64>) -> Result<Matrix<f64>, AnalysisError> {
    let factors = SingularValues::of(matrix)?;
    let rank = factors.rank(ZERO * factors.values.first().copied().unwrap_or(0.0));
    let inverse = |i: usize, j: usize| -> f64 {
        let terms = factors.values[..rank].iter().enumerate();
        terms.map(|(l, sigma)| factors.right[(i, l)] * factors.left[(j, l)] / sigma).sum()
    };
    Ok(Matrix::from_fn(matrix.columns(), matrix.rows(), inverse))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_follow_from_independent_ones() {
        // A plane x + 2 y = 0 in space: z moves most freely, then x, and y = −x/2.
        let b = Matrix::from_fn(3, 3, |i, j| f64::from(u8::from(i == j)));
        let slopes = Matrix::from_fn(1, 3, |_, j| [1.0, 2.0, 0.0][j]);
        let chart = Directions::new(&b, &slopes).and_then(|all| all.chart(&[0, 1, 2]));
        let chart = chart.unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(chart.independent, [0, 2]);
        assert!((chart.of_independent[(1, 0)] + 0.5).abs() < ROUNDING);
        assert_eq!(chart.of_independent[(1, 1)], 0.0);
    }
}

//! Independent coordinates of the states that a motion can reach.

use pc_mech::{Matrix, SingularValues};

use crate::error::AnalysisError;
use crate::numeric::dense::{norm, product};
use crate::numeric::equilibrated::Equilibrated;

/// Singular values, and rows of an orthonormal basis, below this fraction of the largest count as zero.
/// Entries of frames and slopes of constraints are accurate to within ten to a hundred rounding errors.
pub(super) const ZERO: f64 = 1e-10;

/// The directions δx in which coordinates can move: the image of b, tangent to the leaf of an integrable
/// frame (Frobenius), within the kernel of the slopes of position constraints.
///
/// They are computed in coordinates whose units make the entries of b and of the slopes about one, so that no digits are
/// lost where the units of the model differ by many orders.
#[derive(Clone, Debug)]
pub(super) struct Directions {
    /// An orthonormal basis in the scaled coordinates, stored as columns, n × d.
    basis: Matrix<f64>,
    /// The units of the scaled coordinates.
    units: Vec<f64>,
}

/// Some coordinates in terms of independent ones among them, δx = T δξ.
#[derive(Clone, Debug)]
pub(super) struct Chart {
    /// The indices of the independent ones, ascending.
    pub(super) independent: Vec<usize>,
    /// T, with a row for each of the coordinates.
    pub(super) of_independent: Matrix<f64>,
}

/// The least singular value of the scaled directions of independent coordinates that are chosen by the directions in the
/// units of the model.
const WELL: f64 = 1e-3;

impl Directions {
    /// The directions for the frame b, n × k, and the slopes of the position constraints, m × n, each with a matrix of
    /// typical sizes.
    pub(super) fn new(
        (b, typical): (&Matrix<f64>, &Matrix<f64>),
        (slopes, typical_slopes): (&Matrix<f64>, &Matrix<f64>),
    ) -> Result<Directions, AnalysisError> {
        let n = b.rows();
        let scaled = Equilibrated::by(b, typical);
        let frame = SingularValues::of(&scaled.matrix)?;
        let rank = frame.rank(ZERO * frame.values.first().copied().unwrap_or(0.0));
        let normal = |i: usize, j: usize| {
            let entry = frame.left[(j, rank + i)];
            // What rounding leaves of a zero is no unit.
            if entry.abs() <= ROUNDING { 0.0 } else { entry * scaled.rows[j] }
        };
        let across = |i: usize, j: usize| match i.checked_sub(n - rank) {
            None => normal(i, j),
            Some(a) => slopes[(a, j)],
        };
        let normals = Matrix::from_fn(n - rank + slopes.rows(), n, across);
        let typical = Matrix::from_fn(normals.rows(), n, |i, j| match i.checked_sub(n - rank) {
            None => normals[(i, j)],
            Some(a) => typical_slopes[(a, j)],
        });
        Directions::across(&normals, &typical)
    }

    /// The directions orthogonal to these rows, which have these typical sizes.
    fn across(normals: &Matrix<f64>, typical: &Matrix<f64>) -> Result<Directions, AnalysisError> {
        let Equilibrated { matrix, columns: units, .. } = Equilibrated::by(normals, typical);
        let factors = SingularValues::of(&matrix)?;
        let largest = factors.values.first().copied().unwrap_or(0.0);
        Ok(Directions { basis: factors.kernel(factors.rank(ZERO * largest)), units })
    }

    /// Independent coordinates among the given ones: those that move most freely; ties go to the first.
    pub(super) fn chart(&self, coordinates: &[usize]) -> Result<Chart, AnalysisError> {
        let d = self.basis.columns();
        let scaled = Matrix::from_fn(coordinates.len(), d, |i, j| self.basis[(coordinates[i], j)]);
        let unit = |i: usize| self.units[coordinates[i]];
        let in_units = Matrix::from_fn(coordinates.len(), d, |i, j| unit(i) * scaled[(i, j)]);
        // What moves freely in the units of the model is a good coordinate, unless these units hide directions.
        let wanted = independent_rows(&scaled, ZERO);
        let largest = (0..in_units.rows()).map(|i| norm(&in_units.row(i))).fold(0.0, f64::max);
        let mut picked = independent_rows(&in_units, ZERO * largest);
        if picked.len() != wanted.len() || self.least_singular(&scaled, &picked)? < WELL {
            picked = wanted;
        }
        self.chart_of(coordinates, picked)
    }

    /// The chart of the independent coordinates with these places among the given ones.
    fn chart_of(&self, coordinates: &[usize], picked: Vec<usize>) -> Result<Chart, AnalysisError> {
        let d = self.basis.columns();
        let scaled = Matrix::from_fn(coordinates.len(), d, |i, j| self.basis[(coordinates[i], j)]);
        let rows = Matrix::from_fn(picked.len(), d, |i, j| scaled[(picked[i], j)]);
        let through = product(&scaled, &pseudo_inverse(&rows)?);
        let unit = |i: usize| self.units[coordinates[i]];
        let entry = |i: usize, j: usize| match picked.iter().position(|&known| known == i) {
            Some(own) => f64::from(u8::from(own == j)),
            None if through[(i, j)].abs() <= ROUNDING => 0.0,
            None => through[(i, j)] * unit(i) / unit(picked[j]),
        };
        Ok(Chart {
            of_independent: Matrix::from_fn(coordinates.len(), picked.len(), entry),
            independent: picked.into_iter().map(|i| coordinates[i]).collect(),
        })
    }

    /// The least singular value of these rows of the scaled directions.
    fn least_singular(&self, scaled: &Matrix<f64>, rows: &[usize]) -> Result<f64, AnalysisError> {
        let some = Matrix::from_fn(rows.len(), scaled.columns(), |i, j| scaled[(rows[i], j)]);
        Ok(SingularValues::of(&some)?.values.last().copied().unwrap_or(1.0))
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
    /// The velocities for conditions with these slopes with respect to n coordinates and k quasi-velocities, and
    /// typical sizes of these; the `dependent` ones are dependent if the others determine them well.
    pub(super) fn new(
        (slopes, typical): (&Matrix<f64>, &Matrix<f64>),
        n: usize,
        k: usize,
        dependent: &[usize],
    ) -> Result<Velocities, AnalysisError> {
        let of_velocities =
            |slopes: &Matrix<f64>| Matrix::from_fn(slopes.rows(), k, |a, s| slopes[(a, n + s)]);
        let by_velocities = of_velocities(slopes);
        let all: Vec<usize> = (0..k).collect();
        let directions = Directions::across(&by_velocities, &of_velocities(typical))?;
        let preferred: Vec<usize> = all.iter().copied().filter(|s| !dependent.contains(s)).collect();
        let is_preferred = !dependent.is_empty()
            && preferred.len() == directions.basis.columns()
            && directions.least_singular(&directions.basis, &preferred)? >= WELL;
        let chart =
            if is_preferred { directions.chart_of(&all, preferred)? } else { directions.chart(&all)? };
        let Chart { independent, of_independent } = chart;
        let others: Vec<usize> = all.into_iter().filter(|s| !independent.contains(s)).collect();
        let of_others = Matrix::from_fn(slopes.rows(), others.len(), |a, j| by_velocities[(a, others[j])]);
        let by_coordinates = Matrix::from_fn(slopes.rows(), n, |a, i| -slopes[(a, i)]);
        let solved = product(&pseudo_inverse(&of_others)?, &by_coordinates);
        let of_coordinates =
            |s: usize, i: usize| others.iter().position(|&other| other == s).map_or(0.0, |j| solved[(j, i)]);
        Ok(Velocities { independent, of_independent, of_coordinates: Matrix::from_fn(k, n, of_coordinates) })
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

/// The pseudo-inverse of E. H. Moore and R. Penrose, in units that make the entries about one.
fn pseudo_inverse(matrix: &Matrix<f64>) -> Result<Matrix<f64>, AnalysisError> {
    let Equilibrated { matrix, rows, columns } = Equilibrated::of(matrix);
    let factors = SingularValues::of(&matrix)?;
    let rank = factors.rank(ZERO * factors.values.first().copied().unwrap_or(0.0));
    let inverse = |i: usize, j: usize| -> f64 {
        let terms = factors.values[..rank].iter().enumerate();
        let sum: f64 = terms.map(|(l, sigma)| factors.right[(i, l)] * factors.left[(j, l)] / sigma).sum();
        sum * columns[i] * rows[j]
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
        let chart = Directions::new((&b, &b), (&slopes, &slopes)).and_then(|all| all.chart(&[0, 1, 2]));
        let chart = chart.unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(chart.independent, [0, 2]);
        assert!((chart.of_independent[(1, 0)] + 0.5).abs() < ROUNDING);
        assert_eq!(chart.of_independent[(1, 1)], 0.0);
    }
    #[test]
    fn units_lose_no_digits() {
        // y = 3e16 x: lengths in units that differ by sixteen orders.
        let slopes = Matrix::from_fn(1, 2, |_, j| [-3e16, 1.0][j]);
        let chart = Directions::across(&slopes, &slopes).and_then(|all| all.chart(&[0, 1]));
        let chart = chart.unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(chart.independent, [1]);
        assert!((chart.of_independent[(0, 0)] * 3e16 - 1.0).abs() < ROUNDING, "{chart:?}");
    }
}

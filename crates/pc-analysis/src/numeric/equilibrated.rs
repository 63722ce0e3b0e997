//! Matrices whose rows and columns have entries of size one, whatever the units of the quantities they relate.

use pc_mech::Matrix;

/// The number of passes in which rows and columns are scaled.
const PASSES: usize = 12;

/// Entries below this are zero: their inverses, and products of these, would overflow.
const UNDERFLOW: f64 = 1e-150;

/// The number of turns in which logarithms are balanced: each halves the rest at least, for matrices with few zeros.
const TURNS: usize = 60;

/// D A E with positive diagonal D and E, chosen so that the largest entry of each row and of each column is about one (D.
/// Ruiz, RAL-TR-2001-034). The ranks and singular values of D A E do not depend on the units of rows and columns of A.
#[derive(Clone, Debug)]
pub(crate) struct Equilibrated {
    /// D A E.
    pub(crate) matrix: Matrix<f64>,
    /// The diagonal of D.
    pub(crate) rows: Vec<f64>,
    /// The diagonal of E.
    pub(crate) columns: Vec<f64>,
}

impl Equilibrated {
    pub(crate) fn of(matrix: &Matrix<f64>) -> Equilibrated {
        Equilibrated::by(matrix, matrix)
    }

    /// The matrix with the scales of a `typical` one, whose entries have the sizes that those of the matrix have at most
    /// states: an entry that vanishes at one state up to rounding is not taken for a small unit.
    pub(crate) fn by(matrix: &Matrix<f64>, typical: &Matrix<f64>) -> Equilibrated {
        Equilibrated::scales(typical).of_matrix(matrix)
    }

    /// As [`by`](Equilibrated::by), where first the entries that are not zero are brought near one on the average of their
    /// logarithms (A. R. Curtis, J. K. Reid, J. Inst. Math. Appl. 10, 1972, 118–124). The largest entries of rows and
    /// columns leave open how much smaller others are: stiffnesses beside the slopes of constraints, say.
    pub(crate) fn by_all_entries(matrix: &Matrix<f64>, typical: &Matrix<f64>) -> Equilibrated {
        let first = Equilibrated::logarithmic(typical);
        let then = Equilibrated::scales(&first.matrix);
        let product = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).collect();
        let (rows, columns) = (product(&first.rows, &then.rows), product(&first.columns, &then.columns));
        Equilibrated { rows, columns, ..then }.of_matrix(matrix)
    }

    /// The same scales for another matrix.
    fn of_matrix(self, matrix: &Matrix<f64>) -> Equilibrated {
        let entry = |i: usize, j: usize| matrix[(i, j)] * self.rows[i] * self.columns[j];
        Equilibrated { matrix: Matrix::from_fn(matrix.rows(), matrix.columns(), entry), ..self }
    }

    /// The sum of (log₂ |a_ij| + log₂ d_i + log₂ e_j)² over entries other than zero is made small, by turns for the rows and
    /// for the columns.
    fn logarithmic(matrix: &Matrix<f64>) -> Equilibrated {
        let (m, n) = (matrix.rows(), matrix.columns());
        let size = matrix.map(|entry| without_underflow(entry).log2());
        let (mut rows, mut columns) = (vec![0.0; m], vec![0.0; n]);
        for _ in 0..TURNS {
            rows = (0..m).map(|i| -mean((0..n).map(|j| size[(i, j)] + columns[j]))).collect();
            columns = (0..n).map(|j| -mean((0..m).map(|i| size[(i, j)] + rows[i]))).collect();
        }
        let powers = |all: Vec<f64>| all.into_iter().map(|power: f64| power.round().exp2()).collect();
        let scales = Equilibrated { matrix: matrix.clone(), rows: powers(rows), columns: powers(columns) };
        scales.of_matrix(matrix)
    }

    fn scales(matrix: &Matrix<f64>) -> Equilibrated {
        let mut all = Equilibrated {
            matrix: matrix.clone(),
            rows: vec![1.0; matrix.rows()],
            columns: vec![1.0; matrix.columns()],
        };
        for _ in 0..PASSES {
            let (m, n) = (matrix.rows(), matrix.columns());
            let entry = |i: usize, j: usize| without_underflow(all.matrix[(i, j)]);
            let rows: Vec<f64> = (0..m).map(|i| factor((0..n).map(|j| entry(i, j)))).collect();
            let columns: Vec<f64> = (0..n).map(|j| factor((0..m).map(|i| entry(i, j)))).collect();
            if rows.iter().chain(&columns).all(|&factor| factor == 1.0) {
                break;
            }
            all.matrix = Matrix::from_fn(m, n, |i, j| all.matrix[(i, j)] * rows[i] * columns[j]);
            all.rows.iter_mut().zip(&rows).for_each(|(all, factor)| *all *= factor);
            all.columns.iter_mut().zip(&columns).for_each(|(all, factor)| *all *= factor);
        }
        all
    }
}

/// The size of an entry; of one that products on their way to underflow have left, zero: no scale makes it about one.
fn without_underflow(entry: f64) -> f64 {
    let size = entry.abs();
    if size < UNDERFLOW { 0.0 } else { size }
}

/// The mean of the numbers that are finite, zero if there are none.
fn mean(numbers: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) =
        numbers.filter(|x| x.is_finite()).fold((0.0, 0.0), |(sum, count), x| (sum + x, count + 1.0));
    if count > 0.0 { sum / count } else { 0.0 }
}

/// About one over the square root of the largest entry: a power of two, so that scaling does not round.
fn factor(entries: impl Iterator<Item = f64>) -> f64 {
    let largest = entries.fold(0.0f64, f64::max);
    if largest > 0.0 && largest.is_finite() { (-largest.log2() / 2.0).round().exp2() } else { 1.0 }
}

/// The larger of the sizes of each entry of two matrices.
pub(crate) fn larger(a: &Matrix<f64>, b: &Matrix<f64>) -> Matrix<f64> {
    Matrix::from_fn(a.rows(), a.columns(), |i, j| a[(i, j)].abs().max(b[(i, j)].abs()))
}

/// A point away from another by about this fraction of the unit and |z| together in each component, in no special direction.
pub(crate) fn aside(point: &[f64], units: &[f64], fraction: f64) -> Vec<f64> {
    let weight = |i: usize| 1.0 + 0.5 * (1.7 * i as f64 + 0.4).sin();
    let step = |(i, (z, unit)): (usize, (&f64, &f64))| z + fraction * (unit + z.abs()) * weight(i);
    point.iter().zip(units).enumerate().map(step).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn units_do_not_matter() {
        // Two springs, the second of which has its force in other units and its displacement in others still.
        let plain = Matrix::from_fn(2, 2, |i, j| if i == j { 2.0 } else { -1.0 });
        let units = Matrix::from_fn(2, 2, |i, j| plain[(i, j)] * [1.0, 1e9][i] * [1e-7, 1e4][j]);
        for matrix in [plain, units] {
            let scaled = Equilibrated::of(&matrix);
            let sizes = scaled.matrix.map(f64::abs);
            assert!(sizes.entries().iter().all(|entry| (0.25..=4.0).contains(entry)), "{sizes:?}");
            let back = |i: usize, j: usize| scaled.matrix[(i, j)] / scaled.rows[i] / scaled.columns[j];
            assert_eq!(Matrix::from_fn(2, 2, back), matrix, "powers of two are exact");
        }
    }

    /// A mass on a weak spring, held in place by a constraint in large units.
    #[test]
    fn stiffness_counts_beside_a_constraint() {
        let matrix = Matrix::from_fn(3, 3, |i, j| {
            [[1e-10, 6e-17, -5e6], [6e-17, 2e-20, 40.0], [5e6, -40.0, 0.0]][i][j]
        });
        let conditions = [Equilibrated::by(&matrix, &matrix), Equilibrated::by_all_entries(&matrix, &matrix)]
            .map(|scaled| pc_mech::SingularValues::of(&scaled.matrix).unwrap().values)
            .map(|values| values[2] / values[0]);
        assert!(conditions[0] < 1e-15 && conditions[1] > 1e-2, "{conditions:?}");
    }

    #[test]
    fn rounding_is_no_unit() {
        // z = r(φ) where r is stationary: δz = 0, up to rounding.
        let here = Matrix::from_fn(1, 2, |_, j| [1.0, 3e-17][j]);
        let typical = Matrix::from_fn(1, 2, |_, j| [1.0, 0.03][j]);
        let scaled = Equilibrated::by(&here, &typical);
        assert!(scaled.matrix[(0, 1)].abs() < 1e-14, "{scaled:?}");
    }
}

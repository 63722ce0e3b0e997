//! Dense matrices with pivoting, block by block: n uncoupled coordinates need only n small matrices. The size
//! of an equation and the units of an unknown do not affect the rank, because rows and columns are scaled
//! first.

use nalgebra::{DMatrix, DVector};

use crate::error::Irregular;
use crate::numbers::rounding::within;

/// Singular values below this fraction of the largest count as zero.
const RANK: f64 = 1e-9;

/// A rank is not in doubt if the threshold for zero is below this fraction of every singular value: the
/// relative rounding error of a decomposition is some thousand units in the last place times the condition
/// number.
const CERTAIN: f64 = 0.1;

/// Entries below this fraction of the largest entry of their row may consist of some hundred rounding errors
/// of that entry.
const NOISE: f64 = 1e-13;

/// Pivots below this fraction of the largest show that equations are singular.
const PIVOT: f64 = 1e-13;

/// The matrix with these rows, which have `columns` entries each.
pub(crate) fn matrix(rows: &[Vec<f64>], columns: usize) -> DMatrix<f64> {
    DMatrix::from_fn(rows.len(), columns, |i, j| rows[i][j])
}

/// A block of a matrix: the rows and columns, ascending, that are connected by nonzero entries.
struct Block {
    rows: Vec<usize>,
    columns: Vec<usize>,
}

impl Block {
    fn of(&self, a: &DMatrix<f64>) -> DMatrix<f64> {
        DMatrix::from_fn(self.rows.len(), self.columns.len(), |i, j| a[(self.rows[i], self.columns[j])])
    }
}

/// The blocks of a matrix. Each zero row or column is a block of its own.
fn blocks(a: &DMatrix<f64>) -> Vec<Block> {
    let (m, n) = a.shape();
    // Each points towards the first of its block; columns follow the rows.
    let mut first: Vec<usize> = (0..m + n).collect();
    let find = |first: &mut Vec<usize>, mut i: usize| {
        while first[i] != i {
            first[i] = first[first[i]];
            i = first[i];
        }
        i
    };
    for j in 0..n {
        for i in (0..m).filter(|&i| a[(i, j)] != 0.0) {
            let (one, other) = (find(&mut first, i), find(&mut first, m + j));
            first[one.max(other)] = one.min(other);
        }
    }
    let mut number = vec![None; m + n];
    let mut blocks: Vec<Block> = Vec::new();
    for i in 0..m + n {
        let place = *number[find(&mut first, i)].get_or_insert_with(|| {
            blocks.push(Block { rows: Vec::new(), columns: Vec::new() });
            blocks.len() - 1
        });
        match i < m {
            true => blocks[place].rows.push(i),
            false => blocks[place].columns.push(i - m),
        }
    }
    blocks
}

/// A⁻ with A A⁻ A = A and A⁻ A A⁻ = A⁻, and the rank. A⁻ r solves A z = r if this system has solutions,
/// whatever the sizes of the equations and the units of the unknowns.
pub(crate) fn solving_inverse(a: &DMatrix<f64>) -> Option<(DMatrix<f64>, usize)> {
    let rows = row_weights(a, &vec![1.0; a.ncols()]);
    let columns = column_weights(a, &rows);
    weighted_inverse(a, &row_weights(a, &columns), &columns)
}

/// As [`solving_inverse`]; A⁻ r is the shortest of the solutions.
pub(crate) fn shortest_inverse(a: &DMatrix<f64>) -> Option<(DMatrix<f64>, usize)> {
    let columns = vec![1.0; a.ncols()];
    weighted_inverse(a, &row_weights(a, &columns), &columns)
}

/// As [`solving_inverse`]; z = A⁻ r minimises the sum of the squares of A z − r, so that equations that
/// consist of mere rounding errors have no weight.
pub(crate) fn fitting_inverse(a: &DMatrix<f64>) -> Option<(DMatrix<f64>, usize)> {
    let rows = vec![1.0; a.nrows()];
    weighted_inverse(a, &rows, &column_weights(a, &rows))
}

/// C (R A C)⁺ R for diagonal matrices R and C.
fn weighted_inverse(a: &DMatrix<f64>, rows: &[f64], columns: &[f64]) -> Option<(DMatrix<f64>, usize)> {
    let scaled = DMatrix::from_fn(a.nrows(), a.ncols(), |i, j| rows[i] * a[(i, j)] * columns[j]);
    let (inverse, rank) = pseudo_inverse(&scaled)?;
    Some((DMatrix::from_fn(a.ncols(), a.nrows(), |i, j| columns[i] * inverse[(i, j)] * rows[j]), rank))
}

/// Powers of two that scale the largest entry of each row to about 1.
fn row_weights(a: &DMatrix<f64>, columns: &[f64]) -> Vec<f64> {
    let entry = |i: usize, j: usize| (a[(i, j)] * columns[j]).abs();
    (0..a.nrows()).map(|i| weight((0..a.ncols()).map(|j| entry(i, j)).fold(0.0, f64::max))).collect()
}

/// Powers of two that scale the largest entry of each column to about 1. Entries that are mere rounding
/// errors of others in their row do not determine the scale of a column.
fn column_weights(a: &DMatrix<f64>, rows: &[f64]) -> Vec<f64> {
    let noise: Vec<f64> = a.row_iter().map(|row| NOISE * row.amax()).collect();
    let column = |j: usize| {
        let known = (0..a.nrows()).filter(|&i| a[(i, j)].abs() > noise[i]);
        weight(known.map(|i| (rows[i] * a[(i, j)]).abs()).fold(0.0, f64::max))
    };
    (0..a.ncols()).map(column).collect()
}

fn weight(largest: f64) -> f64 {
    let power = (-largest.log2()).round().exp2();
    if power.is_normal() { power } else { 1.0 }
}

/// The pseudo-inverse and the rank, computed block by block.
fn pseudo_inverse(a: &DMatrix<f64>) -> Option<(DMatrix<f64>, usize)> {
    let mut inverse = DMatrix::zeros(a.ncols(), a.nrows());
    if a.is_empty() {
        return Some((inverse, 0));
    }
    if a.iter().any(|entry| !entry.is_finite()) {
        return None;
    }
    let with_part = |block: Block| {
        let part = block.of(a);
        (block, part)
    };
    let blocks: Vec<(Block, DMatrix<f64>)> = blocks(a).into_iter().map(with_part).collect();
    let largest = a.norm();
    let regular: Option<Vec<_>> = blocks.iter().map(|(_, part)| of_full_rank(part, largest)).collect();
    let inverses = match regular {
        Some(inverses) => inverses,
        None => by_singular_values(&blocks)?,
    };
    let mut rank = 0;
    for ((block, part), (of_block, of_rank)) in blocks.iter().zip(inverses) {
        rank += of_rank;
        // Either result may have an error of some thousand roundings: a step of Schulz's iteration squares
        // that, and keeps the rank.
        let product = part * &of_block;
        let better = &of_block * 2.0 - &of_block * product;
        for (i, &row) in block.columns.iter().enumerate() {
            block.rows.iter().enumerate().for_each(|(j, &column)| inverse[(row, column)] = better[(i, j)]);
        }
    }
    Some((inverse, rank))
}

/// The pseudo-inverse computed by orthogonal elimination; none if the rank is in doubt: singular values are
/// at least 1/‖A⁺‖, and at most the norm of the full matrix, `largest`.
fn of_full_rank(a: &DMatrix<f64>, largest: f64) -> Option<(DMatrix<f64>, usize)> {
    let rank = a.nrows().min(a.ncols());
    if rank == 0 {
        return Some((DMatrix::zeros(a.ncols(), a.nrows()), 0));
    }
    let is_tall = a.nrows() >= a.ncols();
    let qr = if is_tall { a.clone() } else { a.transpose() }.qr();
    let inverse = qr.r().solve_upper_triangular(&DMatrix::identity(rank, rank))?;
    if !within(RANK * largest * inverse.norm(), CERTAIN) {
        return None;
    }
    let inverse = inverse * qr.q().transpose();
    Some((if is_tall { inverse } else { inverse.transpose() }, rank))
}

/// The pseudo-inverse computed from singular values, which also show the rank.
fn by_singular_values(blocks: &[(Block, DMatrix<f64>)]) -> Option<Vec<(DMatrix<f64>, usize)>> {
    let parts: Vec<_> =
        blocks.iter().map(|(_, part)| (!part.is_empty()).then(|| part.clone().svd(true, true))).collect();
    let largest = parts.iter().flatten().map(|svd| svd.singular_values.max()).fold(0.0, f64::max);
    let threshold = RANK * largest;
    let mut inverses = Vec::with_capacity(blocks.len());
    for ((_, part), svd) in blocks.iter().zip(parts) {
        inverses.push(match svd {
            None => (DMatrix::zeros(part.ncols(), part.nrows()), 0),
            Some(svd) => {
                let rank = svd.singular_values.iter().filter(|&&value| value > threshold).count();
                (svd.pseudo_inverse(threshold.max(f64::MIN_POSITIVE)).ok()?, rank)
            }
        });
    }
    Some(inverses)
}

/// The indices of rows of `width` entries each that are independent of the preceding ones, found by the
/// method of Gram and Schmidt.
pub(crate) fn independent_rows(rows: &[Vec<f64>], width: usize) -> Vec<usize> {
    let all = matrix(rows, width);
    let columns = column_weights(&all, &row_weights(&all, &vec![1.0; width]));
    let mut basis: Vec<DVector<f64>> = Vec::new();
    let mut independent = Vec::new();
    for (i, row) in rows.iter().enumerate() {
        let row = DVector::from_fn(width, |j, _| row[j] * columns[j]);
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

/// Solves by elimination with complete pivoting, with rows and columns scaled by powers of two. `terms` has
/// the largest term of each right-hand side.
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
    let inverse = inverse_by_pivots(&scaled).ok_or(Irregular::Singular)?;
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

/// The inverse, computed block by block; none if a pivot is too small relative to the largest.
fn inverse_by_pivots(a: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let mut inverse = DMatrix::zeros(a.nrows(), a.ncols());
    let (mut least, mut largest) = (f64::INFINITY, 0.0f64);
    for block in blocks(a) {
        if block.rows.len() != block.columns.len() {
            return None;
        }
        let lu = block.of(a).full_piv_lu();
        let pivots = lu.u().diagonal().abs();
        (least, largest) = (least.min(pivots.min()), largest.max(pivots.max()));
        let of_block = lu.try_inverse()?;
        for (i, &row) in block.columns.iter().enumerate() {
            block.rows.iter().enumerate().for_each(|(j, &column)| inverse[(row, column)] = of_block[(i, j)]);
        }
    }
    within(PIVOT * largest, least).then_some(inverse)
}

/// Powers of two that scale the largest entries of rows and columns to about 1.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numbers::rounding::Random;

    /// A matrix with these blocks, its rows and columns being put in a different order.
    fn shuffled(parts: &[DMatrix<f64>]) -> DMatrix<f64> {
        let (m, n) = (parts.iter().map(DMatrix::nrows).sum(), parts.iter().map(DMatrix::ncols).sum());
        let mut all = DMatrix::zeros(m, n);
        let (mut row, mut column) = (0, 0);
        for part in parts {
            // 7 is prime to both sizes.
            for (i, j) in (0..part.nrows()).flat_map(|i| (0..part.ncols()).map(move |j| (i, j))) {
                all[((row + i) * 7 % m, (column + j) * 7 % n)] = part[(i, j)];
            }
            (row, column) = (row + part.nrows(), column + part.ncols());
        }
        all
    }

    fn random(m: usize, n: usize, rank: usize) -> DMatrix<f64> {
        let mut random = Random::new((100 * m + 10 * n + rank) as u64);
        let mut factor = |m, n| DMatrix::from_fn(m, n, |_, _| random.signed());
        factor(m, rank) * factor(rank, n)
    }

    /// Penrose's four equations hold to within some hundred rounding errors of numbers near 10.
    #[test]
    fn blocks_have_the_pseudo_inverse_of_the_whole() {
        let full = [random(4, 4, 4), random(5, 2, 2), random(1, 3, 1)];
        let deficient = [random(4, 4, 2), random(5, 2, 2), DMatrix::zeros(1, 2)];
        for (parts, expected) in [(full, 7), (deficient, 4)] {
            let a = shuffled(&parts);
            let (inverse, rank) = pseudo_inverse(&a).expect("finite");
            assert_eq!(rank, expected);
            let (left, right) = (&inverse * &a, &a * &inverse);
            for rest in [
                &a * &left - &a,
                &left * &inverse - &inverse,
                left.transpose() - &left,
                right.transpose() - &right,
            ] {
                assert!(rest.amax() < 1e-12 * inverse.amax().max(1.0), "{rest}");
            }
        }
    }

    #[test]
    fn a_rank_is_relative_to_the_largest_block() {
        let tiny = DMatrix::from_element(1, 1, 1e-11);
        let (inverse, rank) = pseudo_inverse(&shuffled(&[random(3, 3, 3), tiny])).expect("finite");
        assert_eq!(rank, 3);
        assert!(inverse.amax() < 1e6, "{inverse}");
    }

    #[test]
    fn an_undetermined_unknown_is_singular() {
        let a = shuffled(&[random(2, 3, 2), random(3, 2, 2)]);
        assert!(matches!(solve(&a, &[1.0; 5], &[1.0; 5]), Err(Irregular::Singular)));
        let a = shuffled(&[random(3, 3, 3), random(2, 2, 2)]);
        let solution = solve(&a, &[1.0; 5], &[1.0; 5]).expect("regular");
        let rest = &a * DVector::from_vec(solution.values) - DVector::from_element(5, 1.0);
        assert!(rest.amax() < 1e-12 * solution.condition, "{rest}");
    }

    /// The equations 1e-9 (z_1 + z_2) = 3e-9, 1e9 (z_1 − 1e-12 z_3) = 1e9, z_1 − 2e-12 z_3 = 0 have z = (2, 1, 1e12).
    #[test]
    fn neither_the_size_of_an_equation_nor_a_unit_decides_a_rank() {
        let rows = [vec![1e-9, 1e-9, 0.0], vec![1e9, 0.0, -1e-3], vec![1.0, 0.0, -2e-12]];
        let (inverse, rank) = solving_inverse(&matrix(&rows, 3)).expect("finite");
        let z = inverse * DVector::from_vec(vec![3e-9, 1e9, 0.0]);
        assert_eq!(rank, 3);
        for (found, expected) in z.iter().zip([2.0, 1.0, 1e12]) {
            assert!((found - expected).abs() < 1e-14 * expected, "{z}");
        }
        assert_eq!(independent_rows(&rows, 3), [0, 1, 2]);
        let multiple: Vec<f64> = rows[1].iter().map(|entry| 1e-15 * entry).collect();
        assert_eq!(independent_rows(&[rows[1].clone(), multiple], 3), [0]);
    }

    /// cos(π/2) beside 1, in the only row with an entry in that column, does not determine the scale of that
    /// column.
    #[test]
    fn rounding_is_no_unit() {
        let rows = [vec![1.0, 6.1e-17], vec![2.0, 0.0]];
        assert_eq!(independent_rows(&rows, 2), [0]);
        let (inverse, rank) = solving_inverse(&matrix(&rows, 2)).expect("finite");
        assert_eq!(rank, 1);
        assert!(inverse.amax() < 1.0, "{inverse}");
    }
}

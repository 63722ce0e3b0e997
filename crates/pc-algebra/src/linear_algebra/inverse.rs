//! Inverses of matrices of expressions; an inverse is singular only where the matrix is.

use pc_expr::{Expr, Graph, Number, independent_blocks};

use crate::identity::sample::Neighbourhood;
use crate::linear_algebra::block_triangular::block_triangular;
use crate::linear_algebra::matrix::Matrix;

/// Blocks up to this size are inverted by cofactors, larger ones by elimination.
const COFACTORS: usize = 4;
/// Pivots that are at least this fraction of the largest are acceptable: rounding errors grow at most
/// tenfold.
const READILY: f64 = 0.1;
/// Constants smaller than this fraction of the largest entry in their row are not used as pivots: rounding
/// errors would grow a thousandfold.
const TINY: f64 = 1e-3;
/// A difference between rounded constants that is smaller than this fraction of the constants, some hundred
/// rounding errors, counts as zero.
const ROUNDING: f64 = 1e-13;

/// The inverse of a square matrix; `None` if its determinant is identically zero.
///
/// The entries of the inverse are regular wherever the matrix is. Constant pivots that are not small relative
/// to their row are eliminated first. The remaining matrix is solved block by block, in block triangular
/// form: small blocks by cofactors over their determinant, larger ones by orthogonalisation. No divisor
/// vanishes at any state where the matrix is regular. Constants that cancel up to rounding errors count as
/// zero; so does a divisor that is no more than a rounding error at random points, even if the graph does not
/// fold it to zero.
///
/// Uncoupled rows and columns are inverted separately.
pub fn inverse<'g>(graph: &'g Graph, matrix: &Matrix<Expr<'g>>) -> Option<Matrix<Expr<'g>>> {
    let n = matrix.rows();
    let entries = |i: usize| matrix.nonzero(i).map(|(j, _)| j).collect();
    let blocks = independent_blocks(n, &(0..n).map(entries).collect::<Vec<_>>());
    if blocks.iter().map(|(rows, _)| rows.len()).sum::<usize>() < n {
        return None;
    }
    let mut result = Matrix::from_rows(n, vec![Vec::new(); n]);
    for (rows, columns) in blocks {
        if rows.len() != columns.len() {
            return None;
        }
        let block = Matrix::from_fn(rows.len(), rows.len(), |i, j| matrix[(rows[i], columns[j])]);
        let inverted = inverse_of_block(graph, &block)?;
        for (j, &column) in columns.iter().enumerate() {
            for (i, &row) in rows.iter().enumerate() {
                result[(column, row)] = inverted[(j, i)];
            }
        }
    }
    Some(result)
}

fn inverse_of_block<'g>(graph: &'g Graph, matrix: &Matrix<Expr<'g>>) -> Option<Matrix<Expr<'g>>> {
    let n = matrix.rows();
    let mut work = Elimination::new(graph, matrix);
    while let Some(pivot) = work.constant_pivot() {
        work.eliminate(pivot);
    }
    let mut result = Matrix::from_fn(n, n, |_, _| Expr::ZERO);
    let mut solved: Vec<usize> = Vec::with_capacity(n);
    for (rows, columns) in work.blocks()? {
        let block = Matrix::from_fn(rows.len(), columns.len(), |i, j| work.left[(rows[i], columns[j])]);
        let block_inverse = if rows.len() <= COFACTORS {
            cofactor_inverse(graph, &block)?
        } else {
            orthogonal_inverse(graph, &block)?
        };
        for j in 0..n {
            let rest = |&row: &usize| {
                let known = solved.iter().map(|&c| -(work.left[(row, c)] * result[(c, j)]));
                graph.sum(known.chain([work.right[(row, j)]]))
            };
            let rests: Vec<Expr<'g>> = rows.iter().map(rest).collect();
            for (i, &column) in columns.iter().enumerate() {
                result[(column, j)] = graph.dot(block_inverse.row(i).iter().copied(), rests.iter().copied());
            }
        }
        solved.extend(columns);
    }
    for &(row, column) in &work.done {
        for j in 0..n {
            let known = graph.sum(solved.iter().map(|&c| work.left[(row, c)] * result[(c, j)]));
            result[(column, j)] = work.right[(row, j)] - known;
        }
    }
    Some(result)
}

/// The determinant of a square matrix; `None` for more than four rows, since the determinant is then a long
/// expression.
pub fn determinant<'g>(graph: &'g Graph, matrix: &Matrix<Expr<'g>>) -> Option<Expr<'g>> {
    let all: Vec<usize> = (0..matrix.rows()).collect();
    (all.len() <= COFACTORS && matrix.columns() == all.len()).then(|| minor(graph, matrix, &all, &all))
}

/// Gauss–Jordan elimination of `left | right` with the pivots in any order.
struct Elimination<'g> {
    graph: &'g Graph,
    left: Matrix<Expr<'g>>,
    right: Matrix<Expr<'g>>,
    open_rows: Vec<usize>,
    open_columns: Vec<usize>,
    done: Vec<(usize, usize)>,
}

impl<'g> Elimination<'g> {
    fn new(graph: &'g Graph, matrix: &Matrix<Expr<'g>>) -> Elimination<'g> {
        let n = matrix.rows();
        Elimination {
            graph,
            left: matrix.clone(),
            right: Matrix::from_fn(n, n, |i, j| if i == j { Expr::ONE } else { Expr::ZERO }),
            open_rows: (0..n).collect(),
            open_columns: (0..n).collect(),
            done: Vec::new(),
        }
    }

    fn open(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.open_rows.iter().flat_map(|&i| self.open_columns.iter().map(move |&j| (i, j)))
    }

    /// The position of the first constant that is comparable to the largest entry of its row.
    fn constant_pivot(&self) -> Option<(usize, usize)> {
        let is_constant = |&at: &(usize, usize)| self.left[at].constant().is_some_and(|c| !c.is_zero());
        let constants: Vec<(usize, usize)> = self.open().filter(is_constant).collect();
        if constants.is_empty() {
            return None;
        }
        let shares = self.shares();
        let best = constants.iter().map(|&at| shares[at]).fold(0.0, f64::max);
        constants.into_iter().find(|&at| best > TINY && shares[at] >= READILY * best)
    }

    /// The rows and columns of the diagonal blocks of the remaining matrix, each with zeros in the columns of
    /// all later ones; one block if that is small; `None` if the zeros alone make the matrix singular.
    fn blocks(&self) -> Option<Vec<(Vec<usize>, Vec<usize>)>> {
        let (rows, columns) = (&self.open_rows, &self.open_columns);
        if rows.is_empty() {
            return Some(Vec::new());
        }
        if rows.len() <= COFACTORS {
            return Some(vec![(rows.clone(), columns.clone())]);
        }
        let entries: Vec<Vec<usize>> = rows
            .iter()
            .map(|&i| (0..columns.len()).filter(|&j| !self.left[(i, columns[j])].is_zero()).collect())
            .collect();
        let blocks = block_triangular(&entries)?;
        let named = |(i, j): (Vec<usize>, Vec<usize>)| {
            (i.into_iter().map(|i| rows[i]).collect(), j.into_iter().map(|j| columns[j]).collect())
        };
        Some(blocks.into_iter().map(named).collect())
    }

    /// The size of each entry relative to the largest remaining one in its row. An expression is evaluated at
    /// one point, and counts as 1 if it has no value there.
    fn shares(&self) -> Matrix<f64> {
        let open: Vec<(usize, usize)> = self.open().collect();
        let entries: Vec<Expr<'g>> = open.iter().map(|&at| self.left[at]).collect();
        let sample = Neighbourhood::default().sample::<f64>(self.graph, &entries, 1);
        let sizes = sample.unwrap_or_default().into_iter().map(f64::abs);
        let mut shares = self.left.map(|_| 0.0);
        for (&at, size) in open.iter().zip(sizes) {
            shares[at] = if size.is_finite() { size } else { 1.0 };
        }
        for &i in &self.open_rows {
            let largest = shares.row(i).iter().copied().fold(0.0, f64::max);
            for &j in self.open_columns.iter().filter(|_| largest > 0.0) {
                shares[(i, j)] /= largest;
            }
        }
        shares
    }

    fn eliminate(&mut self, (row, column): (usize, usize)) {
        let n = self.left.rows();
        let pivot = self.left[(row, column)];
        for j in 0..n {
            self.left[(row, j)] = self.left[(row, j)] / pivot;
            self.right[(row, j)] = self.right[(row, j)] / pivot;
        }
        for i in (0..n).filter(|&i| i != row) {
            let factor = self.left[(i, column)];
            if factor.is_zero() {
                continue;
            }
            for j in 0..n {
                self.left[(i, j)] = difference(self.graph, self.left[(i, j)], factor * self.left[(row, j)]);
                self.right[(i, j)] =
                    difference(self.graph, self.right[(i, j)], factor * self.right[(row, j)]);
            }
        }
        self.open_rows.retain(|&i| i != row);
        self.open_columns.retain(|&j| j != column);
        self.done.push((row, column));
    }
}

/// The difference x − y, or 0 for constants that differ only by rounding errors.
fn difference<'g>(graph: &'g Graph, x: Expr<'g>, y: Expr<'g>) -> Expr<'g> {
    let difference = graph.sum([x, -y]);
    let (Some(Number::Real(rest)), Some(x)) = (difference.constant(), x.constant()) else {
        return difference;
    };
    if rest.abs() < ROUNDING * x.to_f64().abs() { Expr::ZERO } else { difference }
}

/// adj A / det A
fn cofactor_inverse<'g>(graph: &'g Graph, a: &Matrix<Expr<'g>>) -> Option<Matrix<Expr<'g>>> {
    let m = a.rows();
    let all: Vec<usize> = (0..m).collect();
    // For links given by their directions these are sines of the angles between them.
    let short = |minor: Expr<'g>| graph.merged_angles(&[minor])[0];
    let determinant = short(minor(graph, a, &all, &all));
    // Products of small units look like rounding errors, until the rows have units of their own.
    let vanishes = |of: Expr<'g>| Neighbourhood::anywhere(graph, &[of]).vanishes(graph, of);
    if vanishes(determinant) && vanishes(short(minor(graph, &in_own_units(graph, a), &all, &all))) {
        return None;
    }
    let without = |skip: usize| -> Vec<usize> { (0..m).filter(|&i| i != skip).collect() };
    Some(Matrix::from_fn(m, m, |i, j| {
        let cofactor = short(minor(graph, a, &without(j), &without(i)));
        let signed = if (i + j).is_multiple_of(2) { cofactor } else { -cofactor };
        signed / determinant
    }))
}

/// The matrix with each row divided by the power of two that is nearest to its largest entry at one point.
fn in_own_units<'g>(graph: &'g Graph, a: &Matrix<Expr<'g>>) -> Matrix<Expr<'g>> {
    let sample = Neighbourhood::anywhere(graph, &a.entries()).sample::<f64>(graph, &a.entries(), 1);
    let sizes = sample.unwrap_or_default();
    let unit = |i: usize| {
        let row = sizes.iter().skip(i * a.columns()).take(a.columns());
        let largest = row.fold(0.0, |largest: f64, entry| largest.max(entry.abs()));
        if largest.is_normal() { largest.log2().round().exp2() } else { 1.0 }
    };
    Matrix::from_fn(a.rows(), a.columns(), |i, j| a[(i, j)] / unit(i))
}

/// The inverse A⁻¹ = U⁻¹ D⁻¹ Qᵀ, where A = Q U, the columns of Q are orthogonal, D = QᵀQ and U is unit upper
/// triangular (Gram–Schmidt without square roots). The D_j are positive wherever A is regular; the rounding
/// error is in proportion to the square of the condition number of A.
fn orthogonal_inverse<'g>(graph: &'g Graph, a: &Matrix<Expr<'g>>) -> Option<Matrix<Expr<'g>>> {
    let m = a.rows();
    let dot = |x: &[Expr<'g>], y: &[Expr<'g>]| graph.dot(x.iter().copied(), y.iter().copied());
    let mut q: Vec<Vec<Expr<'g>>> = Vec::with_capacity(m);
    let mut squares: Vec<Expr<'g>> = Vec::with_capacity(m);
    let mut u = Matrix::from_fn(m, m, |_, _| Expr::ZERO);
    for k in 0..m {
        let mut column: Vec<Expr<'g>> = a.column(k).collect();
        for j in 0..k {
            let share = dot(&q[j], &column) / squares[j];
            u[(j, k)] = share;
            for (entry, &other) in column.iter_mut().zip(&q[j]) {
                *entry = graph.sum([*entry, -(share * other)]);
            }
        }
        let square = dot(&column, &column);
        if Neighbourhood::anywhere(graph, &[square]).vanishes(graph, square) {
            return None;
        }
        squares.push(square);
        q.push(column);
    }
    let mut inverse = Matrix::from_fn(m, m, |j, i| q[j][i] / squares[j]);
    for j in (0..m).rev() {
        for i in 0..m {
            let known = (j + 1..m).map(|k| -(u[(j, k)] * inverse[(k, i)]));
            inverse[(j, i)] = graph.sum(known.chain([inverse[(j, i)]]).collect::<Vec<_>>());
        }
    }
    Some(inverse)
}

/// The determinant of the listed rows and columns, by expansion along the first row.
fn minor<'g>(graph: &'g Graph, a: &Matrix<Expr<'g>>, rows: &[usize], columns: &[usize]) -> Expr<'g> {
    let Some((&row, rest)) = rows.split_first() else { return Expr::ONE };
    graph.sum(columns.iter().enumerate().filter(|&(_, &column)| !a[(row, column)].is_zero()).map(
        |(position, &column)| {
            let others: Vec<usize> = columns.iter().copied().filter(|&c| c != column).collect();
            let term = a[(row, column)] * minor(graph, a, rest, &others);
            if position.is_multiple_of(2) { term } else { -term }
        },
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rotation_is_inverted_without_division() {
        let graph = Graph::new();
        let phi = graph.symbol("phi");
        let (s, c) = (phi.sin(), phi.cos());
        let a = Matrix::from_fn(2, 2, |i, j| [[c, s], [-s, c]][i][j]);
        let b = inverse(&graph, &a).unwrap();
        assert_eq!(b, a.transpose());
    }

    #[test]
    fn inverse_times_matrix_is_one() {
        let graph = Graph::new();
        let [x, y, z] = graph.symbols(["x", "y", "z"]);
        let zero = Expr::ZERO;
        let rows = [
            [x.sin(), y, zero, zero, zero],
            [zero, x, z, y.exp(), zero],
            [y, zero, x * y, z, zero],
            [z, y, x.cos(), zero, zero],
            [x, x, x, z, Expr::ONE],
        ];
        let a = Matrix::from_fn(5, 5, |i, j| rows[i][j]);
        let b = inverse(&graph, &a).unwrap();
        for i in 0..5 {
            for j in 0..5 {
                let entry = graph.dot(a.row(i).iter().copied(), b.column(j));
                assert_eq!(entry, if i == j { Expr::ONE } else { Expr::ZERO }, "entry {i}, {j}");
            }
        }
    }

    /// Tests diagonally dominant matrices of several sizes, which are regular at every state, even where
    /// minors vanish.
    #[test]
    fn the_inverse_is_regular_wherever_the_matrix_is() {
        let graph = Graph::new();
        for n in [5, 6, 9] {
            let x: Vec<Expr<'_>> = (0..n).map(|i| graph.symbol(&format!("x{i}"))).collect();
            let entry = |i: usize, j: usize| {
                let cosine = x[(3 * i + 5 * j + i * j) % n].cos();
                if i == j { cosine + (n as f64 + 1.0) } else { cosine }
            };
            let a = Matrix::from_fn(n, n, entry);
            let b = inverse(&graph, &a).unwrap();
            // where all angles are one many minors vanish
            for state in [vec![0.1; n], vec![0.0; n], (0..n).map(|i| 0.1 + 0.5 * (i / 2) as f64).collect()] {
                let values: Vec<(Expr<'_>, f64)> = x.iter().copied().zip(state).collect();
                let [a, b] = [&a, &b].map(|m| graph.evaluate(&m.entries(), &values).unwrap());
                for i in 0..n {
                    for j in 0..n {
                        let product: f64 = (0..n).map(|k| a[i * n + k] * b[k * n + j]).sum();
                        let expected = if i == j { 1.0 } else { 0.0 };
                        // n³ roundings of numbers of order one
                        assert!((product - expected).abs() < 1e-13, "{n}: {i}, {j}: {product}");
                    }
                }
            }
        }
    }

    /// log(xy) − log x − log y is zero, though the graph does not know it.
    #[test]
    fn an_entry_that_is_rounding_everywhere_is_not_a_pivot() {
        let graph = Graph::new();
        let [x, y] = graph.symbols(["x", "y"]);
        let zero = (x * y).log() - x.log() - y.log();
        let rows = [[x, y], [x * y, y.square() + zero]];
        assert!(!zero.is_zero());
        assert!(inverse(&graph, &Matrix::from_fn(2, 2, |i, j| rows[i][j])).is_none());
        let six = Matrix::from_fn(6, 6, |i, j| match (i, j) {
            (0, 0) => x + zero,
            (1, 0) => x,
            _ if i == j => x + y * (i as f64),
            _ => (x * (i + 2 * j) as f64).cos(),
        });
        let singular = Matrix::from_fn(6, 6, |i, j| if i < 2 && j > 0 { six[(1, j)] } else { six[(i, j)] });
        assert!(inverse(&graph, &singular).is_none());
    }

    /// The frame is x' = w − u, whatever the rounding error of cos(π/2).
    #[test]
    fn a_rounding_error_is_not_a_pivot() {
        let graph = Graph::new();
        let noise = Expr::from((std::f64::consts::PI / 2.0).cos());
        let x = graph.symbol("x");
        let (one, zero) = (Expr::ONE, Expr::ZERO);
        for rows in [
            [[noise, one, zero], [one, one, zero], [zero, zero, one]],
            [[noise, x.exp(), zero], [one, x.exp(), zero], [zero, zero, x]],
            [[noise, x.exp(), zero], [x, x.sin(), zero], [zero, zero, x]],
        ] {
            let a = Matrix::from_fn(3, 3, |i, j| rows[i][j]);
            let b = inverse(&graph, &a).unwrap();
            for (index, &entry) in b.entries().iter().enumerate() {
                let column = |i: usize| b[(i, index % 3)];
                let product = graph.dot(a.row(index / 3).iter().copied(), (0..3).map(column));
                let values = graph.evaluate(&[product, entry], &[(x, 0.7)]).unwrap();
                let expected = if index.is_multiple_of(4) { 1.0 } else { 0.0 };
                // some operations with entries of order one
                assert!(
                    (values[0] - expected).abs() < 1e-14 && values[1].abs() < 10.0,
                    "{index}: {values:?}"
                );
            }
        }
    }

    /// Small constants are pivots if the row has nothing larger, as happens when a quasi-velocity has a small
    /// unit.
    #[test]
    fn a_small_unit_is_not_a_rounding_error() {
        let graph = Graph::new();
        let [x, y] = graph.symbols(["x", "y"]);
        let rows = [[Expr::from(1e-10), Expr::ZERO], [y, x]];
        let b = inverse(&graph, &Matrix::from_fn(2, 2, |i, j| rows[i][j])).unwrap();
        assert_eq!(b.to_rows(), [[Expr::from(1e10), Expr::ZERO], [-1e10 * y / x, x.powi(-1)]]);
    }

    /// The determinant is 10⁻¹⁵ sin x sin y, and 10⁻¹⁵ could be a rounding error.
    #[test]
    fn products_of_small_units_are_no_rounding_error() {
        let graph = Graph::new();
        let [x, y] = graph.symbols(["x", "y"]);
        let small = Expr::from(1e-5 * 2f64.sqrt());
        let rows = [
            [small * x.sin(), small, Expr::ZERO],
            [Expr::ZERO, small * y.sin(), small * x],
            [Expr::ZERO, Expr::ZERO, small],
        ];
        assert!(cofactor_inverse(&graph, &Matrix::from_fn(3, 3, |i, j| rows[i][j])).is_some());
    }

    /// √2·√2 − 2 is 0, though not in floating point.
    #[test]
    fn constants_that_cancel_up_to_rounding_are_singular() {
        let graph = Graph::new();
        let root = Expr::from(2f64.sqrt());
        let rows = [[root, Expr::ONE], [Expr::from(2.0), root]];
        assert!(!(root * root - 2.0).is_zero());
        assert!(inverse(&graph, &Matrix::from_fn(2, 2, |i, j| rows[i][j])).is_none());
    }

    #[test]
    fn a_singular_matrix_has_no_inverse() {
        let graph = Graph::new();
        let x = graph.symbol("x");
        let rows = [[x.sin(), x.cos()], [x.sin().square(), x.sin() * x.cos()]];
        assert!(inverse(&graph, &Matrix::from_fn(2, 2, |i, j| rows[i][j])).is_none());
    }
}

//! Inverses of matrices of expressions that are singular only where the matrix is.

use pc_expr::{Expr, Graph};

use crate::matrix::Matrix;

/// Blocks up to this size are inverted by cofactors, larger ones by elimination.
const COFACTORS: usize = 4;

/// The inverse of a square matrix; `None` if its determinant is identically zero.
///
/// Constant pivots are eliminated first, the block that is left is inverted as cofactors over its
/// determinant: the entries are regular wherever the matrix is. (Only a block of more than four rows without
/// constant pivots is eliminated with pivots that depend on the state and may vanish on their own.)
pub fn inverse<'g>(graph: &'g Graph, matrix: &Matrix<Expr<'g>>) -> Option<Matrix<Expr<'g>>> {
    let n = matrix.rows();
    let mut work = Elimination::new(graph, matrix);
    while let Some(pivot) = work.constant_pivot() {
        work.eliminate(pivot);
    }
    while work.open_rows.len() > COFACTORS {
        let pivot = work.cheapest_pivot()?;
        work.eliminate(pivot);
    }
    let (rows, columns) = (work.open_rows.clone(), work.open_columns.clone());
    let block = Matrix::from_fn(rows.len(), columns.len(), |i, j| work.left[(rows[i], columns[j])]);
    let block_inverse = cofactor_inverse(graph, &block)?;

    let mut result = Matrix::from_fn(n, n, |_, _| Expr::ZERO);
    for (i, &column) in columns.iter().enumerate() {
        for j in 0..n {
            let right = rows.iter().map(|&row| work.right[(row, j)]);
            result[(column, j)] = graph.dot(block_inverse.row(i).iter().copied(), right);
        }
    }
    for &(row, column) in &work.done {
        for j in 0..n {
            let known = graph.sum(columns.iter().map(|&c| work.left[(row, c)] * result[(c, j)]));
            result[(column, j)] = work.right[(row, j)] - known;
        }
    }
    Some(result)
}

/// The determinant of a square matrix; `None` for more than four rows, where it is no short expression.
pub fn determinant<'g>(graph: &'g Graph, matrix: &Matrix<Expr<'g>>) -> Option<Expr<'g>> {
    let all: Vec<usize> = (0..matrix.rows()).collect();
    (all.len() <= COFACTORS && matrix.columns() == all.len()).then(|| minor(graph, matrix, &all, &all))
}

/// Gauss–Jordan elimination of `left | right`, in whatever order pivots are chosen.
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

    fn constant_pivot(&self) -> Option<(usize, usize)> {
        self.open().find(|&at| self.left[at].constant().is_some_and(|c| !c.is_zero()))
    }

    fn cheapest_pivot(&self) -> Option<(usize, usize)> {
        self.open().filter(|&at| !self.left[at].is_zero()).min_by_key(|&at| self.left[at].tree_cost())
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
                self.left[(i, j)] = self.graph.sum([self.left[(i, j)], -(factor * self.left[(row, j)])]);
                self.right[(i, j)] = self.graph.sum([self.right[(i, j)], -(factor * self.right[(row, j)])]);
            }
        }
        self.open_rows.retain(|&i| i != row);
        self.open_columns.retain(|&j| j != column);
        self.done.push((row, column));
    }
}

/// adj A / det A
fn cofactor_inverse<'g>(graph: &'g Graph, a: &Matrix<Expr<'g>>) -> Option<Matrix<Expr<'g>>> {
    let m = a.rows();
    let all: Vec<usize> = (0..m).collect();
    let determinant = minor(graph, a, &all, &all);
    if determinant.is_zero() {
        return None;
    }
    let without = |skip: usize| -> Vec<usize> { (0..m).filter(|&i| i != skip).collect() };
    Some(Matrix::from_fn(m, m, |i, j| {
        let cofactor = minor(graph, a, &without(j), &without(i));
        let signed = if (i + j).is_multiple_of(2) { cofactor } else { -cofactor };
        signed / determinant
    }))
}

/// Determinant of the rows and columns listed, by expansion along the first row.
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

    #[test]
    fn a_singular_matrix_has_no_inverse() {
        let graph = Graph::new();
        let x = graph.symbol("x");
        let rows = [[x.sin(), x.cos()], [x.sin().square(), x.sin() * x.cos()]];
        assert!(inverse(&graph, &Matrix::from_fn(2, 2, |i, j| rows[i][j])).is_none());
    }
}

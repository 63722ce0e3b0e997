//! The cost of an elimination, estimated from the zeros of the matrix alone.

use std::collections::BTreeSet;

use pc_algebra::Matrix;
use pc_expr::{Expr, Graph};

/// The number of divisions and multiply-subtracts in a factorisation M = L D Lᵀ that always eliminates
/// the row with the fewest entries left, fill-in included:
///
///   m + m(m + 1)/2   for each row that is coupled to m remaining rows.
///
/// A full matrix takes k(k − 1)(k + 4)/6, a tridiagonal one 2(k − 1).
pub(crate) fn operations(m: &Matrix<Expr<'_>>) -> usize {
    let others = |i: usize| m.nonzero(i).map(|(j, _)| j).filter(|&j| j != i).collect();
    let mut filled: Vec<BTreeSet<usize>> = (0..m.rows()).map(others).collect();
    let mut open: BTreeSet<(usize, usize)> = filled.iter().map(BTreeSet::len).zip(0..).collect();
    let mut count = 0;
    while let Some((_, pivot)) = open.pop_first() {
        let below = std::mem::take(&mut filled[pivot]);
        count += below.len() + below.len() * (below.len() + 1) / 2;
        for &i in &below {
            open.remove(&(filled[i].len(), i));
            filled[i].remove(&pivot);
            filled[i].extend(below.iter().filter(|&&j| j != i));
            open.insert((filled[i].len(), i));
        }
    }
    count
}

/// Whether M = L D Lᵀ exists in the order of the rows at almost all states: no leading minor is zero.
pub(crate) fn needs_no_pivoting<'g>(graph: &'g Graph, m: &Matrix<Expr<'g>>) -> bool {
    let row = |i: usize, size: usize| m.nonzero(i).take_while(|&(j, _)| j < size).collect();
    let leading = |size: usize| (0..size).map(|i| row(i, size)).collect::<Vec<_>>();
    (1..=m.rows()).all(|size| graph.generic_rank_of_entries(size, &leading(size)) == size)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn operations_are_those_of_the_entries_left() {
        let count = |k, entry: fn(usize, usize) -> bool| {
            operations(&Matrix::from_fn(k, k, |i, j| if entry(i, j) { Expr::ONE } else { Expr::ZERO }))
        };
        assert_eq!(count(16, |_, _| true), 16 * 15 * 20 / 6);
        assert_eq!(count(100, |i, j| i.abs_diff(j) <= 1), 2 * 99);
        assert_eq!(count(50, |i, j| i == j || i == 0 || j == 0), 2 * 49, "the head of an arrow goes last");
        assert_eq!(count(0, |_, _| true), 0);
    }

    #[test]
    fn a_zero_on_the_diagonal_needs_pivoting() {
        let graph = Graph::new();
        let [a, b] = graph.symbols(["a", "b"]);
        let swap = Matrix::from_fn(2, 2, |i, j| if i == j { Expr::ZERO } else { a });
        assert!(!needs_no_pivoting(&graph, &swap));
        let regular = Matrix::from_fn(2, 2, |i, j| if i == j { b } else { a });
        assert!(needs_no_pivoting(&graph, &regular));
    }
}

//! Linear algebra over fingerprints: results for almost all values of the symbols.
//!
//! Values may contain roots, whose products obey laws of their own; elimination therefore differs from the
//! method of `echelon`.

use crate::graph::expr::Expr;
use crate::graph::graph::Graph;
use crate::graph::node::Atom;
use crate::identity::blocks::independent_blocks;
use crate::identity::fingerprint::Fingerprint;
use crate::identity::roots::Value;

impl Graph {
    /// Rank of a matrix of expressions, given by its rows, at almost all values of the symbols.
    pub fn generic_rank<'g>(&'g self, rows: &[Vec<Expr<'g>>]) -> usize {
        let entries = |row: &Vec<Expr<'g>>| {
            row.iter().copied().enumerate().filter(|(_, x)| !x.is_zero()).collect::<Vec<_>>()
        };
        let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
        self.generic_rank_of_entries(columns, &rows.iter().map(entries).collect::<Vec<_>>())
    }

    /// Rank of a matrix whose rows are given by their nonzero entries, with columns
    /// in ascending order.
    pub fn generic_rank_of_entries<'g>(&'g self, columns: usize, rows: &[Vec<(usize, Expr<'g>)>]) -> usize {
        let places = |row: &Vec<(usize, Expr<'g>)>| row.iter().map(|&(j, _)| j).collect();
        let blocks = independent_blocks(columns, &rows.iter().map(places).collect::<Vec<_>>());
        blocks.iter().map(|(i, j)| self.rank_of_block(rows, i, j)).sum()
    }

    /// The rank of the given rows of a matrix, all of whose entries lie in the given columns.
    fn rank_of_block<'g>(
        &'g self,
        rows: &[Vec<(usize, Expr<'g>)>],
        of_rows: &[usize],
        of_columns: &[usize],
    ) -> usize {
        self.with(|dag| {
            let value = |x: &Expr<'g>| match x.atom() {
                Atom::Constant(c) => c.fingerprint().into(),
                Atom::Node(id) => dag.value(id),
            };
            let row = |&i: &usize| {
                let mut row = vec![Value::from(Fingerprint::ZERO); of_columns.len()];
                for (j, x) in &rows[i] {
                    if let Ok(place) = of_columns.binary_search(j) {
                        row[place] = value(x);
                    }
                }
                row
            };
            let mut rows: Vec<Vec<Value>> = of_rows.iter().map(row).collect();
            let (roots, columns) = (dag.roots_mut(), of_columns.len());
            let mut rank = 0;
            for column in 0..columns {
                let Some(pivot) = (rank..rows.len()).find(|&r| !rows[r][column].is_zero()) else {
                    continue;
                };
                rows.swap(rank, pivot);
                let (head, tail) = rows.split_at_mut(rank + 1);
                let pivot_row = &head[rank];
                let inverse = roots.inverse(&pivot_row[column]);
                for row in tail {
                    if row[column].is_zero() {
                        continue;
                    }
                    let factor = roots.times(&row[column], &inverse).negated();
                    for j in column..columns {
                        let product = roots.times(&factor, &pivot_row[j]);
                        row[j] = roots.plus(&[row[j].clone(), product]);
                    }
                }
                rank += 1;
            }
            rank
        })
    }
}

//! Linear algebra over fingerprints: what holds for almost all values of the symbols.
//!
//! Values may contain roots, whose products need the laws of these; that is why elimination is not that of `echelon`.

use crate::graph::expr::Expr;
use crate::graph::graph::Graph;
use crate::graph::node::Atom;
use crate::identity::blocks::independent_blocks;
use crate::identity::fingerprint::Fingerprint;
use crate::identity::roots::Value;

impl Graph {
    /// Rank of a matrix of expressions, given by its rows, at almost all values of the symbols.
    pub fn generic_rank<'g>(&'g self, rows: &[Vec<Expr<'g>>]) -> usize {
        let entries = |row: &Vec<Expr<'g>>| (0..row.len()).filter(|&j| !row[j].is_zero()).collect();
        let entries: Vec<Vec<usize>> = rows.iter().map(entries).collect();
        let blocks = independent_blocks(rows.first().map_or(0, Vec::len), &entries);
        blocks.iter().map(|(i, j)| self.rank_of_block(rows, i, j)).sum()
    }

    /// The rank of some rows and columns of a matrix.
    fn rank_of_block<'g>(&'g self, rows: &[Vec<Expr<'g>>], of_rows: &[usize], of_columns: &[usize]) -> usize {
        self.with(|dag| {
            let value = |x: &Expr<'g>| match x.atom() {
                Atom::Constant(c) => Fingerprint::constant(c).into(),
                Atom::Node(id) => dag.value(id),
            };
            let row = |&i: &usize| of_columns.iter().map(|&j| value(&rows[i][j])).collect();
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

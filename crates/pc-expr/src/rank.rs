//! Linear algebra over fingerprints: what holds for almost all values of the symbols.

use crate::dag::Atom;
use crate::expr::Expr;
use crate::fingerprint::{Fingerprint, First};
use crate::graph::Graph;

impl Graph {
    /// Rank of a matrix of expressions, given by its rows, at almost all values of the symbols.
    pub fn generic_rank<'g>(&'g self, rows: &[Vec<Expr<'g>>]) -> usize {
        let mut rows: Vec<Vec<First>> = self.with(|dag| {
            let value = |x: &Expr<'g>| match x.atom() {
                Atom::Constant(c) => Fingerprint::constant(c).first(),
                Atom::Node(id) => dag.fingerprint(id).first(),
            };
            rows.iter().map(|row| row.iter().map(value).collect()).collect()
        });
        let columns = rows.first().map_or(0, Vec::len);
        let mut rank = 0;
        for column in 0..columns {
            let Some(pivot) = (rank..rows.len()).find(|&r| rows[r][column] != First::ZERO) else {
                continue;
            };
            rows.swap(rank, pivot);
            let (head, tail) = rows.split_at_mut(rank + 1);
            let pivot_row = &head[rank];
            let inverse = pivot_row[column].inverse();
            for row in tail {
                let factor = row[column] * inverse;
                for j in column..columns {
                    row[j] = row[j] - factor * pivot_row[j];
                }
            }
            rank += 1;
        }
        rank
    }
}

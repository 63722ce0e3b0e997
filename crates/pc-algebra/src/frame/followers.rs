//! Coordinates that follow others, such as the height z of a point on a curve z = f(x).

use std::collections::BTreeMap;

use pc_expr::{Expr, Graph};

use crate::frame::frame::Frame;
use crate::identity::sample::Neighbourhood;

/// The number of points at which rows are compared numerically before a quotient is formed.
const POINTS: usize = 2;

/// The relative difference within which the quotients of entries of two proportional rows agree, despite
/// rounding errors.
const SAME: f64 = 1e-9;

impl<'g> Frame<'g> {
    /// Whether coordinate i follows another: its row of b is zero, or is f times the row of a coordinate j
    /// that does not follow any other, with an f that is defined wherever row i is. So ẋ_i contains no more
    /// information about η than ẋ_j does.
    ///
    /// On the circle, x' = −y ω and y' = x ω, neither follows the other: −y/x has no value at x = 0.
    pub(crate) fn followers(&self) -> Vec<bool> {
        let (graph, b) = (self.graph(), self.b());
        let entries = b.nonzero_entries();
        let near = Neighbourhood::anywhere(graph, &entries);
        let samples = near.samples(graph, &entries, POINTS);
        let mut places = 0..0;
        let rows: Vec<Row<'g>> = (0..b.rows())
            .map(|i| {
                let (columns, entries): (Vec<usize>, Vec<Expr<'g>>) = b.nonzero(i).unzip();
                places = places.end..places.end + columns.len();
                let samples = samples.iter().map(|sample| sample[places.clone()].to_vec()).collect();
                Row { columns, entries, samples }
            })
            .collect();
        let mut alike: BTreeMap<&[usize], Vec<usize>> = BTreeMap::new();
        for (i, row) in rows.iter().enumerate() {
            alike.entry(&row.columns).or_default().push(i);
        }
        let mut follows = vec![false; rows.len()];
        for (i, row) in rows.iter().enumerate().rev() {
            let leads = |&j: &usize| {
                j != i && !follows[j] && row.may_follow(&rows[j]) && row.follows(&rows[j], graph, &near)
            };
            follows[i] = row.columns.is_empty() || alike[&*row.columns].iter().any(leads);
        }
        follows
    }
}

/// A row of b.
struct Row<'g> {
    /// The columns in which it has entries.
    columns: Vec<usize>,
    entries: Vec<Expr<'g>>,
    /// The values of the entries at each point.
    samples: Vec<Vec<f64>>,
}

impl<'g> Row<'g> {
    /// Whether this row is numerically a multiple of another one with entries in the same columns.
    fn may_follow(&self, other: &Row<'g>) -> bool {
        self.samples.iter().zip(&other.samples).all(|(ours, theirs)| {
            let mut quotients = ours.iter().zip(theirs).filter(|(_, x)| **x != 0.0).map(|(y, x)| y / x);
            let first = quotients.next().unwrap_or(0.0);
            quotients.all(|quotient| (quotient - first).abs() <= SAME * first.abs())
        })
    }

    /// Whether this row is a regular multiple of another one with entries in the same columns.
    fn follows(&self, other: &Row<'g>, graph: &'g Graph, near: &Neighbourhood<'g>) -> bool {
        let pairs = || self.entries.iter().copied().zip(other.entries.iter().copied());
        let vanishes = |rest: Expr<'g>| rest.is_zero() || near.vanishes(graph, rest);
        let is_multiple = |factor: Expr<'g>| pairs().all(|(ours, theirs)| vanishes(ours - factor * theirs));
        pairs().any(|(ours, theirs)| {
            let factor = ours / theirs;
            graph.is_as_regular(factor, ours) && is_multiple(factor)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linear_algebra::matrix::Matrix;
    use pc_expr::Graph;

    fn followers<'g>(graph: &'g Graph, x: &[Expr<'g>], rows: &[&[Expr<'g>]]) -> Vec<bool> {
        let b = Matrix::from_fn(rows.len(), rows[0].len(), |i, s| rows[i][s]);
        let zeros = vec![Expr::ZERO; rows.len()];
        Frame::new(graph, graph.symbol("t"), x.to_vec(), b, zeros).unwrap().followers()
    }

    #[test]
    fn a_function_of_a_coordinate_follows_it() {
        let graph = Graph::new();
        let [x, y, z, c] = graph.symbols(["x", "y", "z", "c"]);
        let (a, slope) = (1.0 + x.square(), -x.sin());
        let rows: [&[Expr<'_>]; 4] =
            [&[Expr::ONE, a], &[Expr::ZERO, y.square()], &[slope, slope * a], &[Expr::ZERO, Expr::ZERO]];
        assert_eq!(followers(&graph, &[x, y, z, c], &rows), [false, false, true, true]);
    }

    /// Forty bodies on curves z = cos x, each with a coordinate that follows it; rows of different columns never meet.
    #[test]
    fn each_of_many_bodies_has_its_own_follower() {
        const BODIES: usize = 40;
        let graph = Graph::new();
        let names = |name: &str| (0..BODIES).map(|i| graph.symbol(&format!("{name}{i}"))).collect::<Vec<_>>();
        let (x, z) = (names("x"), names("z"));
        let row = |i: usize| {
            let entry = if i < BODIES { Expr::ONE } else { -x[i - BODIES].sin() };
            (0..BODIES).map(|s| if s == i % BODIES { entry } else { Expr::ZERO }).collect::<Vec<_>>()
        };
        let rows: Vec<Vec<Expr<'_>>> = (0..2 * BODIES).map(row).collect();
        let rows: Vec<&[Expr<'_>]> = rows.iter().map(Vec::as_slice).collect();
        let expected: Vec<bool> = (0..2 * BODIES).map(|i| i >= BODIES).collect();
        assert_eq!(followers(&graph, &[x.clone(), z].concat(), &rows), expected);
    }

    #[test]
    fn on_a_circle_neither_coordinate_follows_the_other() {
        let graph = Graph::new();
        let [x, y] = graph.symbols(["x", "y"]);
        assert_eq!(followers(&graph, &[x, y], &[&[-y], &[x]]), [false, false]);
    }

    #[test]
    fn one_of_two_mutual_followers_is_kept() {
        let graph = Graph::new();
        let [x, y] = graph.symbols(["x", "y"]);
        assert_eq!(followers(&graph, &[x, y], &[&[x], &[3.0 * x]]), [false, true]);
    }
}

//! Coordinates that follow others, such as the height z of a point on a curve z = f(x).

use pc_expr::Expr;

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
        let b = self.b();
        let near = Neighbourhood::anywhere(self.graph(), &b.entries());
        let samples = near.samples(self.graph(), &b.entries(), POINTS);
        let mut follows = vec![false; b.rows()];
        for i in (0..b.rows()).rev() {
            let leads = |j: usize| {
                j != i && !follows[j] && self.may_follow(i, j, &samples) && self.follows(i, j, &near)
            };
            follows[i] = b.row(i).iter().all(|entry| entry.is_zero()) || (0..b.rows()).any(leads);
        }
        follows
    }

    /// Whether row i is numerically a multiple of row j.
    fn may_follow(&self, i: usize, j: usize, samples: &[Vec<f64>]) -> bool {
        let (b, k) = (self.b(), self.operators());
        (0..k).all(|s| b[(i, s)].is_zero() == b[(j, s)].is_zero())
            && samples.iter().all(|sample| {
                let (ours, theirs) = (&sample[i * k..][..k], &sample[j * k..][..k]);
                let mut quotients = ours.iter().zip(theirs).filter(|(_, x)| **x != 0.0).map(|(y, x)| y / x);
                let first = quotients.next().unwrap_or(0.0);
                quotients.all(|quotient| (quotient - first).abs() <= SAME * first.abs())
            })
    }

    /// Whether row i is a regular multiple of row j, with zeros in the same columns.
    fn follows(&self, i: usize, j: usize, near: &Neighbourhood<'g>) -> bool {
        let (graph, b) = (self.graph(), self.b());
        let places = || (0..self.operators()).filter(|&s| !b[(j, s)].is_zero());
        let vanishes = |rest: Expr<'g>| rest.is_zero() || near.vanishes(graph, rest);
        let is_multiple = |factor: Expr<'g>| places().all(|s| vanishes(b[(i, s)] - factor * b[(j, s)]));
        places().any(|s| {
            let factor = b[(i, s)] / b[(j, s)];
            graph.is_as_regular(factor, b[(i, s)]) && is_multiple(factor)
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

//! Whether an expression is zero up to the rounding of its constants.
//!
//! Fingerprints treat rounded constants as exact. The components of a unit vector, each rounded, have
//! squares whose sum is not quite 1, so that terms multiplied by them do not seem to cancel. Numerical
//! values decide: a sum that is left over by rounding is small relative to its terms at every point; a
//! genuinely small value is about as large as the terms of its sum.

use crate::graph::evaluate::Scalar;
use crate::graph::expr::Expr;
use crate::graph::function::Function;
use crate::graph::graph::Graph;
use crate::identity::running_error::Weighed;

/// The orders of magnitude of the points: a sum that cancels at only one of them, such as √(1 + v²/c²) − 1 for
/// v far below c, is recognised as nonzero at another.
const SCALES: [f64; 5] = [1.0, 1e-3, 1e3, 1e-9, 1e9];
/// The number of points of each order of magnitude.
const POINTS: u32 = 4;
/// The least number of points with a value; all of them must agree.
const LEAST: usize = 4;
/// The greatest remainder that some thousand rounding errors leave in a sum that cancels, as a fraction of
/// its terms.
const ROUNDING: f64 = 1e-12;

impl Graph {
    /// Whether an expression is zero, or no more than the rounding error of its own operations at each of
    /// several points; false if too few points have values.
    pub(crate) fn is_rounding<'g>(&'g self, e: Expr<'g>) -> bool {
        if e.is_zero() {
            return true;
        }
        let symbols = self.symbols_of(&[e]);
        let has_pieces = self.applies(e, &symbols, Function::is_piecewise);
        let points = SCALES.into_iter().flat_map(|scale| (0..POINTS).map(move |point| (scale, point)));
        let values = points.filter_map(|(scale, point)| {
            let at = |(i, &symbol)| (symbol, Weighed::from_f64(scale * coordinate(point, i)));
            let values: Vec<(Expr<'g>, Weighed)> = (0..).zip(&symbols).map(at).collect();
            self.evaluate(&[e], &values).ok().map(|values| values[0])
        });
        let mut seen = 0;
        for value in values.filter(|value| value.is_known()) {
            // On one of several pieces it may be 0 and on another not.
            if value.rest() > ROUNDING || value.value == 0.0 && has_pieces {
                return false;
            }
            seen += 1;
        }
        seen >= LEAST
    }
}

/// Coordinate number `i` of a point, computed from multiples of the golden ratio: between 1/4 and 5/4, or, at
/// every other point, between −1 and 1.
fn coordinate(point: u32, i: u32) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_8;
    let part = (f64::from(i * POINTS + point + 1) * GOLDEN).fract();
    if point.is_multiple_of(2) { 0.25 + part } else { 2.0 * part - 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A direction, rounded.
    const AXIS: [f64; 3] = [-0.2531066546307534, 0.9475260893632749, 0.19527245416998262];

    #[test]
    fn what_rounded_constants_leave_is_rounding() {
        let graph = Graph::new();
        let [x, y, z] = graph.symbols(["x", "y", "z"]);
        let along = graph.sum([x, y, z].iter().zip(AXIS).map(|(&x, a)| a * x));
        let across =
            [x, y, z].map(Expr::square).into_iter().zip(AXIS).map(|(square, a)| (1.0 - a * a) * square);
        let mixed =
            [(x, y, 0, 1), (y, z, 1, 2), (z, x, 2, 0)].map(|(x, y, i, j)| -2.0 * AXIS[i] * AXIS[j] * x * y);
        // (a·r)² + |a × r|² − |r|², where the squares of a add up to 1.
        let zero = graph.sum(across.chain(mixed)) + along.square() - (x * x + y * y + z * z);
        assert!(!zero.is_zero() && graph.is_rounding(zero), "{zero}");
        assert!(graph.is_rounding(zero * (x + 1.0).exp()) && graph.is_rounding(x - x));
    }

    #[test]
    fn what_is_small_by_itself_is_not() {
        let graph = Graph::new();
        let [x, y] = graph.symbols(["x", "y"]);
        let small = [
            1e-9 * x,
            1e-9 * x * y + 1e-9 * x * y.sin(),
            Expr::from(1e-20),
            (1e-18 * x.square() + 1.0).sqrt() - 1.0, // 0 in numbers unless x is large
            (-(1e7 * x).square()).exp(),             // too small for numbers unless x is small
            (x - 1e3).step(x, 0.0) * y,              // 0 on one piece
            x + 1e-9 * y - 1e-9 * y.sin() - x.sin(), // x³/6 where x is small
        ];
        for small in small {
            assert!(!graph.is_rounding(small), "{small}");
        }
        // Without values nothing is known.
        assert!(!graph.is_rounding((-1.0 - x.square()).sqrt()));
    }
}

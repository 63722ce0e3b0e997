//! Whether two forms of one function have the same numerical values.
//!
//! Fingerprints treat rounded constants as exact: a divisor that is zero up to the rounding of its constants
//! does not count as zero. So (1.19² − 1.4161) divided by itself has the fingerprint of 1, but its numerical
//! value is noise.

use crate::graph::expr::Expr;
use crate::graph::graph::Graph;

/// The number of points at which values are compared.
const POINTS: u32 = 4;

/// The largest relative difference between two forms that rounding may cause, even with much cancellation in
/// one of them; quotients of rounding errors differ by as much as their own size.
const DIFFERENCE: f64 = 1e-6;

impl Graph {
    /// Whether the values of a form agree with those of `other` at some points where both have values.
    pub(crate) fn has_numbers_of<'g>(&'g self, form: Expr<'g>, other: Expr<'g>) -> bool {
        let symbols = self.symbols_of(&[form, other]);
        (0..POINTS).all(|point| {
            let values: Vec<(Expr<'g>, f64)> =
                (0..).zip(&symbols).map(|(i, &symbol)| (symbol, coordinate(point, i))).collect();
            let Ok(values) = self.evaluate(&[form, other], &values) else { return true };
            let (difference, size) = ((values[0] - values[1]).abs(), values[0].abs().max(values[1].abs()));
            !size.is_finite() || difference <= DIFFERENCE * size
        })
    }
}

/// Coordinate number `i` of a point: between 1/4 and 5/4, computed from multiples of the golden ratio.
fn coordinate(point: u32, i: u32) -> f64 {
    const GOLDEN: f64 = 0.618_033_988_749_894_8;
    0.25 + (f64::from(i * POINTS + point + 1) * GOLDEN).fract()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn functions_are_distinguished_by_their_values_where_they_have_any() {
        let graph = Graph::new();
        let x = graph.symbol("x");
        assert!(!graph.has_numbers_of(x, 1.001 * x));
        assert!(graph.has_numbers_of((x + 1.0).square(), x.square() + 2.0 * x + 1.0));
        assert!(graph.has_numbers_of((-x).sqrt(), (-x).log()));
    }
}

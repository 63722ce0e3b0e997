//! Numerical values of expressions at pseudo-random points, for tests that the graph cannot decide exactly.

use pc_expr::{Expr, Graph};

use crate::closure::TRIALS;

/// Values of symbols near which an expression is regular; symbols that are not listed are taken near 1.
#[derive(Clone, Debug, Default)]
pub struct Neighbourhood<'g> {
    /// Symbols and their values.
    pub centre: Vec<(Expr<'g>, f64)>,
}

impl<'g> Neighbourhood<'g> {
    /// Values of `outputs` at point number `index` of a fixed sequence (0 is the centre); `None` where one of
    /// them is not finite.
    pub(crate) fn sample(&self, graph: &'g Graph, outputs: &[Expr<'g>], index: u64) -> Option<Vec<f64>> {
        let symbols = graph.symbols_of(outputs);
        let mut random = Random(index);
        let values: Vec<(Expr<'g>, f64)> = symbols
            .into_iter()
            .map(|symbol| {
                let centre =
                    self.centre.iter().find(|(known, _)| *known == symbol).map_or(1.0, |&(_, value)| value);
                let reach = 0.1 + 0.2 * centre.abs();
                (symbol, if index == 0 { centre } else { centre + reach * random.next() })
            })
            .collect();
        let values = graph.evaluate(outputs, &values).ok()?;
        values.iter().all(|v| v.is_finite()).then_some(values)
    }

    /// The largest absolute value of the expressions at the centre and points near it where all are finite; infinity if
    /// there are none, 0 without expressions.
    pub fn largest(&self, graph: &'g Graph, expressions: &[Expr<'g>]) -> f64 {
        if expressions.is_empty() {
            return 0.0;
        }
        let samples = self.samples(graph, expressions, TRIALS);
        let largest = samples.iter().flatten().fold(0.0f64, |largest, value| largest.max(value.abs()));
        if samples.is_empty() { f64::INFINITY } else { largest }
    }

    /// Values at up to `count` points where all outputs are finite.
    pub(crate) fn samples(&self, graph: &'g Graph, outputs: &[Expr<'g>], count: usize) -> Vec<Vec<f64>> {
        (0..4 * count as u64).filter_map(|index| self.sample(graph, outputs, index)).take(count).collect()
    }
}

/// splitmix64, uniform in (−1, 1).
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

//! Finds the orders of magnitude of symbols in the units of the expressions.
//!
//! Rational functions look alike at any point. Other functions have a scale: exp(−(10⁷x)²) has vanished at x = 1, and √(1 +
//! 10⁻¹⁸x²) is 1 there; their character shows where x is of the order of 10⁻⁷ and 10⁹. There the
//! [commensurable](Graph::commensurable) terms of the expressions are of the same order.

use pc_expr::{Backend, Evaluator, Expr, Graph, Inputs, Program};

/// Two terms that differ by up to this many powers of ten are of the same order: neither is negligible beside
/// the other.
const ORDERS: f64 = 2.0;
/// The powers of ten by which a symbol is multiplied in a trial.
const STEPS: [f64; 12] = [1e1, 1e-1, 1e2, 1e-2, 1e3, 1e-3, 1e6, 1e-6, 1e9, 1e-9, 1e12, 1e-12];
/// The disorder assigned to a group without values: more than any powers of ten can cause.
const WITHOUT_VALUES: f64 = 1e6;

/// Values of the `symbols` at which the terms of the expressions are of the same order: the given values multiplied by
/// powers of ten; `None` if the given values are already suitable, or if no others are better. The symbols of
/// `numbers` keep their values; all other symbols are 1.
pub(crate) fn magnitudes<'g>(
    graph: &'g Graph,
    expressions: &[Expr<'g>],
    symbols: &[(Expr<'g>, f64)],
    numbers: &[(Expr<'g>, f64)],
) -> Option<Vec<f64>> {
    let mut terms = Terms::new(graph, expressions, symbols, numbers)?;
    let given: Vec<f64> = symbols.iter().map(|&(_, value)| value).collect();
    let mut best = (terms.disorder(&given), given.clone());
    // Each time the single step that reduces the disorder most, so that the symbol that is out of order moves, not those
    // beside it.
    for _ in 0..=2 * given.len() {
        let (before, from) = best.clone();
        if before == 0.0 {
            break;
        }
        for (place, step) in (0..given.len()).flat_map(|place| STEPS.map(|step| (place, step))) {
            let mut trial = from.clone();
            trial[place] *= step;
            let disorder = terms.disorder(&trial);
            if trial[place].is_normal() && disorder < best.0 {
                best = (disorder, trial);
            }
        }
        if best.0 == before {
            break;
        }
    }
    (best.1 != given).then_some(best.1)
}

/// Groups of terms as functions of symbols.
struct Terms {
    values: Evaluator,
    /// The numerical factors of the terms, group by group.
    factors: Vec<Vec<f64>>,
    /// The values of the symbols that do not change; these symbols come after those that change.
    fixed: Vec<f64>,
}

impl Terms {
    /// None if there are no groups.
    fn new<'g>(
        graph: &'g Graph,
        expressions: &[Expr<'g>],
        symbols: &[(Expr<'g>, f64)],
        numbers: &[(Expr<'g>, f64)],
    ) -> Option<Terms> {
        let groups = graph.commensurable(expressions);
        let factors = groups.iter().map(|group| group.iter().map(|&(q, _)| q).collect()).collect();
        let outputs: Vec<Expr<'g>> = groups.into_iter().flatten().map(|(_, term)| term).collect();
        let mut state: Vec<Expr<'g>> = symbols.iter().map(|&(symbol, _)| symbol).collect();
        let others = graph.symbols_of(&outputs).into_iter().filter(|symbol| !state.contains(symbol));
        let others: Vec<Expr<'g>> = others.collect();
        let number = |x: &Expr<'g>| numbers.iter().find(|(known, _)| known == x).map_or(1.0, |known| known.1);
        let fixed = others.iter().map(number).collect();
        state.extend(others);
        let inputs = Inputs { time: None, state, parameters: Vec::new() };
        let program = Program::new(graph, &inputs, &outputs).ok().filter(|_| !outputs.is_empty())?;
        Some(Terms { values: Evaluator::new(program, Backend::Interpreter), factors, fixed })
    }

    /// The sum Σ d² over the groups, where d is the number of powers of ten by which the largest and the smallest term
    /// differ beyond what is allowed; terms that vanish do not count.
    fn disorder(&mut self, symbols: &[f64]) -> f64 {
        let point = [symbols, &self.fixed].concat();
        let mut values = vec![f64::NAN; self.values.program().outputs_len()];
        self.values.eval(0.0, &point, &[], &mut values);
        let mut values = values.into_iter();
        let mut sum = 0.0;
        for factors in &self.factors {
            let sizes = factors.iter().zip(values.by_ref()).map(|(q, value)| (q * value).abs());
            let orders: Vec<f64> = sizes.filter(|&size| size != 0.0).map(f64::log10).collect();
            let spread = |orders: &[f64]| {
                let (least, most) = orders
                    .iter()
                    .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), &order| (a.min(order), b.max(order)));
                (most - least - ORDERS).max(0.0)
            };
            sum += match orders.iter().all(|order| order.is_finite()) {
                true if orders.is_empty() => 0.0,
                true => spread(&orders).powi(2),
                false => WITHOUT_VALUES,
            };
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arguments_and_terms_are_brought_to_one_order() {
        let graph = Graph::new();
        let [x, y] = graph.symbols(["x", "y"]);
        let of = |expression: Expr<'_>| {
            let order = |value: f64| value.log10().round();
            let found = magnitudes(&graph, &[expression], &[(x, 1.0), (y, 1.0)], &[]);
            found.map(|found| found.into_iter().map(order).collect::<Vec<_>>())
        };
        assert_eq!(of((-(1e7 * x).square()).exp() * y), Some(vec![-6.0, 0.0]), "up to 100 = (1e7 x)²");
        assert_eq!(of((1e-18 * x.square() + 1.0).sqrt()), Some(vec![9.0, 0.0]));
        assert_eq!(of((x + 1e9 * y).sin()), Some(vec![0.0, -9.0]));
        assert_eq!(of(x.sin() * y.exp() + 3.0), None);
        assert_eq!(of(1e7 * x * y), None, "it looks alike at any point");
    }
}

//! A symbol that was replaced is absent from the result.

use crate::common::{Bounded, Tree, trees};
use pc_expr::{Expr, Graph};
use proptest::prelude::*;

/// f with x and y replaced contains neither, and has the value of f at the replacements.
fn check<'g>(
    graph: &'g Graph,
    f: Expr<'g>,
    replacements: &[(Expr<'g>, Expr<'g>)],
    at: &[(Expr<'g>, f64)],
) -> f64 {
    let result = graph.substitute(&[f], replacements)[0];
    for (symbol, _) in replacements {
        assert!(!graph.symbols_of(&[result]).contains(symbol), "{symbol} is in {result}");
    }
    graph.evaluate(&[result], at).unwrap()[0]
}

#[test]
fn a_symbol_that_cancels_does_not_come_back() {
    let graph = Graph::new();
    let [x, y, v, u] = graph.symbols(["x", "y", "x'", "u"]);
    let point = [(x, 1.0), (y, 0.5), (u, 1.0)];
    assert_eq!(check(&graph, (x * v + y * v) / v, &[(v, u / y)], &point), 1.5);
    // No division, and no replacement of v at which a divisor vanishes.
    assert_eq!(check(&graph, (v + x).square() - v.square() - 2.0 * v * x, &[(v, u / y)], &point), 1.0);
    assert_eq!(check(&graph, ((v - x) * (v - x) * y) / (v - x).square(), &[(v, u / y)], &point), 0.5);
    assert_eq!(check(&graph, (v * v * x - v * x) / (v * (v - 1.0)), &[(v, u / y)], &point), 1.0);
    let f = v.sin().square() * x + v.cos().square() * x + y * v / v;
    assert_eq!(check(&graph, f, &[(v, u + y)], &point), 1.5);
}

/// Where every number changes the divisors, the new divisor vanishes only at unlikely places.
#[test]
fn a_symbol_that_cancels_is_replaced_by_a_regular_point() {
    for a in [-2.0, -1.0, 0.0, 0.5, 1.0, 2.0, 3.0] {
        let graph = Graph::new();
        let [x, y, v, u] = graph.symbols(["x", "y", "v", "u"]);
        let f = (v * v + v * x - v * y - x * y) / (v - y); // v + x
        let g = f - (v * v * x - x * y * y) / (x * (v + y)); // x + y
        let value = check(&graph, g, &[(v, u.exp())], &[(x, 0.75), (y, a), (u, 0.3)]);
        assert!((value - (0.75 + a)).abs() < 1e-12, "{value} at {a}"); // some ten roundings of numbers up to 4
    }
}

#[test]
fn symbols_may_be_exchanged() {
    let graph = Graph::new();
    let [x, y] = graph.symbols(["x", "y"]);
    assert_eq!(graph.substitute(&[x - 2.0 * y], &[(x, y), (y, x)]), [y - 2.0 * x]);
    assert_eq!(graph.substitute(&[x * x], &[(x, x + 1.0)]), [(x + 1.0).square()]);
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 500,
        rng_seed: prop::test_runner::RngSeed::Fixed(11),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// f = (g h − p h)/h and (g + h)² − h² − 2 g h with random h contain symbols that cancel.
    #[test]
    fn only_substituted_symbols_are_left(
        [g, p] in prop::array::uniform2(trees(2)),
        h in trees(3),
        value in trees(2),
        point in prop::array::uniform2(-2.0..2.0),
    ) {
        let graph = Graph::new();
        let symbols = graph.symbols(["x", "y", "z"]);
        let [g, p, h, value] = [g, p, h, value].map(|tree: Tree| tree.expr(&symbols));
        let z = symbols[2];
        let written = [(g * h - p * h) / h, (g + h).square() - h.square() - 2.0 * g * h];
        let plain = [g - p, g.square()];
        for (written, plain) in written.into_iter().zip(plain) {
            prop_assume!(!written.is_undefined() && !value.is_undefined());
            let result = graph.substitute(&[written], &[(z, value)])[0];
            prop_assume!(!result.is_undefined());
            if written.depends_on(z) {
                continue; // a root or an absolute value hides that h cancels
            }
            prop_assert!(!graph.symbols_of(&[result]).contains(&z), "{written} became {result}");
            let values = [0, 1].map(|i| (symbols[i], Bounded::exact(point[i])));
            let both = graph.evaluate(&[result, plain], &values);
            let [ours, plain] = both.unwrap()[..] else { unreachable!() };
            if ours.size().is_finite() && plain.size().is_finite() {
                let tolerance = 1e-12 * (ours.size() + plain.size());
                prop_assert!((ours.value - plain.value).abs() <= tolerance, "{written}: {ours:?}, {plain:?}");
            }
        }
    }
}

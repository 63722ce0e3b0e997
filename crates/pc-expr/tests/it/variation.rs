//! Programs with their equations of variation against derivatives of the graph.

use crate::common::{Bounded, trees};
use pc_expr::{Backend, Evaluator, Expr, Graph, Inputs, Program};
use proptest::prelude::*;

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 1500,
        rng_seed: prop::test_runner::RngSeed::Fixed(11),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// ṡ = (∂f/∂y) s + ∂f/∂p, with a column by the parameter and one by a start. The tape differentiates what the graph
    /// has rearranged, so that terms may cancel in another order: 1e4 roundings of their size are allowed.
    #[test]
    fn columns_change_as_the_graph_says(
        trees in prop::collection::vec(trees(3), 2),
        point in prop::array::uniform3(-2.0..2.0),
        columns in prop::array::uniform4(-1.0..1.0),
    ) {
        let graph = Graph::new();
        let symbols = graph.symbols(["x", "y", "p"]);
        let s = graph.symbols(["s1", "s2", "s3", "s4"]);
        let f: Vec<Expr> = trees.iter().map(|tree| tree.expr(&symbols)).collect();
        prop_assume!(f.iter().all(|e| !e.is_undefined()));
        let [x, y, p] = symbols;
        let inputs = Inputs { time: None, state: vec![x, y], parameters: vec![p] };
        let program = Program::new(&graph, &inputs, &f).unwrap().with_variation(&[Some(0), None]);
        let mut varied = Evaluator::new(program, Backend::Interpreter);
        let mut rates = [f64::NAN; 6];
        let state = [point[0], point[1], columns[0], columns[1], columns[2], columns[3]];
        varied.eval(0.0, &state, &[point[2]], &mut rates);
        prop_assume!(rates[..2].iter().all(|rate| rate.is_finite()));

        let mut expected = Vec::new();
        for (k, by_parameter) in [(0, 1.0), (2, 0.0)] {
            for row in &f {
                let slopes = graph.gradient(*row, &symbols);
                expected.push(slopes[0] * s[k] + slopes[1] * s[k + 1] + by_parameter * slopes[2]);
            }
        }
        prop_assume!(expected.iter().all(|e| !e.is_undefined()));
        let all = symbols.iter().zip(point).chain(s.iter().zip(columns));
        let values: Vec<(Expr, Bounded)> = all.map(|(&symbol, x)| (symbol, Bounded::exact(x))).collect();
        let references = graph.evaluate(&expected, &values).unwrap();
        for ((expr, ours), reference) in expected.iter().zip(&rates[2..]).zip(references) {
            if reference.error.is_finite() && reference.value.is_finite() && reference.size() < 1e100 {
                let tolerance = 1e4 * f64::EPSILON * reference.size();
                prop_assert!((ours - reference.value).abs() <= tolerance, "{expr}: {ours}, by the graph {reference:?}");
            }
        }
    }
}

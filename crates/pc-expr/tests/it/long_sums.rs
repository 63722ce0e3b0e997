//! Sums of many independent terms.

use pc_expr::Graph;

/// Each term becomes as short as it is alone, without leaving partial sums behind, whose n²/2 terms would
/// outweigh the rest of the graph.
#[test]
fn a_long_sum_is_shortened_part_by_part() {
    let nodes = |n: usize| {
        let graph = Graph::new();
        let [a, c] = graph.symbols(["a", "c"]);
        let x: Vec<_> = (0..n).map(|i| graph.symbol(&format!("x{i}"))).collect();
        let terms = x.iter().map(|&x| c * x * x + x * (c - c * a / 2.0));
        let sum = graph.sum(terms) / 2.0;
        let before = graph.len();
        let short = graph.shorten(&[sum], &x)[0];
        // The same function, with parts as short as each is alone.
        let alone = graph.shorten(&[(c * x[3] * x[3] + x[3] * (c - c * a / 2.0)) / 2.0], &x)[0];
        assert_eq!(short, sum);
        assert!(short.tree_cost() <= n as u32 * (alone.tree_cost() + 2), "{short}");
        graph.len() - before
    };
    let (few, many) = (nodes(100), nodes(400));
    assert!(many <= 4 * few + 16, "{few} nodes for 100 terms, {many} for 400");
}

/// The entries of a Jacobian are those of the gradients, in the same order, and substitution one by one gives
/// the same as substitution into all expressions at once.
#[test]
fn jacobian_entries_are_those_of_gradients() {
    let graph = Graph::new();
    let x: Vec<_> = (0..30).map(|i| graph.symbol(&format!("x{i}"))).collect();
    let functions: Vec<_> =
        (0..30).map(|i| x[i].sin() * x[(7 * i + 3) % 30] + x[(i + 1) % 30].max(x[(i + 5) % 30])).collect();
    let rows = graph.jacobian(&functions, &x);
    for (function, row) in functions.iter().zip(&rows) {
        let gradient = graph.gradient(*function, &x).into_iter().enumerate();
        assert_eq!(*row, gradient.filter(|(_, slope)| !slope.is_zero()).collect::<Vec<_>>());
    }
    let pairs: Vec<_> = (0..30).map(|i| (x[i], x[(i + 1) % 30] * 2.0)).collect();
    let put = graph.substitution(&pairs);
    let one_by_one: Vec<_> = functions.iter().map(|&f| put.apply(&[f])[0]).collect();
    assert_eq!(one_by_one, graph.substitute(&functions, &pairs));
}

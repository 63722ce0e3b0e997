//! Sums of many terms that have nothing to do with each other.

use pc_expr::Graph;

/// Each term stays as short as it is alone, and no sums of all but some of them are left behind: of n²/2 terms together these
/// would take more than all else.
#[test]
fn a_long_sum_is_shortened_part_by_part() {
    let nodes = |n: usize| {
        let graph = Graph::new();
        let [a, c] = graph.symbols(["a", "c"]);
        let x: Vec<_> = (0..n).map(|i| graph.symbol(&format!("x{i}"))).collect();
        // x² + 2 a x + a² is shorter as a square only in `a`; collected by x it stays as it is.
        let term = |&x| c * x * x + x * (a - a.square() / a) + x.sin().square() + x.cos().square();
        let sum = graph.sum(x.iter().map(term)) / 2.0;
        let before = graph.len();
        let short = graph.shorten(&[sum], &x)[0];
        let expected = graph.sum(x.iter().map(|&x| (c * x * x + 1.0) / 2.0));
        assert_eq!(short, expected);
        assert!(short.tree_cost() <= sum.tree_cost());
        graph.len() - before
    };
    let (few, many) = (nodes(100), nodes(400));
    assert!(many <= 4 * few + 16, "{few} nodes for 100 terms, {many} for 400");
}

/// The entries of a Jacobian are those of the gradients, in the same order, and what is put into many expressions one by one is
/// what is put into all at once.
#[test]
fn what_is_not_zero_is_what_gradients_have() {
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

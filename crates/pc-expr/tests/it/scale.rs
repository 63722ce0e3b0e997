//! Long sums, long products and deep nesting: linear growth, and no recursion along the depth.

use std::sync::Arc;

use pc_expr::{Expr, Folding, Graph, Inputs, Interpreter, Kernel, Program};

const MANY: usize = 100_000;

fn names<'g>(graph: &'g Graph, count: usize) -> Vec<Expr<'g>> {
    (0..count).map(|i| graph.symbol(&format!("x{i}"))).collect()
}

/// A thread with a stack too small for recursion over a deep expression.
fn on_a_small_stack(test: impl FnOnce() + Send + 'static) {
    std::thread::Builder::new().stack_size(512 << 10).spawn(test).unwrap().join().unwrap();
}

#[test]
fn a_running_sum_grows_linearly() {
    for folding in [Folding::ByValue, Folding::Structural] {
        let graph = Graph::with_folding(folding);
        let x = names(&graph, MANY);
        let running = x.iter().fold(Expr::ZERO, |sum, &x| sum + x);
        assert!(graph.len() <= 2 * MANY, "{} nodes", graph.len());
        let gradient = graph.gradient(running, &x);
        assert!(gradient.iter().all(|&d| d == Expr::ONE));
        assert!(graph.len() <= 2 * MANY, "differentiating a sum makes no nodes: {}", graph.len());

        let inputs = Inputs { time: None, state: x.clone(), parameters: vec![] };
        let program = Program::new(&graph, &inputs, &[running]).unwrap();
        assert_eq!(program.code().len(), MANY - 1);
        let mut value = [0.0];
        Interpreter::new(Arc::new(program)).eval(0.0, &vec![0.5; MANY], &[], &mut value);
        assert_eq!(value, [0.5 * MANY as f64]);
    }
}

#[test]
fn an_n_ary_sum_is_one_node() {
    let graph = Graph::new();
    let x = names(&graph, MANY);
    let before = graph.len();
    let sum = graph.sum(x.iter().copied());
    assert_eq!(graph.len(), before + 1);
    let backwards: Expr = x.iter().rev().copied().sum();
    assert_eq!(sum, backwards);
    let ones: Vec<(Expr, f64)> = x.iter().map(|&x| (x, 1.0)).collect();
    assert_eq!(graph.evaluate(&[sum], &ones).unwrap(), [MANY as f64]);
    assert_eq!(graph.dot(x.iter().copied(), x.iter().copied()).derivative(x[7]), 2.0 * x[7]);
    assert!((sum - backwards).is_zero());
    assert!(sum.to_string().starts_with("x0 + x1 + "));
}

/// All operations that walk over an expression.
fn walk(graph: &Graph, deep: Expr<'_>, x: Expr<'_>) {
    let gradient = graph.gradient(deep, &[x])[0];
    let forward = deep.derivative(x);
    let [substituted] = graph.substitute(&[deep], &[(x, 0.25.into())])[..] else { unreachable!() };
    assert!(substituted.constant().is_some());
    let values = graph.evaluate(&[deep, gradient, forward], &[(x, 0.25)]).unwrap();
    assert!(values.iter().all(|v| v.is_finite()));
    assert!((values[1] - values[2]).abs() <= 1e-9 * values[1].abs());
    let text = deep.to_string();
    // Complete, with each part written once.
    assert!(!text.contains('…') && text.len() < 40 * graph.len(), "{} characters", text.len());
    assert!(deep.tree_cost() > 1000);
    assert_eq!(graph.symbols_of(&[deep]), [x]);

    let inputs = Inputs { time: None, state: vec![x], parameters: vec![] };
    let program = Program::new(graph, &inputs, &[deep, gradient]).unwrap();
    let mut out = [0.0; 2];
    let mut kernel = Interpreter::new(Arc::new(program));
    kernel.eval(0.0, &[0.25], &[], &mut out);
    assert!((out[0] - values[0]).abs() <= 1e-12 * values[0].abs());
    let error = kernel.diagnose(0.0, &[f64::NAN], &[]).unwrap().to_string();
    assert_eq!(error, "the values given are not finite: x = NaN");
}

#[test]
fn a_tower_of_sines_costs_no_stack() {
    on_a_small_stack(|| {
        let graph = Graph::new();
        let x = graph.symbol("x");
        let deep = (0..MANY).fold(x, |e, _| e.sin());
        assert_eq!(graph.len(), MANY + 1);
        walk(&graph, deep, x);
        assert!(graph.len() <= 6 * MANY, "{} nodes", graph.len());
    });
}

#[test]
fn an_iterated_square_costs_no_stack() {
    on_a_small_stack(|| {
        for folding in [Folding::ByValue, Folding::Structural] {
            let graph = Graph::with_folding(folding);
            let x = graph.symbol("x");
            let deep = (0..MANY / 5).fold(x, |e, _| e * e - 0.5);
            walk(&graph, deep, x);
            assert!(graph.len() <= 15 * MANY / 5, "{} nodes", graph.len());
        }
    });
}

#[test]
fn forms_found_late_cost_no_stack() {
    // Each c is a quotient of the one before; the short forms c + 1 are found from the top down, so that each
    // of them replaces a node that the next one uses.
    on_a_small_stack(|| {
        let graph = Graph::new();
        let y = graph.symbol("y");
        let mut chain = vec![graph.symbol("x")];
        for _ in 0..20_000 {
            let c = chain[chain.len() - 1];
            chain.push((y * c + y) / y);
        }
        for i in (1..chain.len()).rev() {
            assert_eq!(chain[i], chain[i - 1] + 1.0);
        }
        let top = chain[chain.len() - 1];
        let value = graph.evaluate(&[top + y, top * y], &[(chain[0], 1.0), (y, 2.0)]).unwrap();
        assert_eq!(value, [20_003.0, 40_002.0]);
    });
}

#[test]
fn a_long_product_and_its_gradient() {
    for folding in [Folding::ByValue, Folding::Structural] {
        let graph = Graph::with_folding(folding);
        let x = names(&graph, 1000);
        let product = x.iter().fold(Expr::ONE, |product, &x| product * x);
        let gradient = graph.gradient(product, &x);
        assert!(graph.len() < 10_000, "{} nodes", graph.len());
        let values: Vec<(Expr, f64)> =
            x.iter().enumerate().map(|(i, &x)| (x, if i == 3 { 2.0 } else { 1.0 })).collect();
        let gradient = graph.evaluate(&gradient, &values).unwrap();
        assert!(gradient.iter().enumerate().all(|(i, &d)| d == if i == 3 { 1.0 } else { 2.0 }));
    }
}

#[test]
fn partial_sums_inside_functions_grow_linearly() {
    let graph = Graph::new();
    let x = names(&graph, 300);
    let mut angle = Expr::ZERO;
    let mut total = Expr::ZERO;
    for &x in &x {
        angle += x;
        total += angle.sin() * angle.cos();
    }
    assert!(graph.len() < 10 * 300, "{} nodes", graph.len());
    assert!(!total.derivative(x[0]).is_zero());
}

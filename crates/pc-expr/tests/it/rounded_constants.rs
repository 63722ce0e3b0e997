//! Programs of expressions from which a symbol cancels, where constants are rounded.

use pc_expr::{Expr, ExprError, Function, Graph, Inputs, Program};

/// A direction of three components, rounded.
const AXIS: [f64; 3] = [-0.2531066546307534, 0.9475260893632749, 0.19527245416998262];

/// (a·r)² less its terms one by one, whose factors are rounded.
fn zero<'g>(graph: &'g Graph, r: [Expr<'g>; 3]) -> Expr<'g> {
    let along = graph.sum((0..3).map(|i| AXIS[i] * r[i]));
    let squares = (0..3).map(|i| -AXIS[i] * AXIS[i] * r[i].square());
    let products = [(0, 1), (1, 2), (2, 0)].into_iter().map(|(i, j)| -2.0 * AXIS[i] * AXIS[j] * r[i] * r[j]);
    graph.sum(squares.chain(products)) + along.square()
}

#[test]
fn a_symbol_whose_coefficient_is_rounding_is_not_needed() {
    let graph = Graph::new();
    let symbols @ [x, y, w, z] = graph.symbols(["x", "y", "w", "z"]);
    let idle = (z + z.square() * y) * zero(&graph, [x, y, w]);
    assert!(idle.depends_on(z), "by its fingerprint");
    let value = x.sin() + y + idle;
    let inputs = Inputs { time: None, state: vec![x, y, w], parameters: Vec::new() };
    let [written] = graph.written_in(&[value], &inputs.state)[..] else { panic!("one for one") };
    assert_eq!(written, x.sin() + y);
    assert!(Program::new(&graph, &inputs, &[value, idle / x.exp()]).is_ok());
    let inputs = Inputs { time: None, state: symbols.to_vec(), parameters: Vec::new() };
    assert!(Program::new(&graph, &inputs, &[value]).is_ok());
}

#[test]
fn a_symbol_with_a_small_coefficient_is_needed() {
    let graph = Graph::new();
    let [x, y, w, z] = graph.symbols(["x", "y", "w", "z"]);
    let inputs = Inputs { time: None, state: vec![x, y, w], parameters: Vec::new() };
    let idle = z * zero(&graph, [x, y, w]);
    let needed = [
        x + 1e-9 * z,
        1e9 * x + 1e-30 * z * y,
        x + idle + 1e-9 * z * w.sin(),
        (x + 1e-9 * z).cos() * y + idle,
        x + (y - 1e3).step(z, 0.0), // where y is large
    ];
    for value in needed {
        let refused = Program::new(&graph, &inputs, &[value]);
        assert!(matches!(&refused, Err(ExprError::UnboundSymbol { symbol }) if symbol == "z"), "{value}");
    }
}

/// The derivatives are zero where there are any, the values are not the same on all pieces.
#[test]
fn a_symbol_on_which_values_jump_is_needed() {
    let graph = Graph::new();
    let [x, y, z] = graph.symbols(["x", "y", "z"]);
    let inputs = Inputs { time: None, state: vec![x, y], parameters: Vec::new() };
    let sum = ((x + z) / (1.0 - x * z)).atan() - x.atan() - z.atan();
    let jumping = [
        z.tan().atan() - z,
        z.square().sqrt() / z,
        sum,
        Expr::apply(Function::Sign, &[z - y]) * x,
        z.step(1.0, 0.0),
    ];
    for value in jumping {
        assert!(value.derivative(z).is_zero(), "{value}");
        let refused = Program::new(&graph, &inputs, &[x + value]);
        assert!(matches!(&refused, Err(ExprError::UnboundSymbol { symbol }) if symbol == "z"), "{value}");
    }
}

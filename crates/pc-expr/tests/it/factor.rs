//! Factors of parameters moved to where they cost nothing: the same values, with fewer operations.

use std::sync::Arc;

use pc_expr::{Expr, Graph, Inputs, Instruction, Interpreter, Kernel, Program};

fn run(program: &Program, t: f64, state: &[f64], parameters: &[f64]) -> Vec<f64> {
    let mut values = vec![f64::NAN; program.outputs_len()];
    Interpreter::new(Arc::new(program.clone())).eval(t, state, parameters, &mut values);
    values
}

/// The outputs of both parts, which are those of the whole but for rounding; the operations of the second.
fn check(program: &Program, state: &[f64], parameters: &[f64]) -> usize {
    let (first, second) = program.factored();
    let numbers = run(&first, f64::NAN, &[], parameters);
    let found = run(&second, 0.9, state, &numbers);
    for (found, expected) in found.iter().zip(run(program, 0.9, state, parameters)) {
        assert!((found - expected).abs() <= 1e-14 * (1.0 + expected.abs()), "{found}, not {expected}");
    }
    second.cost().total()
}

#[test]
fn a_top_takes_as_many_operations_as_by_hand() {
    let graph = Graph::new();
    let [a, b, c, mg, r1, r2, r3] = graph.symbols(["A", "B", "C", "mg", "r1", "r2", "r3"]);
    let state = graph.symbols(["g1", "g2", "g3", "w1", "w2", "w3"]);
    let [g1, g2, g3, w1, w2, w3] = state;
    let inputs = Inputs { time: None, state: state.to_vec(), parameters: vec![a, b, c, mg, r1, r2, r3] };
    let outputs = [
        g2 * w3 - g3 * w2,
        g3 * w1 - g1 * w3,
        g1 * w2 - g2 * w1,
        -((c - b) * w2 * w3 - mg * (r3 * g2 - r2 * g3)) / a,
        (mg * (r1 * g3 - r3 * g1) - (a - c) * w3 * w1) / b,
        -((b - a) * w1 * w2 + mg * (r1 * g2 - r2 * g1)) / c,
    ];
    let program = Program::new(&graph, &inputs, &outputs).unwrap();
    let state = [0.3, -0.5, 0.8, 1.1, -0.7, 2.3];
    assert_eq!(check(&program, &state, &[2.0, 3.0, 4.0, 10.0, 0.1, 0.2, 0.3]), 18);
}

/// Values read twice, quotients both ways, functions, fixed terms of sums, fixed outputs and those that are inputs.
#[test]
fn both_parts_together_are_the_whole() {
    let graph = Graph::new();
    let [t, x, y, m, l] = graph.symbols(["t", "x", "y", "m", "l"]);
    let inputs = Inputs { time: Some(t), state: vec![x, y], parameters: vec![m, l] };
    let twice = (x * m + y * l) / m;
    let outputs: [Expr<'_>; 12] = [
        twice * twice + twice,
        -(x * m + l) / l,
        m / (x * l + 3.0) * l,
        (m / x - l / y) / m,
        -(-(x / y) * m - (x * l).sin() * l),
        (x * y * m - 2.5 * t) / l,
        -(x + y) * m,
        ((x - m) * l).cos() / m,
        m * l + m.sqrt(),
        x,
        m,
        2.5.into(),
    ];
    let program = Program::new(&graph, &inputs, &outputs).unwrap();
    let (_, second) = program.factored();
    assert!(check(&program, &[0.3, -0.7], &[1.7, 2.3]) <= program.cost().total());
    // What is left of divisions is by what the state determines.
    let parameters = second.first_result() - second.parameters_len()..second.first_result();
    for instruction in second.code() {
        if let Instruction::Divide(_, divisor) = instruction {
            let place = divisor.index();
            assert!(place >= second.first_input() && !parameters.contains(&place), "{instruction:?}");
        }
    }
}

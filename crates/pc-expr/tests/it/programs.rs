//! Programs and the interpreter against the graph they come from.

use std::sync::Arc;

use crate::common::{Bounded, Tree, trees};
use pc_expr::{Expr, ExprError, Graph, Inputs, Interpreter, Kernel, Program, compile};
use proptest::prelude::*;

fn kernel<'g>(graph: &'g Graph, state: &[Expr<'g>], outputs: &[Expr<'g>]) -> Interpreter {
    let inputs = Inputs { time: None, state: state.to_vec(), parameters: vec![] };
    Interpreter::new(Arc::new(Program::new(graph, &inputs, outputs).unwrap()))
}

fn run(kernel: &mut dyn Kernel, state: &[f64], count: usize) -> Vec<f64> {
    let mut out = vec![0.0; count];
    kernel.eval(0.0, state, &[], &mut out);
    out
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 1500,
        rng_seed: prop::test_runner::RngSeed::Fixed(4),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// Equal up to the rounding errors of terms: a program adds the positive terms of a sum first, divides by
    /// a product where the graph multiplies by negative powers, and squares repeatedly where the graph calls
    /// `powi`.
    #[test]
    fn the_interpreter_agrees_with_the_graph(trees in prop::collection::vec(trees(3), 3), point in prop::array::uniform3(-2.0..2.0)) {
        let graph = Graph::new();
        let symbols = graph.symbols(["x", "y", "z"]);
        let outputs: Vec<Expr> = trees.iter().map(|tree| tree.expr(&symbols)).collect();
        prop_assume!(outputs.iter().all(|e| !e.is_undefined()));
        let mut kernel = kernel(&graph, &symbols, &outputs);
        let out = run(&mut kernel, &point, outputs.len());
        let values: Vec<(Expr, Bounded)> = symbols.iter().zip(point).map(|(&s, x)| (s, Bounded::exact(x))).collect();
        for ((expr, ours), reference) in outputs.iter().zip(&out).zip(graph.evaluate(&outputs, &values).unwrap()) {
            if reference.error.is_finite() && reference.value.is_finite() {
                let tolerance = 10.0 * f64::EPSILON * reference.size();
                prop_assert!((ours - reference.value).abs() <= tolerance, "{expr}: {ours}, by the graph {reference:?}");
            }
        }
        match kernel.diagnose(0.0, &point, &[]) {
            None => prop_assert!(out.iter().all(|v| v.is_finite())),
            Some(ExprError::NotFinite { value, .. }) => prop_assert!(!value.is_finite()),
            Some(other) => prop_assert!(false, "{other}"),
        }
    }

    #[test]
    fn two_graphs_give_the_same_tape(trees in prop::collection::vec(trees(3), 3)) {
        let tape = || {
            let graph = Graph::new();
            let symbols = graph.symbols(["x", "y", "z"]);
            let mut outputs: Vec<Expr> = trees.iter().map(|tree: &Tree| tree.expr(&symbols)).collect();
            let gradient = graph.gradient(outputs[0], &symbols);
            outputs.extend(gradient);
            let inputs = Inputs { time: None, state: symbols.to_vec(), parameters: vec![] };
            let texts: Vec<String> = outputs.iter().map(ToString::to_string).collect();
            let program = Program::new(&graph, &inputs, &outputs).ok();
            let constants = |p: &Program| p.constants().iter().map(|c| c.to_bits()).collect::<Vec<u64>>();
            (texts, program.map(|p| (constants(&p), p.code().to_vec(), p.outputs().to_vec())))
        };
        prop_assert_eq!(tape(), tape());
    }
}

#[test]
fn the_innermost_expression_that_is_not_finite_is_named() {
    let graph = Graph::new();
    let [x, y, k] = graph.symbols(["x", "y", "k"]);
    let diagnose = |e: Expr<'_>, state: [f64; 2]| {
        let inputs = Inputs { time: Some(graph.symbol("t")), state: vec![x, y], parameters: vec![k] };
        let program = Program::new(&graph, &inputs, &[e]).unwrap();
        Interpreter::new(Arc::new(program)).diagnose(1.5, &state, &[2.0]).map(|error| error.to_string())
    };
    let state = "at t = 1.5, x = -1, y = 0";
    let message = |expression: &str, value: &str| Some(format!("`{expression}` is {value} {state}"));
    assert_eq!(diagnose(x.log().sin() + y, [-1.0, 0.0]), message("log(x)", "NaN"));
    assert_eq!(diagnose((x / y).exp() * k, [-1.0, 0.0]), message("x/y", "-inf"));
    assert_eq!(diagnose((x / (k * (x + y))).sqrt(), [-1.0, 0.0]), None);
    assert_eq!(diagnose(k / ((x + 1.0) * (k + y)) + x, [-1.0, 0.0]), message("k/((1 + x)*(y + k))", "inf"));
    assert_eq!(diagnose(k / ((x.sin() + k) * y), [-1.0, 0.0]), message("k/(y*(k + sin(x)))", "inf"));
    assert_eq!(diagnose((x - k).sqrt() - y, [-1.0, 0.0]), message("sqrt(x - k)", "NaN"));
    assert_eq!(diagnose(x + y, [-1.0, 0.0]), None);
    let deep = (0..40).fold(x, |e, i| (e + f64::from(i)).sin()).log() - (k + 30.0).exp().exp();
    let text = diagnose(deep, [-1.0, 0.0]).unwrap();
    assert!(text.starts_with("`exp(exp(30 + k))` is inf at "), "{text}");
    let deep = (0..40).fold(x, |e, _| (e / k).sin() - y).log();
    let text = diagnose(deep, [-1.0, 7.0]).unwrap();
    assert!(text.starts_with("`log(") && text.contains('…') && text.len() < 200, "{text}");
}

#[test]
fn input_values_that_are_not_finite_are_reported_as_such() {
    let graph = Graph::new();
    let [t, x, y, k] = graph.symbols(["t", "x", "y", "k"]);
    let inputs = Inputs { time: Some(t), state: vec![x, y], parameters: vec![k] };
    let program = Program::new(&graph, &inputs, &[(k * x).log(), y]).unwrap();
    let mut kernel = Interpreter::new(Arc::new(program));
    let (nan, inf) = (f64::NAN, f64::INFINITY);
    for (t, state, parameter, which) in [
        (nan, [nan, nan], 1.0, "t = NaN, x = NaN, y = NaN"),
        (0.0, [-1.0, inf], 1.0, "y = inf"),
        (0.0, [1.0, 2.0], -inf, "k = -inf"),
    ] {
        let error = kernel.diagnose(t, &state, &[parameter]).unwrap();
        assert_eq!(error.to_string(), format!("the values given are not finite: {which}"));
        assert!(
            matches!(error, ExprError::GivenNotFinite { given } if given.len() == which.split(',').count())
        );
    }
    let error = kernel.diagnose(0.0, &[-1.0, 0.0], &[1.0]).unwrap();
    assert_eq!(error.to_string(), "`log(x*k)` is NaN at t = 0, x = -1, y = 0");
}

#[test]
fn a_symbol_without_a_value_is_named() {
    let graph = Graph::new();
    let [x, y, z] = graph.symbols(["x", "y", "z"]);
    let inputs = Inputs { time: None, state: vec![x], parameters: vec![y] };
    let error = Program::new(&graph, &inputs, &[x, z.sin()]).unwrap_err();
    assert_eq!(error.to_string(), "the symbol `z` has no value");
    assert_eq!(graph.evaluate(&[y], &[(x, 1.0)]), Err(ExprError::UnboundSymbol { symbol: "y".into() }));
    assert!(Program::new(&graph, &inputs, &[z + x - z]).is_ok(), "what cancels needs no value");
    let undefined = Program::new(&graph, &inputs, &[x, y / (x - 2.0 * x + x)]).unwrap_err();
    assert_eq!(undefined, ExprError::DivisionByZero { dividend: "y".into() });
    assert!(Program::new(&graph, &inputs, &[x]).is_ok(), "only outputs count");
}

#[test]
fn trivial_outputs() {
    let graph = Graph::new();
    let [x, y] = graph.symbols(["x", "y"]);
    let mut constants = kernel(&graph, &[x], &[2.5.into(), Expr::ZERO, x - x, Expr::ratio(1, 3)]);
    assert_eq!(run(&mut constants, &[9.0], 4), [2.5, 0.0, 0.0, 1.0 / 3.0]);
    assert!(constants.program().code().is_empty());

    let none = kernel(&graph, &[x], &[]);
    assert_eq!(none.program().outputs_len(), 0);
    assert_eq!(run(&mut none.clone(), &[1.0], 0), [0.0; 0]);
    assert_eq!(run(&mut kernel(&graph, &[], &[]), &[], 0), [0.0; 0]);

    let mut repeated = kernel(&graph, &[x, y], &[x, x * y, y, x * y, x, -x]);
    assert_eq!(run(&mut repeated, &[2.0, 3.0], 6), [2.0, 6.0, 3.0, 6.0, 2.0, -2.0]);
    assert_eq!(repeated.program().code().len(), 2);
}

#[test]
fn forks_do_not_disturb_each_other() {
    let graph = Graph::new();
    let [x, y] = graph.symbols(["x", "y"]);
    let mut first = kernel(&graph, &[x, y], &[x * y.exp(), x / y]);
    let before = run(&mut first, &[2.0, 1.0], 2);
    let mut second = first.fork();
    drop(graph);
    let other = std::thread::spawn(move || run(second.as_mut(), &[5.0, -1.0], 2)).join().unwrap();
    assert_eq!(other, [5.0 * (-1.0f64).exp(), -5.0]);
    assert_eq!(run(&mut first, &[2.0, 1.0], 2), before);
}

#[test]
fn time_state_and_parameters_are_read_in_this_order() {
    let graph = Graph::new();
    let [t, x, y, k] = graph.symbols(["t", "x", "y", "k"]);
    let inputs = Inputs { time: Some(t), state: vec![y, x], parameters: vec![k] };
    let program = Program::new(&graph, &inputs, &[t + 10.0 * x + 100.0 * y + 1000.0 * k]).unwrap();
    assert_eq!(program.input_names(), ["t", "y", "x", "k"]);
    assert_eq!((program.state_len(), program.parameters_len(), program.outputs_len()), (2, 1, 1));
    let mut out = [0.0];
    Interpreter::new(Arc::new(program)).eval(1.0, &[3.0, 2.0], &[4.0], &mut out);
    assert_eq!(out, [4321.0]);
}

/// A value that is not finite in a branch not taken is neither an error nor named in one.
#[test]
fn a_branch_that_is_not_taken_is_not_blamed() {
    let graph = Graph::new();
    let [x, y] = graph.symbols(["x", "y"]);
    let inputs = Inputs { time: None, state: vec![x, y], parameters: Vec::new() };
    let guarded = x.step(x.log(), (-x).sqrt());
    let named = |value: Expr<'_>| {
        let program = Arc::new(Program::new(&graph, &inputs, &[value]).unwrap());
        let value = |kernel: &mut dyn Kernel| run(kernel, &[-4.0, 0.0], 1)[0].to_bits();
        let mut interpreter = Interpreter::new(Arc::clone(&program));
        assert_eq!(value(&mut interpreter), value(compile(program).as_mut()));
        interpreter.diagnose(0.0, &[-4.0, 0.0], &[]).map(|error| error.to_string())
    };
    assert_eq!(named(guarded), None);
    let error = named(guarded + 1.0 / y).unwrap();
    assert!(error.contains("1/y") && !error.contains("log"), "{error}");
}

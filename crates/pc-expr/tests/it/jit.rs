//! Compiled programs against interpreted ones.
#![cfg(feature = "jit")]

use std::sync::Arc;

use pc_expr::{
    Expr, Folding, Function, Graph, Inputs, Instruction, Interpreter, Jit, JitOptions, Kernel, Program,
    Register, compile,
};
use proptest::prelude::*;

use crate::random::SplitMix64;

/// Options for which compiled code gives the bits of the interpreter.
const EXACT: JitOptions =
    JitOptions { fma: false, inline_trig: false, registers: 14, chunk: 1000, leading: usize::MAX };
const STATE: usize = 4;
const PARAMETERS: usize = 3;

fn call<'g>(function: Function, x: Expr<'g>, y: Expr<'g>, z: Expr<'g>) -> Expr<'g> {
    match function {
        Function::Sin => x.sin(),
        Function::Cos => x.cos(),
        Function::Asin => x.asin(),
        Function::Acos => x.acos(),
        Function::Atan => x.atan(),
        Function::Atan2 => x.atan2(y),
        Function::Sinh => x.sinh(),
        Function::Cosh => x.cosh(),
        Function::Tanh => x.tanh(),
        Function::Exp => x.exp(),
        Function::Log => x.log(),
        Function::Sqrt => x.sqrt(),
        Function::Abs => x.abs(),
        Function::Sign => x.sign(),
        Function::Min => x.min(y),
        Function::Max => x.max(y),
        Function::Step => x.step(y, z),
        Function::Pow => x.pow(y),
    }
}

/// A program of random operations; `smooth` leaves out jumps and operations that amplify rounding.
fn random_program(random: &mut SplitMix64, size: usize, smooth: bool) -> Program {
    let graph = Graph::with_folding(Folding::Structural);
    let t = graph.symbol("t");
    let state = graph.symbols(["a", "b", "c", "d"]).to_vec();
    let parameters = graph.symbols(["p", "q", "r"]).to_vec();
    let mut values: Vec<Expr<'_>> = [t].into_iter().chain(state.clone()).chain(parameters.clone()).collect();
    values.extend([Expr::from(1.5), Expr::from(-0.3), Expr::from(2.0)]);
    while values.len() < size {
        // Recent values are preferred, so that programs become deep.
        let mut pick = || {
            let n = values.len();
            values[if random.below(3) == 0 { random.below(n) } else { n - 1 - random.below(n.min(12)) }]
        };
        let [x, y, z] = [pick(), pick(), pick()];
        let value = match random.below(if smooth { 9 } else { 12 }) {
            0 => x + y,
            1 => x - y,
            2 => (x * y).sin(),
            3 => x * y.cos() + z,
            4 => z - x * y.sin(),
            5 => (x * y + z).sin() - y.cos(),
            6 => -x,
            7 => (x - z).sin() * (x - z).cos(),
            8 => x * 0.5 - y.sin() * 0.25,
            9 => x / (y.square() + 1.25),
            10 => {
                // The sum may be zero only by chance: a divisor that is identically zero is an error.
                x / (y + graph.symbol("p") * 1.0625)
            }
            _ => call(Function::ALL[random.below(Function::ALL.len())], x, y, z),
        };
        if !value.is_undefined() {
            values.push(value);
        }
    }
    let outputs: Vec<Expr<'_>> =
        (0..1 + random.below(8)).map(|i| values[(values.len() - 1).saturating_sub(3 * i)]).collect();
    let inputs = Inputs { time: Some(t), state, parameters };
    Program::new(&graph, &inputs, &outputs).unwrap()
}

fn random_inputs(random: &mut SplitMix64) -> (f64, [f64; STATE], [f64; PARAMETERS]) {
    let scale = [0.5, 2.0, 20.0][random.below(3)];
    let mut number = || match random.below(40) {
        0 => 0.0,
        1 => -0.0,
        2 => 1.0,
        _ => random.uniform(-scale, scale),
    };
    (number(), std::array::from_fn(|_| number()), std::array::from_fn(|_| number()))
}

fn same(a: f64, b: f64) -> bool {
    a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan()
}

fn evaluate(kernel: &mut dyn Kernel, inputs: &(f64, [f64; STATE], [f64; PARAMETERS]), n: usize) -> Vec<f64> {
    let mut out = vec![f64::NAN; n];
    kernel.eval(inputs.0, &inputs.1, &inputs.2, &mut out);
    out
}

#[test]
fn exact_options_give_the_interpreters_bits() {
    let mut random = SplitMix64::new(1);
    let mut seen = std::collections::BTreeSet::new();
    for round in 0..60 {
        let program = random_program(&mut random, 20 + 12 * (round % 20), false);
        // A fused program rounds once in both kernels, too.
        for program in [program.clone(), program.fused()] {
            seen.extend(program.cost().iter().map(|(kind, _)| kind.to_owned()));
            let mut interpreter = Interpreter::new(Arc::new(program.clone()));
            let registers = [0, 1, 4, 14, u32::MAX][round % 5];
            let options = JitOptions { registers, ..EXACT };
            let mut jit = Jit::with_options(&program, &options).unwrap();
            for _ in 0..100 {
                let inputs = random_inputs(&mut random);
                let expected = evaluate(&mut interpreter, &inputs, program.outputs_len());
                let found = evaluate(&mut jit, &inputs, program.outputs_len());
                for (i, (e, f)) in expected.iter().zip(&found).enumerate() {
                    assert!(same(*e, *f), "round {round}, output {i}: {e} interpreted, {f} compiled");
                }
            }
        }
    }
    let kinds = ["add", "div", "fma", "mul", "neg", "sub"];
    for kind in kinds.into_iter().chain(Function::ALL.map(Function::name)) {
        assert!(seen.contains(kind), "no program contained {kind}");
    }
}

/// A value and a bound of its error: |computed − exact| of any of the kernels.
#[derive(Clone, Copy)]
struct Bounded {
    value: f64,
    error: f64,
}

/// Running error analysis of the tape: each operation propagates the errors of its operands by its
/// derivatives and adds its own rounding, half a unit in the last place, or 4 units for functions.
fn with_bounds(program: &Program, inputs: &(f64, [f64; STATE], [f64; PARAMETERS])) -> Vec<Bounded> {
    let exact = |value: f64| Bounded { value, error: 0.0 };
    let mut values: Vec<Bounded> = program.constants().iter().map(|&c| exact(c)).collect();
    values.push(exact(inputs.0));
    values.extend(inputs.1.iter().chain(&inputs.2).map(|&x| exact(x)));
    for instruction in program.code() {
        let get = |r: Register| values[r.index()];
        let product = |a: Bounded, b: Bounded| {
            let error = a.value.abs() * b.error + b.value.abs() * a.error + a.error * b.error;
            let value = a.value * b.value;
            Bounded { value, error: error + value.abs() * f64::EPSILON }
        };
        let sum = |a: Bounded, b: Bounded, sign: f64| {
            let value = a.value + sign * b.value;
            Bounded { value, error: a.error + b.error + value.abs() * f64::EPSILON }
        };
        values.push(match *instruction {
            Instruction::Add(a, b) => sum(get(a), get(b), 1.0),
            Instruction::Subtract(a, b) => sum(get(a), get(b), -1.0),
            Instruction::Multiply(a, b) => product(get(a), get(b)),
            Instruction::Divide(a, b) => {
                let (a, b) = (get(a), get(b));
                let value = a.value / b.value;
                let least = b.value.abs() - b.error;
                let error =
                    if least > 0.0 { (a.error + value.abs() * b.error) / least } else { f64::INFINITY };
                Bounded { value, error: error + value.abs() * f64::EPSILON }
            }
            Instruction::Negate(a) => Bounded { value: -get(a).value, error: get(a).error },
            Instruction::Call(function, args) => bounded_call(function, args.map(get)),
            other => unreachable!("{other:?} in a program that is not fused"),
        });
    }
    values
}

/// The variation of a function over the box of its arguments, from its values at the corners: the functions
/// are monotonic in each argument, or jump, where the bound is infinite.
fn bounded_call(function: Function, args: [Bounded; 3]) -> Bounded {
    let at = |signs: [f64; 3]| {
        let args: [f64; 3] = std::array::from_fn(|i| args[i].value + signs[i] * args[i].error);
        function.eval(&args)
    };
    let value = at([0.0; 3]);
    let [x, y, _] = args;
    let jumps = match function {
        Function::Sign | Function::Step => x.error > 0.0 && x.value.abs() <= x.error,
        Function::Atan2 => x.value.abs() <= x.error + 1e-300 && y.value <= y.error,
        Function::Pow => x.value <= x.error,
        _ => false,
    };
    let mut error = match function {
        Function::Sin | Function::Cos => x.error,
        Function::Cosh => x.error * (x.value.abs() + x.error).sinh(),
        _ => 0.0,
    };
    for corner in 0..8 {
        let signs = std::array::from_fn(|i| if corner >> i & 1 == 0 { -1.0 } else { 1.0 });
        let change = (at(signs) - value).abs();
        error = if change.is_nan() || jumps { f64::INFINITY } else { error.max(change) };
    }
    Bounded { value, error: 1.5 * error + 4.0 * value.abs() * f64::EPSILON }
}

#[test]
fn usual_options_stay_within_the_rounding_bound() {
    let mut random = SplitMix64::new(2);
    let (mut compared, mut skipped) = (0, 0);
    for round in 0..50 {
        let program = random_program(&mut random, 20 + 10 * (round % 20), false);
        let mut jit = Jit::new(&program).unwrap();
        for _ in 0..200 {
            let inputs = random_inputs(&mut random);
            let bounds = with_bounds(&program, &inputs);
            let found = evaluate(&mut jit, &inputs, program.outputs_len());
            for (register, found) in program.outputs().iter().zip(&found) {
                let Bounded { value, error } = bounds[register.index()];
                if value.is_finite() && error.is_finite() {
                    let bound = 2.0 * error + 1e-300;
                    assert!((found - value).abs() <= bound, "round {round}: {found} for {value} ± {error}");
                    compared += 1;
                } else {
                    skipped += 1;
                }
            }
        }
    }
    assert!(compared > 20_000 && skipped < compared, "{compared} compared, {skipped} skipped");
}

/// Sums, products, sines and cosines: relative to the largest value on the tape, which bounds every term.
#[test]
fn smooth_programs_agree_to_1e_13_of_the_largest_term() {
    let mut random = SplitMix64::new(3);
    for _ in 0..20 {
        let program = random_program(&mut random, 120, true);
        let mut jit = Jit::new(&program).unwrap();
        let mut interpreter = Interpreter::new(Arc::new(program.clone()));
        for _ in 0..500 {
            let mut number = || random.uniform(-2.0, 2.0);
            let inputs = (number(), std::array::from_fn(|_| number()), std::array::from_fn(|_| number()));
            let largest = with_bounds(&program, &inputs).iter().fold(1.0_f64, |l, b| l.max(b.value.abs()));
            let expected = evaluate(&mut interpreter, &inputs, program.outputs_len());
            let found = evaluate(&mut jit, &inputs, program.outputs_len());
            for (e, f) in expected.iter().zip(&found) {
                assert!((e - f).abs() <= 1e-13 * largest, "{f} for {e}, largest term {largest}");
            }
        }
    }
}

#[test]
fn every_function_has_the_interpreters_value_at_special_arguments() {
    let special = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        0.5,
        -3.0,
        1e-310,
        -1e-310,
        1e5,
        -1e5,
        1e300,
        f64::MIN_POSITIVE,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::NAN,
    ];
    let graph = Graph::new();
    let [x, y, z] = graph.symbols(["x", "y", "z"]);
    let inputs = Inputs { time: None, state: vec![x, y, z], parameters: vec![] };
    let mut outputs: Vec<Expr<'_>> = Function::ALL.iter().map(|&function| call(function, x, y, z)).collect();
    outputs.extend([x + y, x - y, x * y, x / y, -x, x * y + z, x * y - z, z - x * y, -x * y - z]);
    let program = Program::new(&graph, &inputs, &outputs).unwrap();
    for program in [program.clone(), program.fused()] {
        let mut jit = Jit::with_options(&program, &EXACT).unwrap();
        let mut interpreter = Interpreter::new(Arc::new(program.clone()));
        let (mut expected, mut found) = (vec![0.0; outputs.len()], vec![0.0; outputs.len()]);
        for x in special {
            for y in special {
                for z in special {
                    interpreter.eval(0.0, &[x, y, z], &[], &mut expected);
                    jit.eval(0.0, &[x, y, z], &[], &mut found);
                    for (i, (e, f)) in expected.iter().zip(&found).enumerate() {
                        let what = program.describe(program.outputs()[i]);
                        assert!(same(*e, *f), "{what} at {x}, {y}, {z}: {e} interpreted, {f} compiled");
                    }
                }
            }
        }
    }
}

#[test]
fn programs_without_operations_compile() {
    let graph = Graph::new();
    let t = graph.symbol("t");
    let [x, y, p] = graph.symbols(["x", "y", "p"]);
    let inputs = Inputs { time: Some(t), state: vec![x, y], parameters: vec![p] };
    let half = Expr::from(0.5);
    let cases: [(&[Expr<'_>], &[f64]); 5] = [
        (&[], &[]),
        (&[half, half], &[0.5, 0.5]),
        (&[t, p, x, y, x], &[7.0, 4.0, 2.0, 3.0, 2.0]),
        (&[x * y, x, x * y, half, x * y], &[6.0, 2.0, 6.0, 0.5, 6.0]),
        (&[x / (y - 3.0), (x * y).sqrt(), x * y], &[f64::INFINITY, 6.0_f64.sqrt(), 6.0]),
    ];
    for (outputs, expected) in cases {
        let program = Program::new(&graph, &inputs, outputs).unwrap();
        let mut jit = Jit::new(&program).unwrap();
        let mut found = vec![f64::NAN; expected.len()];
        jit.eval(7.0, &[2.0, 3.0], &[4.0], &mut found);
        assert_eq!(found, expected);
    }
    let nothing = Program::new(&graph, &Inputs::default(), &[]).unwrap();
    Jit::new(&nothing).unwrap().eval(0.0, &[], &[], &mut []);
}

/// A recurrence of `steps` steps with values that stay alive throughout: time, the state, early results.
fn long_program(steps: usize) -> Program {
    let graph = Graph::with_folding(Folding::Structural);
    let t = graph.symbol("t");
    let state = graph.symbols(["a", "b", "c", "d"]).to_vec();
    let parameters = graph.symbols(["p", "q", "r"]).to_vec();
    let mut early = Vec::new();
    let mut outputs = Vec::new();
    let [mut x, mut y] = [state[0], state[1]];
    for i in 0..steps {
        let c = Expr::from(0.3 + (i % 17) as f64 / 64.0);
        let z = x * c + y * parameters[i % 3] - state[i % 4] * 0.125;
        y = x - y * c * (if i % 50 == 0 { t } else { state[2] });
        x = if i % 25 == 0 { z.sin() + z.cos() } else { z * 0.5 };
        if i % 1000 == 7 {
            early.push(x * y);
        }
        if i % 5000 == 8 {
            outputs.push(x);
        }
    }
    outputs.extend([x, y, t, graph.sum(early.iter().copied()), early[0]]);
    let inputs = Inputs { time: Some(t), state, parameters };
    Program::new(&graph, &inputs, &outputs).unwrap()
}

#[test]
fn long_programs_are_cut_into_functions() {
    let program = long_program(10_000);
    assert!(program.code().len() > 70_000, "{} instructions", program.code().len());
    let inputs = (0.7, [0.4, -0.3, 0.2, 0.9], [0.5, -0.25, 0.125]);
    let expected = evaluate(&mut Interpreter::new(Arc::new(program.clone())), &inputs, program.outputs_len());
    for chunk in [1000, 3517] {
        let mut jit = Jit::with_options(&program, &JitOptions { chunk, ..EXACT }).unwrap();
        assert_eq!(evaluate(&mut jit, &inputs, program.outputs_len()), expected);
        // Slots are reused: there are far fewer than values.
        assert!(jit.scratch_len() > 0 && jit.scratch_len() < 5000, "{} slots", jit.scratch_len());
    }
}

/// Sines and cosines in line are so much code that far fewer of them make a function too long.
#[test]
fn many_circles_are_cut_into_functions() {
    let graph = Graph::new();
    let x = graph.symbol("x");
    let circles = (1..2000).map(|i| (x * f64::from(i)).sin() / f64::from(i) + (x * f64::from(i)).cos());
    let circles: Vec<Expr<'_>> = circles.collect();
    let inputs = Inputs { time: None, state: vec![x], parameters: vec![] };
    let program = Program::new(&graph, &inputs, &[graph.sum(circles)]).unwrap();
    let cut = |chunk: usize| {
        let mut value = [0.0];
        let options = JitOptions { chunk, ..JitOptions::default() };
        Jit::with_options(&program, &options).unwrap().eval(0.0, &[0.3], &[], &mut value);
        value
    };
    let mut expected = [0.0];
    Interpreter::new(Arc::new(program.clone())).eval(0.0, &[0.3], &[], &mut expected);
    assert_eq!(cut(100), cut(1000));
    // Two units in the last place of 4000 numbers of order one.
    assert!((cut(1000)[0] - expected[0]).abs() < 4000.0 * 2.0 * f64::EPSILON, "{expected:?}");
}

#[test]
fn threads_share_one_entry() {
    let program = long_program(300);
    let jit = Jit::new(&program).unwrap();
    let entry = jit.entry();
    std::thread::scope(|scope| {
        for thread in 0..8 {
            let (jit, program) = (&jit, &program);
            scope.spawn(move || {
                let mut random = SplitMix64::new(100 + thread);
                let mut kernel = jit.clone();
                let mut scratch = vec![f64::NAN; jit.scratch_len()];
                for _ in 0..500 {
                    let inputs = random_inputs(&mut random);
                    let expected = evaluate(&mut kernel, &inputs, program.outputs_len());
                    let mut found = vec![0.0; program.outputs_len()];
                    // SAFETY: the lengths are those of the program, and `jit` lives.
                    unsafe {
                        entry(
                            inputs.0,
                            inputs.1.as_ptr(),
                            inputs.2.as_ptr(),
                            found.as_mut_ptr(),
                            scratch.as_mut_ptr(),
                        );
                    }
                    assert!(expected.iter().zip(&found).all(|(e, f)| same(*e, *f)));
                }
            });
        }
    });
}

#[test]
fn forks_outlive_their_original() {
    let program = long_program(100);
    let inputs = (0.7, [0.4, -0.3, 0.2, 0.9], [0.5, -0.25, 0.125]);
    let mut original = Jit::new(&program).unwrap();
    let expected = evaluate(&mut original, &inputs, program.outputs_len());
    let mut fork = original.fork();
    drop(original);
    // Other code is compiled and freed, and may occupy freed memory.
    for steps in 1..20 {
        drop(Jit::new(&long_program(10 * steps)).unwrap());
    }
    assert_eq!(evaluate(&mut *fork, &inputs, program.outputs_len()), expected);
    let mut second = fork.fork();
    drop(fork);
    let found =
        std::thread::spawn(move || evaluate(&mut *second, &inputs, program.outputs_len())).join().unwrap();
    assert_eq!(found, expected);
}

#[test]
fn compile_gives_a_kernel_of_the_program() {
    let program = Arc::new(long_program(50));
    let inputs = (0.7, [0.4, -0.3, 0.2, 0.9], [0.5, -0.25, 0.125]);
    let expected = evaluate(&mut Interpreter::new(program.clone()), &inputs, program.outputs_len());
    let found = evaluate(&mut *compile(program.clone()), &inputs, program.outputs_len());
    for (e, f) in expected.iter().zip(&found) {
        assert!((e - f).abs() <= 1e-13 * e.abs().max(1.0), "{f} for {e}");
    }
}

#[test]
#[should_panic(expected = "length of the state")]
fn wrong_lengths_are_refused() {
    let graph = Graph::new();
    let [x, y] = graph.symbols(["x", "y"]);
    let inputs = Inputs { time: None, state: vec![x, y], parameters: vec![] };
    let program = Program::new(&graph, &inputs, &[x * y]).unwrap();
    Jit::new(&program).unwrap().eval(0.0, &[1.0], &[], &mut [0.0]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn any_option_gives_the_same_values(seed: u64, size in 10_usize..200, registers in 0_u32..40, far in -1e7..1e7) {
        let mut random = SplitMix64::new(seed);
        let program = random_program(&mut random, size, true);
        let mut reference = Jit::new(&program).unwrap();
        let options = JitOptions { registers, ..JitOptions::default() };
        let mut other = Jit::with_options(&program, &options).unwrap();
        let mut inputs = random_inputs(&mut random);
        inputs.1[1] = far; // some sines are computed in line, others by the library
        let expected = evaluate(&mut reference, &inputs, program.outputs_len());
        let found = evaluate(&mut other, &inputs, program.outputs_len());
        prop_assert!(expected.iter().zip(&found).all(|(e, f)| same(*e, *f)), "{expected:?} {found:?}");
    }
}

/// Outputs after the leading ones are at the start of the scratch memory, in one function or many, and the code says
/// whether all outputs are finite.
#[test]
fn leading_outputs_and_others_are_finite_or_not() {
    let graph = Graph::new();
    let [x, y] = graph.symbols(["x", "y"]);
    let inputs = Inputs { time: None, state: vec![x, y], parameters: vec![] };
    let outputs = [x, 1.0 / x, x * y, (x - y).sin(), 3.0.into(), y / x, x.exp(), y, x / y];
    let program = Program::new(&graph, &inputs, &outputs).unwrap();
    let mut interpreter = Interpreter::new(Arc::new(program.clone()));
    let states = [
        [0.5, -2.0],
        [0.0, 1.0],
        [1.0, 0.0],
        [f64::INFINITY, 1.0],
        [1.0, f64::NAN],
        [-750.0, 1e-300],
        [710.0, 1.0],
        [1e-300, 1e200],
    ];
    for chunk in [1, 3, 1000] {
        for leading in 0..=outputs.len() {
            let options = JitOptions { chunk, leading, ..EXACT };
            let mut jit = Jit::with_options(&program, &options).unwrap();
            for state in states {
                let mut expected = [0.0; 9];
                interpreter.eval(0.0, &state, &[], &mut expected);
                let all_finite = expected.iter().all(|output| output.is_finite());
                let mut first = vec![0.0; leading];
                let (others, finite) = jit.eval_leading(0.0, &state, &[], &mut first);
                let found = [&first, others].concat();
                let bits = |values: &[f64]| values.iter().map(|value| value.to_bits()).collect::<Vec<_>>();
                let is_same = |(a, b): (&f64, &f64)| a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan();
                assert!(found.iter().zip(&expected).all(is_same), "{state:?}, {leading} leading");
                assert_eq!(finite, all_finite, "{state:?}, {leading} leading");
                let mut whole = [0.0; 9];
                jit.eval(0.0, &state, &[], &mut whole);
                assert_eq!(bits(&whole), bits(&found), "{state:?}, {leading} leading");
                let (others, finite) = interpreter.eval_leading(0.0, &state, &[], &mut first);
                assert_eq!(bits(&[&first, others].concat()), bits(&expected));
                assert_eq!(finite, all_finite);
            }
        }
    }
}

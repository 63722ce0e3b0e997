//! Programs for many states at once give the same bits on every instruction set, in every lane, beside any
//! neighbours.

use std::sync::Arc;

use pc_expr::{
    Binary, Expr, Folding, Function, Fused, Graph, Inputs, InstructionSet, Interpreter, Kernel, LANES,
    LaneKernel, LaneTape, LaneValue, Lanes, Program,
};
use proptest::prelude::*;

use crate::double;
use crate::random::SplitMix64;

const SYMBOLS: usize = 8;

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

/// A program of (t, a … g) of random operations, with these functions.
fn random_program(random: &mut SplitMix64, size: usize, functions: &[Function]) -> Program {
    let graph = Graph::with_folding(Folding::Structural);
    let t = graph.symbol("t");
    let state = graph.symbols(["a", "b", "c", "d"]).to_vec();
    let parameters = graph.symbols(["e", "f", "g"]).to_vec();
    let mut values: Vec<Expr<'_>> = [t].into_iter().chain(state.clone()).chain(parameters.clone()).collect();
    values.extend([Expr::from(1.5), Expr::from(-0.3), Expr::from(2.0)]);
    while values.len() < size {
        // Recent values are preferred, so that programs become deep; early ones are used now and then, so
        // that they stay alive.
        let mut pick = || {
            let n = values.len();
            values[if random.below(3) == 0 { random.below(n) } else { n - 1 - random.below(n.min(12)) }]
        };
        let [x, y, z] = [pick(), pick(), pick()];
        let value = match random.below(10) {
            0 => x + y,
            1 => x - y,
            2 => x * y + z,
            3 => x * y - z,
            4 => z - x * y,
            5 => -z - x * y,
            6 => -x * y,
            7 => x / (y.square() + 1.25),
            _ => call(functions[random.below(functions.len())], x, y, z),
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

/// A program as a tape on rows of a frame that begins with its inputs.
fn tape(program: &Program) -> LaneTape {
    let mut tape = LaneTape::new();
    let t = tape.input();
    let state = tape.inputs(program.state_len());
    let parameters = tape.inputs(program.parameters_len());
    for value in tape.inline(program, t, &state, &parameters) {
        tape.output(value);
    }
    tape
}

fn random_number(random: &mut SplitMix64) -> f64 {
    match random.below(24) {
        0 => 0.0,
        1 => -0.0,
        2 => f64::INFINITY,
        3 => f64::NAN,
        4 => 1e-310,
        5 => -3e10, // out of the range that is computed in line
        6 => random.uniform(-1e300, 1e300),
        7..=12 => random.uniform(-20.0, 20.0),
        _ => random.uniform(-1.0, 1.0),
    }
}

fn random_lanes(random: &mut SplitMix64) -> Lanes {
    Lanes(std::array::from_fn(|_| random_number(random)))
}

fn same(a: f64, b: f64) -> bool {
    a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan()
}

fn kernels(tape: &LaneTape) -> Vec<LaneKernel> {
    let sets = InstructionSet::available();
    assert_eq!(sets.last(), Some(&InstructionSet::Portable));
    sets.into_iter().map(|set| LaneKernel::with_instructions(tape.clone(), set).unwrap()).collect()
}

/// The outputs of a kernel for these inputs.
fn run(kernel: &LaneKernel, inputs: &[Lanes], outputs: usize) -> Vec<Lanes> {
    let mut frame = kernel.frame();
    frame[..inputs.len()].copy_from_slice(inputs);
    kernel.run(&mut frame);
    frame[kernel.first_output()..][..outputs].to_vec()
}

/// The functions whose lane values are those of the library, exactly.
fn exact_functions() -> Vec<Function> {
    let apart = [Function::Sin, Function::Cos, Function::Exp, Function::Log, Function::Min, Function::Max];
    Function::ALL.into_iter().filter(|function| !apart.contains(function)).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, rng_seed: prop::test_runner::RngSeed::Fixed(5), ..ProptestConfig::default() })]

    #[test]
    fn all_sets_of_instructions_give_the_same_bits(seed in any::<u64>(), size in 12usize..400) {
        let mut random = SplitMix64::new(seed);
        let program = random_program(&mut random, size, &Function::ALL);
        let kernels = kernels(&tape(&program));
        for _ in 0..8 {
            let inputs: Vec<Lanes> = (0..SYMBOLS).map(|_| random_lanes(&mut random)).collect();
            let expected = run(&kernels[kernels.len() - 1], &inputs, program.outputs_len());
            for kernel in &kernels {
                let found = run(kernel, &inputs, program.outputs_len());
                for (e, f) in expected.iter().zip(&found) {
                    for lane in 0..LANES {
                        prop_assert!(same(e.0[lane], f.0[lane]),
                            "lane {lane} by {:?}: {} for {}", kernel.instructions(), f.0[lane], e.0[lane]);
                    }
                }
            }
        }
    }

    /// The interpreter runs the program one state at a time, by independent code.
    #[test]
    fn lanes_are_the_interpreters_numbers(seed in any::<u64>(), size in 12usize..300) {
        let mut random = SplitMix64::new(seed);
        let program = random_program(&mut random, size, &exact_functions());
        let kernel = LaneKernel::new(tape(&program));
        let mut interpreter = Interpreter::new(Arc::new(program.fused()));
        for _ in 0..8 {
            let inputs: Vec<Lanes> = (0..SYMBOLS).map(|_| random_lanes(&mut random)).collect();
            let found = run(&kernel, &inputs, program.outputs_len());
            for lane in 0..LANES {
                let x: Vec<f64> = inputs.iter().map(|row| row.0[lane]).collect();
                let mut expected = vec![0.0; program.outputs_len()];
                interpreter.eval(x[0], &x[1..5], &x[5..], &mut expected);
                for (e, f) in expected.iter().zip(&found) {
                    prop_assert!(same(*e, f.0[lane]), "lane {lane}: {} for {e}", f.0[lane]);
                }
            }
        }
    }

    /// Each lane, beside neighbours that are NaN, infinite or out of range.
    #[test]
    fn results_do_not_depend_on_lane_or_neighbours(seed in any::<u64>(), size in 12usize..200) {
        let mut random = SplitMix64::new(seed);
        let program = random_program(&mut random, size, &Function::ALL);
        for kernel in kernels(&tape(&program)) {
            let mine: Vec<f64> = (0..SYMBOLS).map(|_| random.uniform(-2.0, 2.0)).collect();
            let alone: Vec<Lanes> = mine.iter().map(|&x| Lanes::splat(x)).collect();
            let expected = run(&kernel, &alone, program.outputs_len());
            for lane in 0..LANES {
                let mut inputs: Vec<Lanes> = (0..SYMBOLS).map(|_| random_lanes(&mut random)).collect();
                for (row, &x) in inputs.iter_mut().zip(&mine) {
                    row.0[lane] = x;
                }
                let found = run(&kernel, &inputs, program.outputs_len());
                for (e, f) in expected.iter().zip(&found) {
                    prop_assert!(same(e.0[0], f.0[lane]), "lane {lane}: {} for {}", f.0[lane], e.0[0]);
                }
            }
        }
    }
}

/// A kernel of functions of one argument.
fn functions(expressions: impl Fn(Expr<'_>) -> Vec<Expr<'_>>) -> Vec<LaneKernel> {
    let graph = Graph::new();
    let x = graph.symbol("x");
    let inputs = Inputs { time: None, state: vec![x], parameters: vec![] };
    let program = Program::new(&graph, &inputs, &expressions(x)).unwrap();
    kernels(&tape(&program))
}

/// Eight arguments at a time by the fastest kernel.
fn values(kernel: &LaneKernel, arguments: &[f64], outputs: usize, mut f: impl FnMut(f64, &[f64])) {
    for chunk in arguments.chunks(LANES) {
        let mut x = Lanes::splat(1.0);
        x.0[..chunk.len()].copy_from_slice(chunk);
        let found = run(kernel, &[Lanes::splat(0.0), x], outputs);
        for (lane, &x) in chunk.iter().enumerate() {
            let values: Vec<f64> = found.iter().map(|row| row.0[lane]).collect();
            f(x, &values);
        }
    }
}

#[test]
fn sines_and_cosines_err_by_less_than_two_units() {
    let kernel = &functions(|x| vec![x.sin(), x.cos()])[0];
    let mut random = SplitMix64::new(7);
    let mut arguments: Vec<f64> =
        (0..200_000).map(|i| random.uniform(-1.0, 1.0) * [1.0, 4.0, 100.0, 1e5][i % 4]).collect();
    for n in 0..=127_323_u32 {
        let near = f64::from(n) * std::f64::consts::FRAC_PI_4;
        for neighbour in [-1_i64, 0, 1, 2] {
            let x = f64::from_bits((near.to_bits() as i64 + neighbour).max(0) as u64);
            arguments.push(if n % 2 == 0 { x } else { -x });
        }
    }
    arguments.extend([f64::MIN_POSITIVE, 5e-324, 1e-310, 1e-160]);
    let mut worst = [0.0_f64; 2];
    values(kernel, &arguments, 2, |x, found| {
        for (i, exact) in double::circle(x).into_iter().enumerate() {
            let error = double::error(found[i], exact);
            assert!(error <= 2.0, "{} of {x:e}: {error} units", ["sin", "cos"][i]);
            worst[i] = worst[i].max(error);
        }
    });
    // Far from zero the reference is accurate to 1e-22, so small results are left out.
    let far: Vec<f64> = (0..100_000).map(|_| random.uniform(-1e9, 1e9)).collect();
    values(kernel, &far, 2, |x, found| {
        for (i, exact) in double::circle(x).into_iter().enumerate() {
            if exact.0.abs() > 1e-3 {
                let error = double::error(found[i], exact);
                assert!(error <= 2.0, "{} of {x:e}: {error} units", ["sin", "cos"][i]);
            }
        }
    });
    println!("sin to {:.3} units, cos to {:.3}", worst[0], worst[1]);
}

#[test]
fn powers_and_logarithms_err_by_less_than_one_and_a_half_units() {
    let kernel = &functions(|x| vec![x.exp()])[0];
    let mut random = SplitMix64::new(8);
    let arguments: Vec<f64> = (0..200_000)
        .map(|i| random.uniform(-1.0, 1.0) * [1e-8, 0.5, 30.0, 700.0][i % 4])
        .chain((-2000..2000).map(|k| f64::from(k) * 0.5 * std::f64::consts::LN_2 * 0.7))
        .collect();
    let mut worst = [0.0_f64; 2];
    values(kernel, &arguments, 1, |x, found| {
        let (exact, n) = double::exp(x);
        // Exact, as the results are normal numbers.
        let scaled = found[0] * 2.0_f64.powi(-n / 2) * 2.0_f64.powi(-n - -n / 2);
        let error = double::error(scaled, exact);
        assert!(error <= 1.5, "exp {x:e}: {error} units");
        worst[0] = worst[0].max(error);
    });

    let kernel = &functions(|x| vec![x.log()])[0];
    let arguments: Vec<f64> = (0..200_000)
        .map(|i| match i % 3 {
            0 => random.uniform(0.5, 2.0),
            1 => random.uniform(0.0, 1e6),
            _ => f64::from_bits((1 + random.next_bits() % 2045) << 52 | random.next_bits() >> 12),
        })
        .filter(|x| *x >= f64::MIN_POSITIVE && *x != 1.0)
        .collect();
    values(kernel, &arguments, 1, |x, found| {
        let error = double::error(found[0], double::log(x));
        assert!(error <= 1.5, "log {x:e}: {error} units");
        worst[1] = worst[1].max(error);
    });
    println!("exp to {:.3} units, log to {:.3}", worst[0], worst[1]);
}

/// The values of the library at arguments with special cases.
#[test]
fn functions_have_the_librarys_values_at_special_arguments() {
    let special = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        0.5,
        5e-324,
        -5e-324,
        1e-310,
        f64::MIN_POSITIVE,
        -745.2,
        -746.5,
        -1e300,
        709.7,
        709.8,
        710.5,
        1e300,
        1.000_000_1e9,
        -1e22,
        f64::MAX,
        f64::INFINITY,
        f64::NEG_INFINITY,
        f64::NAN,
    ];
    let graph = Graph::new();
    let [x, y, z] = graph.symbols(["x", "y", "z"]);
    let inputs = Inputs { time: None, state: vec![x, y, z], parameters: vec![] };
    let outputs: Vec<Expr<'_>> = Function::ALL.iter().map(|&function| call(function, x, y, z)).collect();
    let program = Program::new(&graph, &inputs, &outputs).unwrap();
    for kernel in kernels(&tape(&program)) {
        let mut points = Vec::new();
        for x in special {
            for y in special {
                points.push([x, y, 0.25]);
            }
        }
        for chunk in points.chunks(LANES) {
            let mut rows = [Lanes::splat(0.0); 4];
            for (lane, point) in chunk.iter().enumerate() {
                (0..3).for_each(|i| rows[1 + i].0[lane] = point[i]);
            }
            let found = run(&kernel, &rows, outputs.len());
            for (lane, point) in chunk.iter().enumerate() {
                for (function, row) in Function::ALL.into_iter().zip(&found) {
                    let (found, expected) = (row.0[lane], function.eval(point));
                    let close = match function {
                        // Computed in line: within 1.5 units of the exact value, as is the library.
                        Function::Sin | Function::Cos | Function::Exp | Function::Log
                            if expected.is_finite() =>
                        {
                            (found - expected).abs() <= 3.0 * f64::EPSILON * expected.abs() + 5e-324
                                && found.is_sign_negative() == expected.is_sign_negative()
                        }
                        // The sign of the lesser or greater of two zeros is unspecified.
                        Function::Min | Function::Max => found == expected || same(found, expected),
                        _ => same(found, expected),
                    };
                    assert!(close, "{} at {point:?}: {found}, not {expected}", function.name());
                }
            }
        }
    }
}

/// More live values than any processor has registers, read in the order of their creation and in reverse.
#[test]
fn spilled_values_are_restored() {
    let mut tape = LaneTape::new();
    let inputs = tape.inputs(5);
    let mut values: Vec<LaneValue> = inputs.clone();
    for i in 0..300 {
        let (a, b) = (values[values.len() - 5], values[values.len() - 1]);
        let c = tape.constant(0.5 + f64::from(i) * 1e-3);
        let value = tape.fused(Fused::MultiplyAdd, a, c, b);
        let value =
            if i % 7 == 0 { tape.binary(Binary::Subtract, value, inputs[i as usize % 5]) } else { value };
        values.push(value);
    }
    let mut sum = tape.constant(0.0);
    for (i, &value) in values.iter().enumerate() {
        let c = tape.constant(1.0 + i as f64);
        sum = tape.fused(Fused::MultiplySubtract, value, c, sum);
    }
    for &value in values.iter().rev() {
        sum = tape.fused(Fused::NegateMultiplyAdd, value, values[17], sum);
    }
    for value in [sum, values[40], values[40], inputs[2], values[304]] {
        tape.output(value);
    }
    tape.replace(inputs[1], sum);
    tape.replace(inputs[3], values[200]);
    let kernels = kernels(&tape);
    let rows: Vec<Lanes> =
        (0..5).map(|i| Lanes(std::array::from_fn(|lane| 0.1 + (i * 8 + lane) as f64 * 0.01))).collect();
    let mut frames = kernels.iter().map(|kernel| {
        let mut frame = kernel.frame();
        frame[..5].copy_from_slice(&rows);
        kernel.run(&mut frame);
        frame.truncate(10);
        frame
    });
    let first = frames.next().unwrap();
    assert_eq!(first[1], first[5]);
    assert_eq!((first[6], first[8]), (first[7], rows[2]));
    assert_eq!((first[0], first[2]), (rows[0], rows[2]));
    assert!(first[3] != rows[3] && first[5].0.iter().all(|x| x.is_finite()));
    for frame in frames {
        assert_eq!(frame, first);
    }
}

/// A row is replaced once, by the former values of its lanes, even if one of them is out of range and all are
/// computed again.
#[test]
fn rows_are_replaced_by_what_was_read() {
    let graph = Graph::new();
    let x = graph.symbol("x");
    let inputs = Inputs { time: None, state: vec![x], parameters: vec![] };
    let program = Program::new(&graph, &inputs, &[x + x.sin()]).unwrap();
    let mut tape = LaneTape::new();
    let [t, x] = [tape.input(), tape.input()];
    let next = tape.inline(&program, t, &[x], &[])[0];
    tape.replace(x, next);
    for kernel in kernels(&tape) {
        let mut frame = kernel.frame();
        frame[1] = Lanes([0.5, 2e9, -1.0, 2.0, 0.1, 0.2, 0.3, f64::INFINITY]);
        let before = frame[1].0;
        kernel.run(&mut frame);
        for lane in 0..7 {
            let expected = before[lane] + before[lane].sin();
            assert!((frame[1].0[lane] - expected).abs() <= 2e-16 * expected.abs(), "lane {lane}");
        }
        assert!(frame[1].0[7].is_nan());
    }
}

/// More rows are replaced than any processor has registers, by values that nothing else reads any more.
#[test]
fn many_rows_are_replaced() {
    const ROWS: usize = 70;
    let mut tape = LaneTape::new();
    let inputs = tape.inputs(ROWS);
    let mut sum = tape.constant(0.25);
    let mut values = Vec::new();
    for &input in &inputs {
        sum = tape.fused(Fused::MultiplyAdd, input, input, sum);
        values.push(tape.binary(Binary::Add, sum, input));
    }
    for (&input, &value) in inputs.iter().zip(values.iter().rev()) {
        tape.replace(input, value);
    }
    let rows: Vec<Lanes> = (0..ROWS)
        .map(|i| Lanes(std::array::from_fn(|lane| 0.1 + (i * LANES + lane) as f64 * 0.01)))
        .collect();
    for kernel in kernels(&tape) {
        let mut frame = kernel.frame();
        frame[..ROWS].copy_from_slice(&rows);
        kernel.run(&mut frame);
        for lane in 0..LANES {
            let mut sum = 0.25_f64;
            for (row, replaced) in rows.iter().zip(frame[..ROWS].iter().rev()) {
                sum = row.0[lane].mul_add(row.0[lane], sum);
                assert_eq!(replaced.0[lane], sum + row.0[lane]);
            }
        }
    }
}

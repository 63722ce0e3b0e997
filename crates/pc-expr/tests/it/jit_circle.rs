//! Sines and cosines in line, against sums of two numbers (some 31 digits).
#![cfg(feature = "jit")]

use pc_expr::{Graph, Inputs, Jit, JitOptions, Kernel, Program};

use crate::double::{circle as reference, error};
use crate::random::SplitMix64;

/// Kernels of (sin x, cos x) for one argument and for two.
fn kernels() -> (Jit, Jit) {
    let graph = Graph::new();
    let [x, y] = graph.symbols(["x", "y"]);
    let compile = |state: &[_], outputs: &[_]| {
        let inputs = Inputs { time: None, state: state.to_vec(), parameters: vec![] };
        Jit::new(&Program::new(&graph, &inputs, outputs).unwrap()).unwrap()
    };
    (compile(&[x], &[x.sin(), x.cos()]), compile(&[x, y], &[x.sin(), x.cos(), y.sin(), y.cos()]))
}

fn for_each_argument(mut f: impl FnMut(f64)) {
    let mut random = SplitMix64::new(7);
    for i in 0..600_000 {
        f(random.uniform(-1.0, 1.0) * [1.0, 4.0, 100.0, 1e5][i % 4]);
        // Any exponent from the least to that of 10⁵.
        if i % 4 == 0 {
            let exponent = random.next_bits() % (1023 + 16);
            f(f64::from_bits(random.next_bits() >> 63 << 63 | exponent << 52 | random.next_bits() >> 12));
        }
    }
    // The numbers around every multiple of π/4.
    for n in 0..=127_323_u32 {
        let near = f64::from(n) * std::f64::consts::FRAC_PI_4;
        for neighbour in [-1_i64, 0, 1, 2] {
            let x = f64::from_bits((near.to_bits() as i64 + neighbour).max(0) as u64);
            if x <= 1e5 {
                f(if n % 2 == 0 { x } else { -x });
            }
        }
    }
    for x in [f64::MIN_POSITIVE, 5e-324, 1e-310, 1e-160, 1e5, 99_999.999_999] {
        f(x);
        f(-x);
    }
}

#[test]
fn errors_stay_below_two_units() {
    let (mut single, mut double) = kernels();
    let mut worst = [(0.0, 0.0); 2];
    let (mut count, mut previous) = (0, 0.5);
    for_each_argument(|x| {
        let (mut one, mut two) = ([0.0; 2], [0.0; 4]);
        single.eval(0.0, &[x], &[], &mut one);
        double.eval(0.0, &[previous, x], &[], &mut two);
        assert_eq!(one, two[2..], "one lane and two at {x:e}");
        for (i, exact) in reference(x).into_iter().enumerate() {
            let error = error(one[i], exact);
            assert!(error <= 2.0, "{} of {x:e}: {error} units", ["sin", "cos"][i]);
            if error > worst[i].0 {
                worst[i] = (error, x);
            }
        }
        previous = x;
        count += 1;
    });
    let [(sin, at_sin), (cos, at_cos)] = worst;
    println!("{count} arguments: sin to {sin:.3} units (at {at_sin:e}), cos to {cos:.3} (at {at_cos:e})");
    assert!(count > 1_000_000);
}

#[test]
fn zeros_keep_their_sign() {
    let (mut single, mut double) = kernels();
    for x in [0.0, -0.0] {
        let (mut one, mut two) = ([7.0; 2], [7.0; 4]);
        single.eval(0.0, &[x], &[], &mut one);
        double.eval(0.0, &[-x, x], &[], &mut two);
        assert_eq!(one.map(f64::to_bits), [x, 1.0].map(f64::to_bits));
        assert_eq!(two.map(f64::to_bits), [-x, 1.0, x, 1.0].map(f64::to_bits));
    }
}

#[test]
fn arguments_out_of_range_use_the_library() {
    let (mut single, mut double) = kernels();
    let far =
        [100_000.000_000_1, -2e5, 1e9, 1e22, -1e300, f64::MAX, f64::INFINITY, f64::NEG_INFINITY, f64::NAN];
    let same = |a: f64, b: f64| a.to_bits() == b.to_bits() || a.is_nan() && b.is_nan();
    for x in far {
        let mut one = [7.0; 2];
        single.eval(0.0, &[x], &[], &mut one);
        assert!(same(one[0], x.sin()) && same(one[1], x.cos()), "{one:?} at {x}");
        // A far argument sends its neighbour to the library, too.
        for y in [0.3, -2e7, f64::NAN] {
            for [x, y] in [[x, y], [y, x]] {
                let mut two = [7.0; 4];
                double.eval(0.0, &[x, y], &[], &mut two);
                let expected = [x.sin(), x.cos(), y.sin(), y.cos()];
                assert!(expected.iter().zip(two).all(|(&e, f)| same(e, f)), "{two:?} at {x}, {y}");
            }
        }
    }
}

/// Values in registers survive calls of the library.
#[test]
fn registers_survive_the_library() {
    let graph = Graph::new();
    let state = graph.symbols(["a", "b", "c", "d", "e", "f"]).to_vec();
    let sum =
        |s: f64| graph.sum(state.iter().enumerate().map(|(i, &x)| (x * (s + i as f64)).sin() * (x + s)));
    let outputs: Vec<_> = (1..6).map(|i| sum(f64::from(i)) * sum(0.5) + state[0]).collect();
    let inputs = Inputs { time: None, state, parameters: vec![] };
    let program = Program::new(&graph, &inputs, &outputs).unwrap();
    let mut inline = Jit::new(&program).unwrap();
    let library = JitOptions { inline_trig: false, ..JitOptions::default() };
    let mut library = Jit::with_options(&program, &library).unwrap();
    for scale in [1.0, 1e3, 3e4, 1e5, 1e7] {
        let x = [0.1, -0.9, 0.4, 1.0, -0.2, 0.7].map(|x| x * scale);
        let (mut a, mut b) = ([0.0; 5], [0.0; 5]);
        inline.eval(0.0, &x, &[], &mut a);
        library.eval(0.0, &x, &[], &mut b);
        for (a, b) in a.iter().zip(&b) {
            assert!((a - b).abs() <= 1e-12 * scale * scale, "{a} {b}");
        }
    }
}

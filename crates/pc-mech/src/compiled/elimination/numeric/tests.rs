//! Factorisation in numbers against M⁻¹ written out.

use pc_expr::{Graph, VectorField};

use crate::compiled::motion::Motion;
use crate::compiled::options::CompileOptions;
use crate::equations::poincare::Equations;
use crate::system::system::System;

/// Unit links and masses, in angles from the vertical, under gravity 10.
fn pendulum(graph: &Graph, links: usize) -> Equations<'_> {
    let gravity = graph.symbol("g");
    let weight = |i: usize| (links - i) as f64;
    System::builder(graph)
        .parameter(gravity, 10.0)
        .coordinates((1..=links).map(|i| format!("θ{i}")))
        .lagrangian(|_, theta, eta| {
            let pairs = (0..links).flat_map(|i| (0..=i).map(move |j| (i, j)));
            let kinetic = pairs.map(|(i, j)| {
                let pair = if i == j { 0.5 } else { 1.0 };
                pair * weight(i) * (theta[i] - theta[j]).cos() * eta[i] * eta[j]
            });
            graph.sum(kinetic.chain((0..links).map(|i| weight(i) * gravity * theta[i].cos())))
        })
        .output("last acceleration", |_, _, _| graph.symbol(&format!("θ{links}''")))
        .build()
        .unwrap()
        .poincare()
        .unwrap()
}

fn all() -> CompileOptions {
    CompileOptions::default().jvp(true).parameter_jacobian(true).time_derivative(true)
}

fn forms(equations: &Equations<'_>) -> [Motion; 2] {
    let system = equations.first_order();
    [0, usize::MAX].map(|longest| system.compile(&all(), longest).unwrap())
}

fn state(dim: usize) -> Vec<f64> {
    (0..dim).map(|i| (0.7 * i as f64).cos()).collect()
}

/// Relative to the largest entry: rounding of two factorisations of a matrix of condition some hundreds.
fn assert_close(found: &[f64], expected: &[f64]) {
    let size = expected.iter().fold(0.0f64, |size, v| size.max(v.abs()));
    for (i, (a, b)) in found.iter().zip(expected).enumerate() {
        assert!((a - b).abs() <= 1e-12 * size, "entry {i}: {a} instead of {b}");
    }
}

fn compare(equations: &Equations<'_>) {
    let [mut staged, mut unrolled] = forms(equations);
    assert!(staged.is_staged() && !unrolled.is_staged());
    let dim = staged.dim();
    let (y, v) = (state(dim), state(2 * dim)[dim..].to_vec());
    let mut both = |length: usize, write: &mut dyn FnMut(&mut Motion, &mut [f64])| {
        let [found, expected] = [&mut staged, &mut unrolled].map(|motion| {
            let mut values = vec![f64::NAN; length];
            write(motion, &mut values);
            values
        });
        assert_close(&found, &expected);
    };
    both(dim, &mut |motion, out| motion.rhs(0.3, &y, out).unwrap());
    both(dim * dim, &mut |motion, out| motion.jacobian(0.3, &y, out).unwrap());
    both(dim, &mut |motion, out| motion.jvp(0.3, &y, &v, out).unwrap());
    let parameters = equations.system().parameters().len();
    both(dim * parameters, &mut |motion, out| motion.parameter_jacobian(0.3, &y, out).unwrap());
    both(dim, &mut |motion, out| motion.time_derivative(0.3, &y, out).unwrap());
    let observed = unrolled.observe(0.3, &y);
    assert_close(&staged.observe(0.3, &y), &observed);

    let pattern = staged.sparsity().unwrap().clone();
    let mut dense = vec![f64::NAN; dim * dim];
    let mut scattered = dense.clone();
    let mut entries = vec![f64::NAN; pattern.len()];
    staged.jacobian(0.3, &y, &mut dense).unwrap();
    staged.sparse_jacobian(0.3, &y, &mut entries).unwrap();
    pattern.scatter(&entries, &mut scattered);
    assert_eq!(dense, scattered, "nothing outside the pattern");
    let exact = unrolled.sparsity().unwrap();
    assert!(exact.entries().all(|(i, j)| pattern.column(j).contains(&i)));
}

#[test]
fn a_small_pendulum_is_the_same_in_numbers() {
    compare(&pendulum(&Graph::new(), 3));
}

#[test]
fn long_pendulums_are_the_same_in_numbers() {
    for links in [20, 24] {
        let graph = Graph::new();
        let equations = pendulum(&graph, links);
        assert!(equations.compile_for(CompileOptions::default().jacobian(false)).unwrap().is_staged());
        compare(&equations);
    }
}

#[test]
fn sixteen_full_rows_and_long_chains_are_written_out() {
    let compiled =
        |equations: &Equations<'_>| equations.compile_for(CompileOptions::default().jacobian(false)).unwrap();
    assert!(!compiled(&pendulum(&Graph::new(), 16)).is_staged());
    assert!(compiled(&pendulum(&Graph::new(), 17)).is_staged());
    let graph = Graph::new();
    let chain = System::builder(&graph)
        .coordinates((0..40).map(|i| format!("x{i}")))
        .lagrangian(|_, x, v| {
            let coupled = (1..40).map(|i| (v[i] - x[i].cos() * v[i - 1]).square());
            graph.sum(coupled.chain([v[0].square()])) / 2.0
        })
        .build()
        .unwrap();
    let mut motion = compiled(&chain.poincare().unwrap());
    assert!(!motion.is_staged());
    motion.rhs(0.0, &state(80), &mut [0.0; 80]).unwrap();
}

/// Two uncoupled systems: the pattern has two blocks, and velocities where they belong.
#[test]
fn uncoupled_bodies_have_separate_blocks() {
    let graph = Graph::new();
    let equations = System::builder(&graph)
        .coordinates(["a", "b", "c", "d"])
        .lagrangian(|_, x, v| {
            let pair = |i: usize, j: usize| {
                v[i].square() + v[j].square() + x[i].cos() * v[i] * v[j] - x[i].square() - x[j].square()
            };
            pair(0, 1) + pair(2, 3)
        })
        .build()
        .unwrap()
        .poincare()
        .unwrap();
    let [staged, unrolled] = forms(&equations);
    assert_eq!(staged.sparsity(), unrolled.sparsity());
    assert_eq!(staged.sparsity().unwrap().column(0), [4, 5]);
    assert_eq!(staged.sparsity().unwrap().column(6), [2, 6, 7]);
    compare(&equations);
}

/// L = ẋẏ has no pivot on its diagonal: it is not factorised in numbers, however long.
#[test]
fn without_pivots_the_inverse_is_written_out() {
    let graph = Graph::new();
    let equations = System::builder(&graph)
        .coordinates(["x", "y"])
        .lagrangian(|_, x, v| v[0] * v[1] - x[0] * x[1])
        .build()
        .unwrap()
        .poincare()
        .unwrap();
    let mut motion = equations.first_order().compile(&all(), 0).unwrap();
    assert!(!motion.is_staged());
    let mut ydot = [0.0; 4];
    motion.rhs(0.0, &[0.5, 0.25, 2.0, 3.0], &mut ydot).unwrap();
    assert_eq!(ydot, [2.0, 3.0, -0.5, -0.25]);
}

/// M = ((sin x, 1), (1, sin x)) is indefinite, and regular where its pivot sin x vanishes: there ẍ = −ẋẏ, ÿ =
/// (ẏ² − ẋ²)/2.
#[test]
fn a_metric_of_both_signs_is_regular_where_a_pivot_vanishes() {
    let graph = Graph::new();
    let equations = System::builder(&graph)
        .coordinates(["x", "y"])
        .lagrangian(|_, x, v| x[0].sin() * (v[0].square() + v[1].square()) / 2.0 + v[0] * v[1])
        .build()
        .unwrap()
        .poincare()
        .unwrap();
    let mut motion = equations.compile_for(all()).unwrap();
    let mut ydot = [0.0; 4];
    motion.rhs(0.0, &[0.0, 0.25, 2.0, 3.0], &mut ydot).unwrap();
    assert_eq!(ydot, [2.0, 3.0, -6.0, 2.5]);
}

#[test]
fn a_vanishing_pivot_names_quasi_velocity_and_state_in_both_forms() {
    let graph = Graph::new();
    // M = ((1, x), (x, x² + (x − 2)²)) has the pivots 1 and (x − 2)².
    let system = System::builder(&graph)
        .coordinates(["x", "y"])
        .lagrangian(|_, x, v| {
            let last = x[0].square() + (x[0] - 2.0).square();
            (v[0].square() + last * v[1].square()) / 2.0 + x[0] * v[0] * v[1]
        })
        .build()
        .unwrap()
        .poincare()
        .unwrap()
        .first_order();
    let y = [2.0, 0.5, -1.0, 0.25];
    let message =
        "the mass matrix is singular: its pivot for `y'` is 0 at t = 1, x = 2, y = 0.5, x' = -1, y' = 0.25";
    for (longest, is_staged) in [(0, true), (usize::MAX, false)] {
        let mut motion = system.compile(&all(), longest).unwrap();
        assert_eq!(motion.is_staged(), is_staged);
        let failure = motion.rhs(1.0, &y, &mut [0.0; 4]).unwrap_err();
        assert!(failure.is_recoverable());
        assert_eq!(failure.to_string(), message);
        motion.rhs(1.0, &[1.0, 0.5, -1.0, 0.25], &mut [0.0; 4]).unwrap();
        let failure = motion.rhs(1.0, &[f64::NAN, 0.5, -1.0, 0.25], &mut [0.0; 4]).unwrap_err();
        assert!(failure.to_string().contains("NaN"), "{failure}");
    }
}

/// RK4 over t = 0.1 with h = 0.001: rates ν of some 50 a second leave an error of some (ν h)⁴/120, below
/// 1e-7.
#[test]
fn a_long_pendulum_keeps_its_energy() {
    let graph = Graph::new();
    let mut motion = pendulum(&graph, 20).compile_for(CompileOptions::default().jacobian(false)).unwrap();
    assert!(motion.is_staged());
    let dim = motion.dim();
    let mut y = state(dim);
    let before = motion.observe(0.0, &y)[0];
    let h = 1e-3;
    for _ in 0..100 {
        let mut slope = |y: &[f64]| {
            let mut ydot = vec![0.0; dim];
            motion.rhs(0.0, y, &mut ydot).unwrap();
            ydot
        };
        let ahead = |k: &[f64], h: f64| y.iter().zip(k).map(|(y, k)| y + h * k).collect::<Vec<_>>();
        let k1 = slope(&y);
        let k2 = slope(&ahead(&k1, h / 2.0));
        let k3 = slope(&ahead(&k2, h / 2.0));
        let k4 = slope(&ahead(&k3, h));
        for i in 0..dim {
            y[i] += h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
        }
    }
    let after = motion.observe(0.0, &y)[0];
    assert!((after - before).abs() < 1e-7 * before.abs(), "{before} to {after}");
}

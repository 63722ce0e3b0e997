//! Equations (30) and their reactions against Lagrange's multipliers: the same motion with all k equations, and in the
//! velocities of the coordinates.

#![expect(clippy::unwrap_used, reason = "tests")]

use pc_mech::{Constraint, Expr, Graph, VectorField};
use pc_nonholo::Constrained;
use pc_tests::classical::SplitMix64;
use pc_tests::nonholonomic::{Nonholonomic, SYSTEMS};

const STATES: usize = 1000;

/// Rounding of the factorisation of matrices whose condition is some hundreds, times that of the random states.
const TOLERANCE: f64 = 1e-11;

fn assert_near(found: f64, expected: f64, size: f64, what: &str) {
    assert!((found - expected).abs() <= TOLERANCE * (1.0 + size), "{what}: {found} instead of {expected}");
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |size, value| size.max(value.abs()))
}

/// The rates of the free quasi-velocities and the reactions by (30), then by multipliers in the quasi-velocities.
fn compare(described: &Nonholonomic) {
    let graph = Graph::new();
    let system = (described.system)(&graph).unwrap();
    let vanishing = described.constraints(&graph);
    let constrained = Constrained::new(&system, &vanishing).unwrap();
    let mut motion = constrained.equations().compile().unwrap();
    let reactions = constrained.reactions();
    let constraints: Vec<Constraint<'_>> =
        described.vanishing.iter().zip(&vanishing).map(|(name, &eta)| Constraint::new(*name, eta)).collect();
    let multipliers = system.with_multipliers(&constraints).unwrap().observe_reactions();
    let mut held = multipliers.compile().unwrap();

    let n = motion.coordinates();
    let (l, m) = (motion.dim() - n, vanishing.len());
    let mut random = SplitMix64::new(0x51ed);
    for _ in 0..STATES {
        let (t, y) = (described.sample)(&mut random);
        let mut whole = y.clone();
        whole.extend(std::iter::repeat_n(0.0, m));
        let (mut expected, mut found) = (vec![0.0; n + l], vec![0.0; n + l + m]);
        motion.rhs(t, &y, &mut expected).unwrap();
        held.rhs(t, &whole, &mut found).unwrap();
        let size = largest(&expected);
        for i in 0..n + l {
            assert_near(found[i], expected[i], size, described.name);
        }
        assert!(found[n + l..].iter().all(|rate| rate.abs() <= TOLERANCE * (1.0 + size)));

        let state = motion.names().iter().map(|name| graph.symbol(name)).zip(y.iter().copied());
        let parameters = system.parameters().iter().copied();
        let values: Vec<(Expr<'_>, f64)> = state.chain(parameters).chain([(graph.symbol("t"), t)]).collect();
        let reactions = graph.evaluate(&reactions, &values).unwrap();
        let observed = held.observe(t, &whole);
        for (reaction, multiplier) in reactions.iter().zip(&observed[observed.len() - m..]) {
            assert_near(*multiplier, *reaction, size.max(reaction.abs()), described.name);
        }
    }
}

/// ẍ by (30), then by multipliers in the velocities ẋ: a mass matrix and constraints that are full.
fn compare_in_velocities(described: &Nonholonomic) {
    let graph = Graph::new();
    let system = (described.system)(&graph).unwrap();
    let vanishing = described.constraints(&graph);
    let constrained = Constrained::new(&system, &vanishing).unwrap();
    let equations = constrained.equations();
    let x = system.frame().coordinates();
    let eta = equations.system().quasi_velocities();
    let along: Vec<(Expr<'_>, Expr<'_>)> = x
        .iter()
        .copied()
        .zip(equations.velocities().iter().copied())
        .chain(eta.iter().copied().zip(equations.accelerations()))
        .chain([(graph.symbol("t"), Expr::ONE)])
        .collect();
    let accelerations = graph.directional(equations.velocities(), &along);

    let (a, a0) = system.frame().definitions().unwrap();
    let velocities: Vec<Expr<'_>> = x.iter().map(|x| graph.symbol(&format!("{x}'"))).collect();
    let constraints: Vec<Constraint<'_>> = vanishing
        .iter()
        .zip(described.vanishing)
        .map(|(slip, name)| {
            let row = system.quasi_velocities().iter().position(|eta| eta == slip).unwrap();
            let velocity = graph.dot(a.row(row).iter().copied(), velocities.iter().copied()) + a0[row];
            Constraint::new(*name, velocity)
        })
        .collect();
    let multipliers = system.in_velocities().unwrap().with_multipliers(&constraints).unwrap();
    let mut held = multipliers.compile().unwrap();

    let n = x.len();
    let mut random = SplitMix64::new(0xd15c);
    for _ in 0..STATES {
        let (t, y) = (described.sample)(&mut random);
        let state = x.iter().chain(eta).copied().zip(y.iter().copied());
        let parameters = system.parameters().iter().copied();
        let values: Vec<(Expr<'_>, f64)> = state.chain(parameters).chain([(graph.symbol("t"), t)]).collect();
        let expected = graph.evaluate(&accelerations, &values).unwrap();
        let rates = graph.evaluate(equations.velocities(), &values).unwrap();
        let whole = [&y[..n], &rates].concat();
        let mut found = vec![0.0; 2 * n];
        held.rhs(t, &whole, &mut found).unwrap();
        let size = largest(&expected).max(largest(&rates).powi(2));
        for (found, expected) in found[n..].iter().zip(&expected) {
            assert_near(*found, *expected, size, described.name);
        }
    }
}

#[test]
fn equations_30_are_those_with_multipliers() {
    for described in SYSTEMS {
        compare(described);
    }
}

#[test]
fn equations_30_are_those_with_multipliers_in_velocities() {
    let mut compared = 0;
    for described in SYSTEMS {
        let graph = Graph::new();
        let system = (described.system)(&graph).unwrap();
        if system.frame().coordinates().len() == system.quasi_velocities().len() {
            compare_in_velocities(described);
            compared += 1;
        }
    }
    assert_eq!(compared, 4, "all but the balls, whose attitude is a quaternion");
}

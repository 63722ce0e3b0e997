//! Combinations of constraints with an integral: every result is one, and all known ones are found.

use pc_mech::{Constraint, Expr, Graph, System};
use pc_nonholo::{ConstraintClassification, IntegrableCombination};

const NAMES: [&str; 5] = ["x", "y", "z", "u", "w"];

/// A particle in five dimensions with unit mass.
fn particle(graph: &Graph) -> System<'_> {
    System::builder(graph)
        .coordinates(NAMES)
        .lagrangian(|_, _, v| v.iter().map(|v| v.square()).sum::<Expr<'_>>() / 2.0)
        .build()
        .unwrap()
}

/// The number of combinations, and those found, each with μ_α φ_α = dF/dt identically.
fn found<'g>(system: &System<'g>, constraints: &[Constraint<'g>]) -> (usize, Vec<IntegrableCombination<'g>>) {
    let (graph, time) = (system.graph(), system.frame().time());
    let state = system.state().into_iter().zip((1..).map(|i| 0.2 + 0.1 * f64::from(i)));
    let at: Vec<_> = state.chain([(time, 0.3)]).collect();
    let all = ConstraintClassification::new(system, constraints, &at).unwrap();
    let count = all.integrable_combinations();
    let found = IntegrableCombination::find(all.multipliers().unwrap(), all.kinds(), count, &at).unwrap();
    for combination in &found {
        let named = |name: &str| constraints.iter().find(|c| c.name() == name).unwrap().expression();
        let terms = combination.coefficients.iter().map(|(name, mu)| *mu * named(name));
        assert!((graph.sum(terms) - rate(system, combination.integral)).is_zero(), "{combination:?}");
    }
    (count, found)
}

/// dF/dt
fn rate<'g>(system: &System<'g>, f: Expr<'g>) -> Expr<'g> {
    let x = system.frame().coordinates().iter().copied().zip(system.quasi_velocities().iter().copied());
    system.graph().directional(&[f], &x.chain([(system.frame().time(), Expr::ONE)]).collect::<Vec<_>>())[0]
}

/// The number of independent functions.
fn rank<'g>(graph: &'g Graph, functions: &[Expr<'g>], variables: &[Expr<'g>]) -> usize {
    graph.generic_rank(&functions.iter().map(|&f| graph.gradient(f, variables)).collect::<Vec<_>>())
}

/// k1 does not bind positions; the other constraints add rates of functions to it.
#[test]
fn known_integrals_are_found() {
    let graph = Graph::new();
    let system = particle(&graph);
    let [t, x, y, z, u, w] = graph.symbols(["t", "x", "y", "z", "u", "w"]);
    let v = system.quasi_velocities();
    let rate = |f| rate(&system, f);
    let knife = v[2] - y * v[0];
    let integrals = [
        [u - x.sin() * y, w + z.square()],
        [u + t * x, w * z - y.exp()],
        [u.exp() + x * y * z, w - (2.0 * x + y).cos() * t],
        [u / (1.0 + x.square()), w + u.sin() * y.cos()],
    ];
    for [first, second] in integrals {
        // With constants, and with functions that do not vanish.
        for [p, q, r] in [[Expr::ONE, 2.into(), Expr::ratio(-1, 3)], [Expr::ONE, y, x.exp()]] {
            let constraints = [
                Constraint::new("k1", knife),
                Constraint::new("k2", q * rate(first) + p * knife),
                Constraint::new("k3", r * rate(second) - q * knife),
            ];
            let (count, found) = found(&system, &constraints);
            assert_eq!(count, 2, "{first}, {second}");
            let variables = [x, y, z, u, w, t];
            let written: Vec<Expr<'_>> = found.iter().map(|combination| combination.integral).collect();
            // Each is a function of those used.
            for &integral in &written {
                assert_eq!(rank(&graph, &[first, second, integral], &variables), 2, "{integral}");
            }
            assert_eq!(rank(&graph, &written, &variables), written.len(), "{first}, {second}: {written:?}");
            // With functions, the combination has to be divided by one to become a rate, which is not always
            // found.
            let expected = if q.constant().is_some() { 2 } else { 1 };
            assert!(written.len() >= expected, "{first}, {second}: {written:?}");
        }
    }
}

#[test]
fn constraints_without_integrable_combinations_have_none() {
    let graph = Graph::new();
    let system = particle(&graph);
    let v = system.quasi_velocities();
    let [y, z, u] = graph.symbols(["y", "z", "u"]);
    // The chain of n trailers reaches every place.
    let chain = [v[2] - y * v[0], v[3] - z * v[0], v[4] - u * v[0]];
    let constraints: Vec<_> =
        chain.iter().enumerate().map(|(i, &c)| Constraint::new(format!("k{i}"), c)).collect();
    assert_eq!(found(&system, &constraints).0, 0);
}

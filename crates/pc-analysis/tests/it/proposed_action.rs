//! Verdicts on functions proposed as solutions of Hamilton–Jacobi's equation.

use pc_analysis::ProposedAction;
use pc_mech::{Expr, Graph, Identity, Neighbourhood, System};

fn near<'g>(graph: &'g Graph, values: &[(&str, f64)]) -> Neighbourhood<'g> {
    Neighbourhood { centre: values.iter().map(|&(name, value)| (graph.symbol(name), value)).collect() }
}

/// S = x r/2 + (E/ω) arctan(ω x/r) − E t, r² = 2E − ω² x², is proved; with an arc sine it has roots of
/// products, which the graph cannot decide; with another E in front of t it is refuted.
#[test]
fn an_oscillators_action_is_proved_or_agrees_or_is_refuted() {
    let graph = Graph::new();
    let [omega, t, x, e] = graph.symbols(["ω", "t", "x", "E"]);
    let oscillator = System::builder(&graph)
        .parameter(omega, 1.5)
        .coordinates(["x"])
        .lagrangian(|_, x, v| (v[0].square() - (omega * x[0]).square()) / 2.0)
        .build()
        .unwrap();
    let canonical = oscillator.canonical().unwrap();
    let near = near(&graph, &[("ω", 1.5), ("t", 0.2), ("x", 0.3), ("E", 2.0)]);
    let root = (2.0 * e - (omega * x).square()).sqrt();
    let angles = [(omega * x / root).atan(), (omega * x / (2.0 * e).sqrt()).asin()];
    let with = |angle: usize, energy: f64| {
        let action = x * root / 2.0 + e / omega * angles[angle] - energy * e * t;
        ProposedAction::check(&canonical, action, &[e], &near).unwrap()
    };
    let by_tangent = with(0, 1.0);
    assert_eq!((by_tangent.identity, by_tangent.rank), (Identity::Proved, 1));
    let by_sine = with(1, 1.0);
    let Identity::Open { rest } = by_sine.identity else { panic!("{by_sine:?}") };
    assert!(rest < 1e-14 && by_sine.refuted.is_none(), "{by_sine:?}"); // some dozen roundings
    let wrong = with(0, 1.01);
    assert!(matches!(wrong.identity, Identity::Disproved { .. }), "{wrong:?}");
    // X_0 S + H = −E/100 everywhere.
    let residual = wrong.refuted.unwrap();
    let energy = residual.at.iter().find(|(name, _)| name == "E").unwrap().1;
    assert!((residual.value + energy / 100.0).abs() < 1e-14, "{residual:?}");
}

/// Kepler's action in polar coordinates, S = l φ − E t + q + (mk/√a) arctan(…) − l arctan(…), q² = 2mE r² +
/// 2mk r − l², a = −2mE.
#[test]
fn keplers_action_is_proved() {
    let graph = Graph::new();
    let [m, k, t, r, phi, e, l] = graph.symbols(["m", "k", "t", "r", "φ", "E", "l"]);
    let planet = System::builder(&graph)
        .parameter(m, 2.0)
        .parameter(k, 3.0)
        .coordinates(["r", "φ"])
        .lagrangian(|_, x, v| m * (v[0].square() + (x[0] * v[1]).square()) / 2.0 + k / x[0])
        .build()
        .unwrap();
    let near =
        near(&graph, &[("m", 2.0), ("k", 3.0), ("t", 0.0), ("r", 1.2), ("φ", 0.3), ("E", -1.0), ("l", 2.4)]);
    let (q, a) = ((2.0 * m * (e * r.square() + k * r) - l.square()).sqrt(), -2.0 * m * e);
    let action = |scale: f64| {
        l * phi - e * t + q + scale * m * k / a.sqrt() * ((a * r - m * k) / (a.sqrt() * q)).atan()
            - l * ((m * k * r - l.square()) / (l * q)).atan()
    };
    let canonical = planet.canonical().unwrap();
    let verdict = |scale| ProposedAction::check(&canonical, action(scale), &[e, l], &near).unwrap();
    assert_eq!((verdict(1.0).identity, verdict(1.0).rank), (Identity::Proved, 2));
    let wrong = verdict(1.001);
    assert!(matches!(wrong.identity, Identity::Disproved { .. }), "{wrong:?}");
    // The remainder has that value there.
    let residual = wrong.refuted.unwrap();
    let at: Vec<(Expr<'_>, f64)> =
        residual.at.iter().map(|(name, value)| (graph.symbol(name), *value)).collect();
    let value = graph.evaluate(&[wrong.remainder], &at).unwrap()[0];
    assert!((value - residual.value).abs() < 1e-13 * value.abs().max(1.0), "{value} is {}", residual.value);
}

/// With one constant of two, or one that S does not contain, it is incomplete.
#[test]
fn an_action_of_too_few_constants_is_not_complete() {
    let graph = Graph::new();
    let particle = System::builder(&graph)
        .coordinates(["x", "y"])
        .lagrangian(|_, _, v| (v[0].square() + v[1].square()) / 2.0)
        .build()
        .unwrap();
    let [t, x, a, b] = graph.symbols(["t", "x", "a", "b"]);
    let verdict = ProposedAction::check(
        &particle.canonical().unwrap(),
        a * x - a.square() * t / 2.0,
        &[a, b],
        &near(&graph, &[("a", 1.0), ("b", 1.0)]),
    )
    .unwrap();
    assert_eq!((verdict.identity, verdict.rank), (Identity::Proved, 1));
}

/// Where S has no values the verdict stays open.
#[test]
fn an_action_without_values_stays_open() {
    let graph = Graph::new();
    let [t, x, e] = graph.symbols(["t", "x", "E"]);
    let line =
        System::builder(&graph).coordinates(["x"]).lagrangian(|_, _, v| v[0].square() / 2.0).build().unwrap();
    let near = near(&graph, &[("E", -2.0), ("x", 1.0), ("t", 0.0)]);
    let action = x * (3.0 * e).sqrt() - e * t;
    let verdict = ProposedAction::check(&line.canonical().unwrap(), action, &[e], &near).unwrap();
    assert!(!matches!(verdict.identity, Identity::Proved), "{verdict:?}");
}

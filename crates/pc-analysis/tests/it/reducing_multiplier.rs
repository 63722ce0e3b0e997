//! Chaplygin's reducing multiplier: in the new time the motion is Lagrangian; and systems that have none.

use pc_analysis::ReducingMultiplier;
use pc_mech::{Constraint, Expr, Graph, System};
use pc_nonholo::Voronets;

type Closure<'g> = fn(&[Expr<'g>], &[Expr<'g>]) -> Expr<'g>;

/// A particle of mass 1 with one dimension for each name, and ẇ = the constraint for the last coordinate w.
fn particle<'g>(
    graph: &'g Graph,
    names: &[&str],
    potential: Closure<'g>,
    constraint: Closure<'g>,
) -> Voronets<'g> {
    let system = System::builder(graph)
        .coordinates(names)
        .lagrangian(|_, x, v| v.iter().map(|v| v.square()).sum::<Expr<'_>>() / 2.0 - potential(x, v))
        .build()
        .unwrap();
    let (x, v) = (system.frame().coordinates().to_vec(), system.quasi_velocities().to_vec());
    let held = Constraint::new("held", v[v.len() - 1] - constraint(&x, &v));
    // Coefficients are below 1 there, so that the last velocity is the dependent one.
    let at: Vec<_> = x.into_iter().chain(v).zip((1..).map(|i| 0.1 * f64::from(i))).collect();
    let at = [at, vec![(graph.symbol("t"), 0.0)]].concat();
    Voronets::new(&system.with_multipliers(&[held]).unwrap(), &at).unwrap()
}

/// The largest difference of x_i'' by the new Lagrangian from (ẍ_i − Ṅ x_i')/N², Ṅ = N x_j' ∂N/∂x_j, by difference
/// quotients of N.
fn defect<'g>(graph: &'g Graph, voronets: &Voronets<'g>, reduced: &ReducingMultiplier<'g>) -> f64 {
    let in_time = voronets.system().unwrap();
    let (x, v) = (voronets.independent(), in_time.quasi_velocities());
    let place: Vec<f64> = (0..x.len()).map(|i| 0.4 - 0.3 * i as f64).collect();
    let rates: Vec<f64> = (0..x.len()).map(|i| 0.7 + 0.5 * i as f64).collect();
    let at = |place: &[f64], rates: &[f64]| -> Vec<(Expr<'g>, f64)> {
        x.iter().chain(v).copied().zip(place.iter().chain(rates).copied()).collect()
    };
    let multiplier = |place: &[f64]| graph.evaluate(&[reduced.multiplier], &at(place, &rates)).unwrap()[0];
    let n = multiplier(&place);
    let shifted = |h: f64| place.iter().zip(&rates).map(|(x, v)| x + h * v).collect::<Vec<_>>();
    let h = 1e-5;
    let growth = (multiplier(&shifted(h)) - multiplier(&shifted(-h))) / (2.0 * h);

    let velocities: Vec<f64> = rates.iter().map(|v| n * v).collect();
    let accelerations = in_time.poincare().unwrap().accelerations();
    let accelerations = graph.evaluate(&accelerations, &at(&place, &velocities)).unwrap();
    let found =
        graph.evaluate(&reduced.system.poincare().unwrap().accelerations(), &at(&place, &rates)).unwrap();
    let expected = accelerations.iter().zip(&rates).map(|(a, v)| (a / n - growth * v) / n);
    found.iter().zip(expected).map(|(found, expected)| (found - expected).abs()).fold(0.0, f64::max)
}

#[test]
fn two_degrees_of_freedom_become_lagrangian() {
    let graph = Graph::new();
    // ż = y ẋ in the potential x² + x y; ż = sin y ẋ.
    let knife = particle(&graph, &["x", "y", "z"], |x, _| x[0].square() + x[0] * x[1], |x, v| x[1] * v[0]);
    let wave = particle(&graph, &["x", "y", "z"], |x, _| x[1].cos(), |x, v| x[1].sin() * v[0]);
    for voronets in [knife, wave] {
        let reduced = ReducingMultiplier::of(&voronets).unwrap().unwrap();
        assert!(reduced.multiplier.constant().is_none(), "{}", reduced.multiplier);
        assert!(reduced.system.forces().iter().all(|q| q.is_zero()));
        let defect = defect(&graph, &voronets, &reduced);
        assert!(defect < 1e-9, "{defect}"); // h² of the difference quotient
    }
}

#[test]
fn with_more_degrees_of_freedom_a_multiplier_is_proved_or_absent() {
    let graph = Graph::new();
    let names = ["x", "y", "s", "w"];
    // ẇ = 2 x ẋ is a surface, and its motions are already Lagrangian; N is constant.
    let surface = particle(&graph, &names, |_, _| 0.into(), |x, v| 2.0 * x[0] * v[0]);
    let reduced = ReducingMultiplier::of(&surface).unwrap().unwrap();
    assert_eq!(reduced.multiplier, 1.into());
    assert!(defect(&graph, &surface, &reduced) < 1e-9);
    // ẇ = y ẋ and a third free coordinate s: the measure of the particle is invariant, but s' by τ would not
    // be constant.
    let beside = particle(&graph, &names, |_, _| 0.into(), |x, v| x[1] * v[0]);
    assert!(ReducingMultiplier::of(&beside).unwrap().is_none());
}

/// With ẇ_a = h(x) ẋ_a for each of l coordinates the kinetic energy is (1 + h²) ẋ²/2, and N = (1 + h²)^(−1/2)
/// makes it x'²/2 for every l: motions without a potential are straight lines, though N^(l−1) is the density
/// of the measure.
#[test]
fn the_multiplier_is_a_root_of_the_density() {
    for l in 2..=4 {
        let graph = Graph::new();
        let names: Vec<String> =
            (1..=l).map(|i| format!("x{i}")).chain((1..=l).map(|i| format!("w{i}"))).collect();
        let system = System::builder(&graph)
            .coordinates(&names)
            .lagrangian(|_, x, v| v.iter().map(|v| v.square()).sum::<Expr<'_>>() / 2.0 - (x[0] - x[1]).cos())
            .build()
            .unwrap();
        let (x, v) = (system.frame().coordinates().to_vec(), system.quasi_velocities().to_vec());
        let h = (x[0] + x[l - 1] * 0.5).sin() * 0.5;
        let constraint = |a: usize| Constraint::new(format!("k{a}"), v[l + a] - h * v[a]);
        let held = system.with_multipliers(&(0..l).map(constraint).collect::<Vec<_>>()).unwrap();
        let at: Vec<_> = x.iter().chain(&v).copied().zip((1..).map(|i| 0.1 * f64::from(i))).collect();
        let at = [at, vec![(graph.symbol("t"), 0.0)]].concat();
        let voronets = Voronets::new(&held, &at).unwrap();
        let reduced = ReducingMultiplier::of(&voronets).unwrap().unwrap();
        let square = 1.0 + h.square();
        let place: Vec<_> = x.iter().copied().zip([0.3, -0.8, 1.1, 0.4]).collect();
        let ratio = graph.evaluate(&[reduced.multiplier.square() * square], &place).unwrap()[0];
        assert!((ratio - 1.0).abs() < 1e-15, "l = {l}: N² (1 + h²) = {ratio}");
        let defect = defect(&graph, &voronets, &reduced);
        assert!(defect < 1e-9, "l = {l}: {defect}"); // h² of the difference quotient
    }
}

#[test]
fn there_is_no_multiplier_without_a_measure_or_symmetry_or_with_forces() {
    let graph = Graph::new();
    // Chaplygin's sleigh, ẏ = tan φ ẋ: a Chaplygin system without invariant measure.
    let sleigh = System::builder(&graph)
        .coordinates(["x", "φ", "y"])
        .lagrangian(|_, x, v| {
            let (s, c) = (x[1].sin(), x[1].cos());
            ((v[0] - s * v[1] / 2.0).square() + (v[2] + c * v[1] / 2.0).square() + v[1].square()) / 2.0
        })
        .build()
        .unwrap();
    let [phi, vx, vy] = graph.symbols(["φ", "x'", "y'"]);
    let blade = Constraint::new("blade", vy * phi.cos() - vx * phi.sin());
    let at: Vec<_> = ["x", "φ", "y", "x'", "φ'", "y'", "t"].map(|name| (graph.symbol(name), 0.2)).into();
    let voronets = Voronets::new(&sleigh.with_multipliers(&[blade]).unwrap(), &at).unwrap();
    assert!(voronets.is_chaplygin());
    assert!(ReducingMultiplier::of(&voronets).unwrap().is_none());

    // The coefficient depends on the dependent coordinate: the system is not Chaplygin's.
    let voronets = particle(&graph, &["x", "y", "z"], |_, _| 0.into(), |x, v| x[2] * x[1] * v[0]);
    assert!(ReducingMultiplier::of(&voronets).unwrap().is_none());

    // Forces without a potential.
    let dragged = System::builder(&graph)
        .coordinates(["x", "y", "z"])
        .lagrangian(|_, _, v| (v[0].square() + v[1].square() + v[2].square()) / 2.0)
        .dissipation(|_, _, v| v[0].square())
        .build()
        .unwrap();
    let [y, vz] = graph.symbols(["y", "z'"]);
    let knife = Constraint::new("knife", vz - y * vx);
    let at: Vec<_> = ["x", "y", "z", "x'", "y'", "z'", "t"].map(|name| (graph.symbol(name), 0.2)).into();
    let voronets = Voronets::new(&dragged.with_multipliers(&[knife]).unwrap(), &at).unwrap();
    assert!(ReducingMultiplier::of(&voronets).unwrap().is_none());
}

/// The particle with 3 ż, a total derivative, in its Lagrangian: the motion is the same, and only the correct
/// multiplier of ż agrees.
#[test]
fn terms_linear_in_the_velocities_are_taken_into_account() {
    let graph = Graph::new();
    let system = System::builder(&graph)
        .coordinates(["x", "y", "z"])
        .lagrangian(|_, _, v| (v[0].square() + v[1].square() + v[2].square()) / 2.0 + 3.0 * v[2])
        .build()
        .unwrap();
    let [y, vx, vz] = graph.symbols(["y", "x'", "z'"]);
    let at: Vec<_> = ["x", "y", "z", "x'", "y'", "z'", "t"].map(|name| (graph.symbol(name), 0.2)).into();
    let held = system.with_multipliers(&[Constraint::new("knife", vz - y * vx)]).unwrap();
    assert!(ReducingMultiplier::of(&Voronets::new(&held, &at).unwrap()).unwrap().is_none());
}

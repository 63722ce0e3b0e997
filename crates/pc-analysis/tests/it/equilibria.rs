//! Equilibria in a box, against closed forms.

use std::f64::consts::PI;

use pc_analysis::{
    AnalysisError, Conserved, Equilibria, EquilibriumSearch, Integrals, Leaf, Linearizer, Stability, Verdict,
};
use pc_mech::{Expr, Graph, Neighbourhood, System};

/// Newton's method ends at rounding; states are of order one.
const EXACT: f64 = 1e-11;

fn search(
    system: &System<'_>,
    start: &[f64],
    search: &EquilibriumSearch,
) -> Result<Equilibria, AnalysisError> {
    let equations = system.poincare().unwrap();
    let leaf = Leaf::of(system);
    let mut linearizer = Linearizer::new(&equations, &leaf, &[]).unwrap();
    let state = system.state().into_iter().zip(start.iter().copied());
    let time = (system.frame().time(), 0.0);
    let near =
        Neighbourhood { centre: state.chain([time]).chain(system.parameters().iter().copied()).collect() };
    let integrals = Integrals::find(&equations, &near);
    let conserved = Conserved::of(&equations, None, &leaf, integrals.list());
    search.run(&mut linearizer, (0.0, start), &conserved)
}

fn bead<'g>(graph: &'g Graph, turn: f64, damping: f64) -> System<'g> {
    System::builder(graph)
        .coordinates(["θ"])
        .lagrangian(|_, x, v| (v[0].square() + (turn * x[0].sin()).square()) / 2.0 + x[0].cos())
        .dissipation(|_, _, v| damping * v[0].square() / 2.0)
        .build()
        .unwrap()
}

/// The bead on a turning hoop, g/r = 1: below Ω = 1 it rests at the bottom and at the top, above it also at
/// cos θ = 1/Ω², and the bottom is unstable: a pitchfork. Frequencies are √(1 − Ω²) and √(Ω² − 1/Ω²).
#[test]
fn a_bead_leaves_the_bottom_by_a_pitchfork() {
    let graph = Graph::new();
    let all = EquilibriumSearch::default();
    let slow = search(&bead(&graph, 0.8, 0.0), &[0.3, 0.1], &all).unwrap();
    assert_eq!(slow.list.len(), 2);
    assert!(slow.list[0].state[0].abs() < EXACT && (slow.list[1].state[0] - PI).abs() < EXACT);
    assert_eq!(slow.list[0].stability.clone(), Stability::BySecondVariation { variables: None });
    let frequency = slow.list[0].linearization.spectrum.eigenvalues()[0].imaginary;
    assert!((frequency - 0.6).abs() < EXACT, "{frequency}");
    assert!(slow.list.iter().all(|one| one.family == 0));

    let turn = 2.0f64.sqrt();
    for (damping, beside) in [
        (0.0, Stability::BySecondVariation { variables: None }),
        (0.2, Stability::ByFirstApproximation(Verdict::AsymptoticallyStable)),
    ] {
        let fast = search(&bead(&graph, turn, damping), &[0.3, 0.1], &all).unwrap().list;
        // In ascending order of energy, −Ω² sin²θ/2 − cos θ: to both sides, at the bottom, at the top.
        let places: Vec<f64> = fast.iter().map(|one| one.state[0]).collect();
        for (place, expected) in places.iter().zip([-PI / 3.0, PI / 3.0, 0.0, PI]) {
            assert!((place - expected).abs() < EXACT, "{places:?}");
        }
        assert_eq!(places.len(), 4);
        assert_eq!([&fast[0], &fast[1]].map(|one| one.stability.clone()), [beside.clone(), beside]);
        let unstable = Stability::ByFirstApproximation(Verdict::Unstable);
        assert_eq!([&fast[2], &fast[3]].map(|one| one.stability.clone()), [unstable.clone(), unstable]);
        assert!((fast[1].energy + 1.25).abs() < EXACT, "{}", fast[1].energy);
        let (found, expected) = (
            fast[1].linearization.spectrum.eigenvalues()[0].imaginary,
            (1.5f64 - damping * damping / 4.0).sqrt(),
        );
        assert!((found - expected).abs() < EXACT, "{found} {expected}");
    }
}

/// A box bounds the results; angles are counted from its lower bound.
#[test]
fn a_box_keeps_what_is_in_it() {
    let graph = Graph::new();
    let pendulum = bead(&graph, 0.0, 0.0);
    let places = |low, high| -> Vec<f64> {
        let search_in = EquilibriumSearch::default().within("θ", low, high).starts(40);
        let found = search(&pendulum, &[0.3, 0.1], &search_in).unwrap();
        assert_eq!((found.starts, found.bounds), (40, vec![("θ".to_owned(), low, high)]));
        found.list.iter().map(|one| one.state[0]).collect()
    };
    assert!(matches!(places(-1.0, 1.0)[..], [zero] if zero.abs() < EXACT));
    assert!(matches!(places(3.0, 6.0)[..], [top] if (top - PI).abs() < EXACT));
    assert!(matches!(places(6.0, 7.0)[..], [turn] if (turn - 2.0 * PI).abs() < EXACT));
    assert!(places(1.0, 2.0).is_empty());
    let refused = |search_in: EquilibriumSearch| search(&pendulum, &[0.3, 0.1], &search_in).unwrap_err();
    let wrong = refused(EquilibriumSearch::default().within("θ'", 0.0, 1.0));
    assert_eq!(wrong, AnalysisError::UnknownComponent { name: "θ'".to_owned(), known: vec!["θ".to_owned()] });
    let empty = refused(EquilibriumSearch::default().within("θ", 1.0, 0.0));
    assert_eq!(empty, AnalysisError::EmptyBox { name: "θ".to_owned(), low: 1.0, high: 0.0 });
}

fn on_a_plane<'g>(graph: &'g Graph, potential: impl FnOnce(Expr<'g>, Expr<'g>) -> Expr<'g>) -> System<'g> {
    System::builder(graph)
        .coordinates(["x", "y"])
        .lagrangian(|_, x, v| (v[0].square() + v[1].square()) / 2.0 - potential(x[0], x[1]))
        .build()
        .unwrap()
}

/// Four wells, four passes and a hill of x⁴/4 − x²/2 in both directions.
#[test]
fn all_nine_equilibria_of_four_wells_are_found_each_time() {
    let graph = Graph::new();
    let system =
        on_a_plane(&graph, |x, y| x.powi(4) / 4.0 - x.square() / 2.0 + y.powi(4) / 4.0 - y.square() / 2.0);
    let all = || search(&system, &[0.1, 0.2, 0.0, 0.0], &EquilibriumSearch::default()).unwrap();
    let found = all();
    assert_eq!(found.list.len(), 9);
    let energies: Vec<f64> = found.list.iter().map(|one| (one.energy * 4.0).round()).collect();
    assert_eq!(energies, [-2.0, -2.0, -2.0, -2.0, -1.0, -1.0, -1.0, -1.0, 0.0]);
    let places = |found: &Equilibria| found.list.iter().map(|one| one.state.clone()).collect::<Vec<_>>();
    assert_eq!(places(&found), places(&all()));
}

/// The bottom of a wine bottle is a circle, of which one member is listed; its top is isolated.
#[test]
fn families_are_recognised() {
    let graph = Graph::new();
    let bottle = on_a_plane(&graph, |x, y| (x.square() + y.square() - 1.0).square());
    let found = search(&bottle, &[0.4, 0.3, 0.0, 0.0], &EquilibriumSearch::default()).unwrap().list;
    assert_eq!(found.iter().map(|one| one.family).collect::<Vec<_>>(), [1, 0]);
    assert!(found[0].members > 10, "{}", found[0].members);
    let [x, y] = [found[0].state[0], found[0].state[1]];
    assert!((x.hypot(y) - 1.0).abs() < EXACT && found[1].state[0].abs() < EXACT);
}

/// The first approximation at the only equilibrium of xⁿ + y² has a kernel, n > 2, and no others are near. Newton's method goes to
/// that of x³ from everywhere, in halves of the way.
#[test]
fn an_isolated_equilibrium_with_a_kernel_is_no_family() {
    let graph = Graph::new();
    for (n, start) in [(3, [0.0; 4]), (3, [0.5, 0.3, 0.0, 0.0]), (4, [0.0; 4]), (6, [0.0; 4])] {
        let system = on_a_plane(&graph, |x, y| x.powi(n) + y.square());
        let found = search(&system, &start, &EquilibriumSearch::default()).unwrap().list;
        let [one] = found.as_slice() else { panic!("{} of x^{n} + y²", found.len()) };
        assert_eq!((one.family, one.members), (0, 1), "x^{n}");
        // 3 x² is below the tolerance of the rates.
        assert!(one.state.iter().all(|y| y.abs() < 1e-5), "{:?}", one.state);
    }
}

/// A force that decays with distance vanishes nowhere, although Newton's method goes to where it is small.
#[test]
fn nothing_is_found_at_infinity() {
    let graph = Graph::new();
    let well = System::builder(&graph)
        .coordinates(["x"])
        .lagrangian(|_, x, v| v[0].square() / 2.0 + 1.0 / (1.0 + x[0].square()))
        .build()
        .unwrap();
    let found = search(&well, &[1.5, 0.0], &EquilibriumSearch::default()).unwrap().list;
    assert!(matches!(&found[..], [middle] if middle.state[0].abs() < EXACT), "{found:?}");
}

/// A cyclic coordinate has any value at an equilibrium, and no box.
#[test]
fn cyclic_coordinates_have_any_value() {
    let graph = Graph::new();
    let cart = System::builder(&graph)
        .coordinates(["x", "θ"])
        .lagrangian(|_, x, v| v[0].square() + v[0] * v[1] * x[1].cos() + v[1].square() / 2.0 + x[1].cos())
        .build()
        .unwrap();
    let start = [0.7, 0.3, 0.0, 0.0];
    let found = search(&cart, &start, &EquilibriumSearch::default()).unwrap();
    assert_eq!(found.anywhere, ["x"]);
    assert_eq!(found.list.len(), 2);
    for one in &found.list {
        assert_eq!(one.state[0], 0.7);
        assert_eq!(one.linearization.components, ["θ", "x'", "θ'"]);
    }
    let wrong = search(&cart, &start, &EquilibriumSearch::default().within("x", 0.0, 1.0)).unwrap_err();
    assert_eq!(wrong, AnalysisError::CyclicBox { name: "x".to_owned() });
}

#[test]
fn driven_systems_have_no_equilibria() {
    let graph = Graph::new();
    let time = graph.symbol("t");
    let driven = System::builder(&graph)
        .coordinates(["x"])
        .lagrangian(|_, x, v| v[0].square() / 2.0 + (1.0 + time.cos()) * x[0].cos())
        .build()
        .unwrap();
    let wrong = search(&driven, &[0.1, 0.0], &EquilibriumSearch::default()).unwrap_err();
    assert_eq!(wrong, AnalysisError::DependsOnTime);
}

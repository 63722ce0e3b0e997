//! Steady motions from many starts.

use pc_analysis::{Integrals, NoSteadyMotions, Stability, SteadyMotions, Verdict};
use pc_mech::{Graph, LieAlgebra, Neighbourhood, System};

fn search(system: &System<'_>, start: &[f64]) -> Result<SteadyMotions, NoSteadyMotions> {
    let equations = system.poincare().unwrap();
    let state = system.state().into_iter().zip(start.iter().copied());
    let time = (system.frame().time(), 0.0);
    let near =
        Neighbourhood { centre: state.chain([time]).chain(system.parameters().iter().copied()).collect() };
    let integrals = Integrals::find(&equations, &near);
    let mut motion = equations.compile().unwrap();
    SteadyMotions::search(&equations, &mut motion, (0.0, start), integrals.list(), &[], usize::MAX)
}

/// Newton's method ends at rounding; states are of order one.
const EXACT: f64 = 1e-9;

fn pendulum(graph: &Graph, damping: f64) -> System<'_> {
    System::builder(graph)
        .coordinates(["φ"])
        .lagrangian(|_, x, v| v[0].square() / 2.0 + x[0].cos())
        .dissipation(|_, _, v| damping * v[0].square() / 2.0)
        .build()
        .unwrap()
}

/// Below and above, each once, regardless of full turns.
#[test]
fn a_pendulum_hangs_or_stands() {
    let graph = Graph::new();
    for (damping, below) in [
        (0.0, Stability::BySecondVariation { variables: None }),
        (0.3, Stability::ByFirstApproximation(Verdict::AsymptoticallyStable)),
    ] {
        let found = search(&pendulum(&graph, damping), &[0.4, 0.1]).unwrap().list;
        assert_eq!(found.len(), 2, "{found:?}");
        let place = |i: usize| found[i].motion.state[0].1;
        assert!(place(0).abs() < EXACT && (place(1).abs() - std::f64::consts::PI).abs() < EXACT, "{found:?}");
        assert_eq!(found[0].motion.stability(), below);
        assert_eq!(found[1].motion.stability(), Stability::ByFirstApproximation(Verdict::Unstable));
        assert!(found.iter().all(|found| found.family == 0));
    }
}

/// Rotations about each of three axes, in both senses, with the momentum of the start, and rest: L. Euler's.
#[test]
fn eulers_top_turns_about_six_half_axes() {
    let graph = Graph::new();
    let moments = [1.0, 2.0, 3.0];
    let top = System::builder(&graph)
        .coordinates([] as [&str; 0])
        .quasi_velocities(["ω1", "ω2", "ω3"])
        .algebra(&LieAlgebra::so3())
        .lagrangian(|_, _, w| {
            (moments[0] * w[0].square() + moments[1] * w[1].square() + moments[2] * w[2].square()) / 2.0
        })
        .build()
        .unwrap();
    let start = [1.0, 0.3, 0.5];
    let momentum = moments.iter().zip(start).map(|(i, w)| (i * w) * (i * w)).sum::<f64>().sqrt();
    let found = search(&top, &start).unwrap().list;
    for (axis, moment) in moments.into_iter().enumerate() {
        for sense in [1.0, -1.0] {
            let is_this = |state: &[(String, f64)]| {
                let expected = |i: usize| if i == axis { sense * momentum / moment } else { 0.0 };
                state.iter().enumerate().all(|(i, (_, w))| (w - expected(i)).abs() < EXACT)
            };
            let this = found.iter().find(|found| is_this(&found.motion.state));
            let stability = this.unwrap_or_else(|| panic!("{axis} {sense}: {found:?}")).motion.stability();
            match axis {
                1 => assert_eq!(stability, Stability::ByFirstApproximation(Verdict::Unstable)),
                _ => assert_eq!(stability, Stability::BySecondVariation { variables: None }),
            }
        }
    }
    let rest: Vec<_> = found.iter().filter(|found| found.family > 0).collect();
    assert_eq!((found.len(), rest.len(), rest[0].family), (7, 1, 3));
}

/// The circle of the start's area: r = p²/k for m = 1.
#[test]
fn a_planet_has_one_circular_orbit_of_its_area() {
    let graph = Graph::new();
    let k = graph.symbol("k");
    let planet = System::builder(&graph)
        .parameter(k, 3.0)
        .coordinates(["r", "φ"])
        .lagrangian(|_, x, v| (v[0].square() + (x[0] * v[1]).square()) / 2.0 + k / x[0])
        .build()
        .unwrap();
    let found = search(&planet, &[1.2, 0.0, 0.1, 0.9]).unwrap().list;
    let area = 1.2f64 * 1.2 * 0.9;
    assert_eq!(found.len(), 1, "{found:?}");
    let state = &found[0].motion.state;
    assert!((state[0].1 - area * area / 3.0).abs() < EXACT, "{state:?}");
    assert_eq!(found[0].motion.stability(), Stability::BySecondVariation { variables: None });
}

#[test]
fn motions_driven_by_time_have_no_steady_motions() {
    let graph = Graph::new();
    let driven = System::builder(&graph)
        .coordinates(["x"])
        .lagrangian(|t, x, v| v[0].square() / 2.0 - x[0] * t.cos())
        .build()
        .unwrap();
    assert_eq!(search(&driven, &[1.0, 0.0]).unwrap_err(), NoSteadyMotions::NotAutonomous);
}

//! Projection to first integrals, alone and beside constraints.

use pc_mech::{Constraint, Expr, Graph, IntegralError, LieAlgebra, MechError, System, VectorField};

/// A heavy top in (γ, ω) with the integrals |γ|² and the area.
fn top(graph: &Graph) -> System<'_> {
    System::builder(graph)
        .coordinates(["γ1", "γ2", "γ3"])
        .quasi_velocities(["ω1", "ω2", "ω3"])
        .kinematics(|_, g, w| {
            [g[1] * w[2] - g[2] * w[1], g[2] * w[0] - g[0] * w[2], g[0] * w[1] - g[1] * w[0]]
        })
        .algebra(&LieAlgebra::so3())
        .lagrangian(|_, g, w| {
            w[0].square() + 1.5 * w[1].square() + 2.0 * w[2].square() - g[0] - 2.0 * g[1] - 3.0 * g[2]
        })
        .integral("norm", |_, g, _| g[0].square() + g[1].square() + g[2].square())
        .integral("area", |_, g, w| 2.0 * w[0] * g[0] + 3.0 * w[1] * g[1] + 4.0 * w[2] * g[2])
        .integral("spin", |_, _, w| w[2])
        .build()
        .unwrap()
}

const START: [f64; 6] = [0.36, 0.48, 0.8, 0.2, -0.3, 1.5];

fn disturbed(state: &[f64], by: f64) -> Vec<f64> {
    (1..).zip(state).map(|(i, y)| y + by * f64::from(i).sin()).collect()
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

#[test]
fn states_are_projected_to_integrals_in_both_forms() {
    let graph = Graph::new();
    let system = top(&graph);
    let names = ["norm", "area", "energy"];
    let (equations, canonical) = (system.poincare().unwrap(), system.canonical().unwrap());
    let momenta: Vec<f64> = START[..3].iter().copied().chain([0.4, -0.9, 6.0]).collect();
    let plain = [
        (equations.compile().unwrap(), equations.kept(&names).unwrap(), START.to_vec()),
        (
            canonical.compile_for(pc_mech::CompileOptions::default()).unwrap(),
            canonical.kept(&names).unwrap(),
            momenta,
        ),
    ];
    for (motion, kept, start) in plain {
        assert!(!motion.has_projection());
        let mut motion = motion.keep(kept, 0.0, &start).unwrap();
        assert!(motion.has_projection());
        let expected = motion.observe(0.0, &start);
        let away = disturbed(&start, 1e-4);
        let mut state = away.clone();
        motion.project(3.0, &mut state).unwrap();
        let found = motion.observe(3.0, &state);
        for j in [0, 1, 3] {
            let (found, expected) = (found[j], expected[j]);
            assert!((found - expected).abs() < 1e-14 * (1.0 + expected.abs()), "{j}: {found} {expected}"); // roundings
        }
        // The nearest such state is at most as far as the start.
        assert!(distance(&state, &away) <= distance(&start, &away));
    }
}

#[test]
fn constraints_and_energy_hold_together() {
    let graph = Graph::new();
    let pendulum = System::builder(&graph)
        .coordinates(["x", "y"])
        .lagrangian(|_, x, v| (v[0].square() + v[1].square()) / 2.0 - x[1])
        .build()
        .unwrap();
    let [x, y] = graph.symbols(["x", "y"]);
    let rod = Constraint::new("rod", x.square() + y.square() - 1.0);
    let multipliers = pendulum.with_multipliers(&[rod]).unwrap();
    let start = [0.6, -0.8, 1.6, 1.2];
    let kept = multipliers.kept(&["energy"]).unwrap();
    let mut motion = multipliers.compile().unwrap().keep(kept, 0.0, &start).unwrap();
    let energy = motion.observe(0.0, &start)[0];
    let mut state = disturbed(&start, 1e-3);
    motion.project(0.0, &mut state).unwrap();
    assert!((motion.observe(0.0, &state)[0] - energy).abs() < 1e-14);
    assert!((state[0].hypot(state[1]) - 1.0).abs() < 1e-15);
    assert!((state[0] * state[2] + state[1] * state[3]).abs() < 1e-15);
}

#[test]
fn dependent_integrals_follow_from_the_others() {
    let graph = Graph::new();
    let oscillator = System::builder(&graph)
        .coordinates(["x"])
        .lagrangian(|_, x, v| (v[0].square() - x[0].square()) / 2.0)
        .integral("amplitude", |_, x, v| v[0].square() + x[0].square())
        .build()
        .unwrap();
    let equations = oscillator.poincare().unwrap();
    let kept = equations.kept(&["amplitude", "energy"]).unwrap();
    let mut motion = equations.compile().unwrap().keep(kept, 0.0, &[3.0, 4.0]).unwrap();
    let mut state = [2.997, 3.996];
    motion.project(0.0, &mut state).unwrap();
    assert!(distance(&state, &[3.0, 4.0]) < 1e-14, "{state:?}");
    // At rest the gradient vanishes, and no direction leads to the level.
    let mut rest = [0.0, 0.0];
    motion.project(0.0, &mut rest).unwrap();
    assert_eq!(rest, [0.0, 0.0]);
}

#[test]
fn new_values_are_kept_after_an_impact() {
    let graph = Graph::new();
    let equations = top(&graph).poincare().unwrap();
    let kept = equations.kept(&["energy"]).unwrap();
    let mut motion = equations.compile().unwrap().keep(kept, 0.0, &START).unwrap();
    let struck: Vec<f64> = START.iter().map(|y| 0.5 * y).collect();
    motion.restart(1.0, &struck);
    let mut state = struck.clone();
    motion.project(1.0, &mut state).unwrap();
    assert_eq!(state, struck);
}

#[test]
fn a_function_that_is_not_an_integral_is_refused() {
    let graph = Graph::new();
    let equations = top(&graph).poincare().unwrap();
    let spin = equations.kept(&["spin"]).unwrap();
    let refused = equations.compile().unwrap().keep(spin, 0.0, &START).unwrap_err();
    // 4 ω̇3 = −ω1 ω2 + 2 γ1 − γ2 = 0.3
    assert_eq!(
        refused.to_string(),
        "`spin` cannot be kept: it changes along the motion, at t = 0 at the rate 0.075"
    );
    let unknown = equations.kept(&["norm", "are"]).unwrap_err();
    assert!(matches!(&unknown, MechError::Integral(IntegralError::Unknown { name, .. }) if name == "are"));
    assert_eq!(
        unknown.to_string(),
        "`are` is not an integral of the system; there are `norm`, `area`, `spin`, `energy`"
    );
}

/// φ̈ = −sin φ − ½ φ̇ from rest: its energy has no rate at the start.
#[test]
fn a_rate_that_vanishes_only_at_the_start_is_detected() {
    let graph = Graph::new();
    let equations = System::builder(&graph)
        .coordinates(["φ"])
        .lagrangian(|_, x, v| v[0].square() / 2.0 + x[0].cos())
        .dissipation(|_, _, v| v[0].square() / 4.0)
        .build()
        .unwrap()
        .poincare()
        .unwrap();
    let kept = equations.kept(&["energy"]).unwrap();
    let refused = equations.compile().unwrap().keep(kept, 0.0, &[1.0, 0.0]).unwrap_err();
    let MechError::Integral(IntegralError::NotAnIntegral { t, rate, .. }) = refused else {
        panic!("{refused}")
    };
    assert!(t > 0.0 && rate < 0.0, "{refused}");
}

/// The part of y⁺ that a constraint forbids is lost; the allowed part is unchanged.
#[test]
fn an_impact_loses_the_velocity_that_a_constraint_forbids() {
    let graph = Graph::new();
    let particle = System::builder(&graph)
        .coordinates(["x", "y"])
        .lagrangian(|_, _, v| (v[0].square() + v[1].square()) / 2.0)
        .build()
        .unwrap();
    let [x, y] = graph.symbols(["x", "y"]);
    let rod = Constraint::new("rod", x.square() + y.square() - 1.0);
    let multipliers = particle.with_multipliers(&[rod]).unwrap();
    let kept = multipliers.kept(&["energy"]).unwrap();
    let mut motion = multipliers.compile().unwrap().keep(kept, 0.0, &[1.0, 0.0, 0.0, 2.0]).unwrap();
    let mut state = [1.0, 0.0, 3.0, 0.5];
    motion.restart(1.0, &state);
    motion.project(1.0, &mut state).unwrap();
    assert!(distance(&state, &[1.0, 0.0, 0.0, 0.5]) < 1e-15, "{state:?}");
}

/// tanh x does not reach −2, and the limit of Newton's method is not a state.
#[test]
fn a_value_that_cannot_be_reached_is_an_error() {
    let graph = Graph::new();
    let equations = System::builder(&graph)
        .coordinates(["x", "y"])
        .lagrangian(|_, _, v| (v[0].square() + v[1].square()) / 2.0)
        .integral("place", |_, x, _| x[0].tanh())
        .build()
        .unwrap()
        .poincare()
        .unwrap();
    let kept = equations.kept(&["place"]).unwrap();
    let mut motion = equations.compile().unwrap().keep(kept, 0.0, &[0.0, 0.0, 0.0, 1.0]).unwrap();
    let mut near = [0.5, 0.0, 0.0, 1.0];
    motion.project(0.0, &mut near).unwrap();
    assert!(near[0].abs() < 1e-15, "{near:?}");
    assert!(motion.project(0.0, &mut [1.2, 0.0, 0.0, 1.0]).is_err());
}

/// Near an equilibrium the energy is flat, and its rounding errors leave the state unchanged.
#[test]
fn rounding_moves_nothing_near_an_equilibrium() {
    let graph = Graph::new();
    let equations = System::builder(&graph)
        .coordinates(["φ"])
        .lagrangian(|_, x, v| {
            v[0].square() / 2.0 + 0.37 * x[0].cos() - 0.7 * (x[0] + 0.3).square() + 0.42 * x[0]
        })
        .build()
        .unwrap()
        .poincare()
        .unwrap();
    let kept = equations.kept(&["energy"]).unwrap();
    let mut motion = equations.compile().unwrap().keep(kept, 0.0, &[1e-8, 0.0]).unwrap();
    let mut state = [3e-9, 1e-8];
    motion.project(0.0, &mut state).unwrap();
    assert!(distance(&state, &[3e-9, 1e-8]) < 1e-10, "{state:?}"); // a hundredth of the motion
}

/// Far from its level an integral that is flat there is reached in many steps, each longer than half of the
/// one before.
#[test]
fn slow_steps_do_not_end_the_iteration() {
    let graph = Graph::new();
    let equations = System::builder(&graph)
        .coordinates(["x", "y"])
        .lagrangian(|_, _, v| (v[0].square() + v[1].square()) / 2.0)
        .integral("power", |_, _, v| (v[0] - 1.0).powi(5))
        .build()
        .unwrap()
        .poincare()
        .unwrap();
    let kept = equations.kept(&["power"]).unwrap();
    let mut motion = equations.compile().unwrap().keep(kept, 0.0, &[0.0, 0.0, 1.2, 0.0]).unwrap();
    let mut state = [0.0, 0.0, 2.5, 0.0];
    motion.project(0.0, &mut state).unwrap();
    assert!((state[2] - 1.2).abs() < 1e-13, "{state:?}");
}

/// A bumper out of contact: its power has no derivative by the exponent there.
#[test]
fn parts_without_a_derivative_are_allowed() {
    let graph = Graph::new();
    let bumpers: [for<'g> fn(Expr<'g>) -> Expr<'g>; 2] =
        [|depth| depth.pow(2.5), |depth| depth.square() * depth.sqrt()];
    for bumper in bumpers {
        let equations = System::builder(&graph)
            .coordinates(["φ"])
            .lagrangian(|_, x, v| {
                v[0].square() / 2.0 + x[0].cos() - 100.0 * bumper((x[0] - 0.5).max(Expr::ZERO))
            })
            .build()
            .unwrap()
            .poincare()
            .unwrap();
        let kept = equations.kept(&["energy"]).unwrap();
        let mut motion = equations.compile().unwrap().keep(kept, 0.0, &[5e-8, 0.0]).unwrap();
        for i in 0..100 {
            let (sin, cos) = (0.1 * f64::from(i)).sin_cos();
            let mut state = [5e-8 * cos, -5e-8 * sin];
            motion.project(0.0, &mut state).unwrap();
            assert!(distance(&state, &[5e-8 * cos, -5e-8 * sin]) < 1e-15, "{state:?}");
        }
    }
}

/// A velocity that a constraint keeps at zero, up to the rounding of a start, does not invalidate the energy.
#[test]
fn rounding_of_a_vanishing_velocity_does_not_count_as_change() {
    let graph = Graph::new();
    let system = System::builder(&graph)
        .coordinates(["x", "y"])
        .lagrangian(|_, x, v| v[0].square() + v[1].square() - x[1].sin())
        .build()
        .unwrap();
    let level = Constraint::new("level", system.quasi_velocities()[1]);
    let held = system.with_multipliers(&[level]).unwrap();
    let start = [0.0, 1.0, 0.5, -1.2e-32];
    let kept = held.kept(&["energy"]).unwrap();
    assert!(held.compile().unwrap().keep(kept, 0.0, &start).is_ok());
    // An actual motion is distinguished from rounding.
    let kept = held.kept(&["energy"]).unwrap();
    let refused = held.compile().unwrap().keep(kept, 0.0, &[0.0, 1.0, 0.5, -1e-8]).map(|_| ()).unwrap_err();
    assert!(matches!(refused, MechError::Integral(IntegralError::NotAnIntegral { .. })), "{refused}");
}

/// The energy is tested along the motion on the constraints: off them, by the errors of steps, their
/// reactions do work.
#[test]
fn energy_is_kept_along_a_steep_curve() {
    let graph = Graph::new();
    let system = System::builder(&graph)
        .coordinates(["x", "y"])
        .lagrangian(|_, x, v| v[0].square() + v[1].square() - x[1])
        .build()
        .unwrap();
    let [x, y] = graph.symbols(["x", "y"]);
    let curve = Constraint::new("curve", y - (20.0 * x).sin() / 4.0);
    let held = system.with_multipliers(&[curve]).unwrap();
    let kept = held.kept(&["energy"]).unwrap();
    let slope = 5.0 * (20.0f64 * 0.1).cos();
    let start = [0.1, (20.0f64 * 0.1).sin() / 4.0, 4.0, 4.0 * slope];
    assert!(held.compile().unwrap().keep(kept, 0.0, &start).is_ok());
}

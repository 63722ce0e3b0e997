//! Time-dependent frames with a drift: a wire that turns, a hoop that turns, a chart that turns.

use pc_mech::{Expr, Graph};
use pc_tests::closed_form::{rotating_oscillator, turning_wire};

use super::definition::assert_definition;
use super::harness::{Description, distance, integrate};
use super::judge::assert_builtin;
use super::shared::TURNING_CHART;

/// A bead on a straight wire through the origin, which turns in a vertical plane with Ω = 1; g = 3. In the redundant
/// coordinates X, Y, with η = (1 + t/2) ṙ.
pub(super) const WIRE: Description = Description {
    coordinates: &["X", "Y"],
    quasi_velocities: &["eta"],
    velocities: |t, x, eta| {
        let along = eta[0] / (1.0 + t / 2.0);
        vec![along * t.cos() - x[1], along * t.sin() + x[0]]
    },
    lagrangian: |t, x, eta| {
        let velocity = (WIRE.velocities)(t, x, eta);
        (velocity[0].square() + velocity[1].square()) / 2.0 - 3.0 * x[1]
    },
};

/// A bead on a hoop of radius 1, which turns about its vertical diameter with Ω = 3; g = 4. In the redundant
/// coordinates X, Y, Z, with η = e^(t/5) θ̇ and θ from the bottom.
pub(super) const HOOP: Description = Description {
    coordinates: &["X", "Y", "Z"],
    quasi_velocities: &["eta"],
    velocities: |t, x, eta| {
        let (sin, cos) = ((3.0 * t).sin(), (3.0 * t).cos());
        let rate = eta[0] * (-t / 5.0).exp();
        vec![
            -x[2] * cos * rate - 3.0 * x[1],
            -x[2] * sin * rate + 3.0 * x[0],
            (x[0] * cos + x[1] * sin) * rate,
        ]
    },
    lagrangian: |t, x, eta| {
        let velocity = (HOOP.velocities)(t, x, eta);
        velocity.iter().map(|v| v.square()).sum::<Expr<'_>>() / 2.0 - 4.0 * x[2]
    },
};

/// r̈ = Ω²r − g sin Ωt
#[test]
fn a_bead_on_a_turning_wire() {
    let graph = Graph::new();
    let system =
        WIRE.builder(&graph).integral("across", |t, x, _| x[0] * t.sin() - x[1] * t.cos()).build().unwrap();
    let t = graph.symbol("t");
    assert_eq!(system.structure().nonzero().collect::<Vec<_>>(), [(0, 1, 1, -1.0 / (2.0 + t))]);

    let mut motion = system.poincare().unwrap().compile().unwrap();
    assert_builtin("turning-wire", &mut motion, &["across"]);

    let times = [0.5, 1.0, 1.5, 2.0, 2.5];
    for (t, y) in times.iter().zip(integrate(&mut motion, &[1.0, 0.0, -0.5], &times)) {
        let expected = turning_wire(*t);
        assert!(distance(&y, &expected) < 1e-9, "t = {t}: {y:?}, not {expected:?}");
    }
}

/// θ̈ = (Ω² cos θ − g) sin θ
#[test]
fn a_bead_on_a_turning_hoop() {
    let graph = Graph::new();
    let system = HOOP
        .builder(&graph)
        .integral("radius", |_, x, _| x[0].square() + x[1].square() + x[2].square())
        .integral("across", |t, x, _| x[0] * (3.0 * t).sin() - x[1] * (3.0 * t).cos())
        .integral("jacobi", |t, x, eta| {
            let rho = x[0] * (3.0 * t).cos() + x[1] * (3.0 * t).sin();
            (eta[0] * (-t / 5.0).exp()).square() / 2.0 - 4.5 * rho.square() + 4.0 * x[2]
        })
        .build()
        .unwrap();
    assert_eq!(system.structure().nonzero().collect::<Vec<_>>(), [(0, 1, 1, Expr::ratio(-1, 5))]);

    let mut motion = system.poincare().unwrap().compile().unwrap();
    assert_builtin("turning-hoop", &mut motion, &["energy", "radius", "across", "jacobi"]);
}

/// The smallest system that knows the sign of c_0s: without it there are no gyroscopic terms.
#[test]
fn an_oscillator_in_a_turning_chart() {
    let graph = Graph::new();
    let system = TURNING_CHART
        .builder(&graph)
        .integral("jacobi", |_, x, eta| {
            let energy = (eta[0].square() + eta[1].square() + x[0].square() + 4.0 * x[1].square()) / 2.0;
            energy - 0.7 * (x[0] * eta[1] - x[1] * eta[0])
        })
        .build()
        .unwrap();
    let omega = Expr::ratio(7, 10);
    assert_eq!(system.structure().nonzero().collect::<Vec<_>>(), [(0, 1, 2, omega), (0, 2, 1, -omega)]);

    let equations = system.poincare().unwrap();
    let [x, y, u, v] = graph.symbols(["X", "Y", "u", "v"]);
    assert_eq!(equations.right_hand_side(), [0.7 * v - x, -0.7 * u - 4.0 * y]);

    let mut motion = equations.compile().unwrap();
    assert_builtin("rotating-oscillator", &mut motion, &["jacobi"]);
    let times = [1.0, 3.0, 8.0];
    for (t, y) in times.iter().zip(integrate(&mut motion, &[1.0, 0.0, 0.0, 1.5], &times)) {
        let expected = rotating_oscillator(*t);
        assert!(distance(&y, &expected) < 1e-9, "t = {t}: {y:?}, not {expected:?}");
    }
}

#[test]
fn rheonomic_systems_are_those_of_the_definition() {
    assert_definition("wire", |graph| WIRE.builder(graph).build().unwrap(), &[1.0, 0.0, -0.5]);
    assert_definition("hoop", |graph| HOOP.builder(graph).build().unwrap(), &[0.5, 0.0, -0.9, 0.2]);
}

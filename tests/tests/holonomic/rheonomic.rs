//! Time-dependent frames with a drift: a wire that turns, a hoop that turns, a chart that turns.

use pc_mech::{Expr, Graph};
use pc_tests::classical::SplitMix64;

use super::definition::assert_definition;
use super::harness::{Description, distance, integrate, normals};
use super::judge::{assert_equations, assert_motion};
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
    let classical = |t: f64, y: &[f64]| {
        let (sin, cos) = t.sin_cos();
        let (distance, stretch) = (y[0] * cos + y[1] * sin, 1.0 + t / 2.0);
        let speed = y[2] / stretch;
        // η = F ṙ, so η̇ = F r̈ + Ḟ ṙ
        vec![cos * speed - y[1], sin * speed + y[0], stretch * (distance - 3.0 * sin) + 0.5 * speed]
    };
    let sample = |random: &mut SplitMix64| {
        let t = random.uniform(0.0, 3.0);
        let [r, eta] = normals(random);
        (t, vec![r * t.cos(), r * t.sin(), eta])
    };
    assert_equations("wire", &mut motion, classical, sample);

    let start = [1.0, 0.0, -0.5];
    let end = [4.062127614161406, -3.034499902007452, -16.68620227861797];
    assert_motion("wire", &mut motion, &start, (2.5, &end), &["across"]);

    let times = [0.5, 1.0, 1.5, 2.0, 2.5];
    for (t, y) in times.iter().zip(integrate(&mut motion, &start, &times)) {
        let r = t.cosh() - 2.0 * t.sinh() + 1.5 * t.sin();
        let speed = t.sinh() - 2.0 * t.cosh() + 1.5 * t.cos();
        let expected = [r * t.cos(), r * t.sin(), (1.0 + t / 2.0) * speed];
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
    // On a hoop of any radius R: R²θ̈ = ρ (−Ω²Z − g), with R sin θ = ρ and R cos θ = −Z.
    let classical = |t: f64, y: &[f64]| {
        let (sin, cos) = (3.0 * t).sin_cos();
        let (rho, growth) = (y[0] * cos + y[1] * sin, (t / 5.0).exp());
        let rate = y[3] / growth;
        let acceleration = rho * (-9.0 * y[2] - 4.0) / (rho * rho + y[2] * y[2]);
        vec![
            -y[2] * cos * rate - 3.0 * y[1],
            -y[2] * sin * rate + 3.0 * y[0],
            rho * rate,
            growth * (acceleration + rate / 5.0),
        ]
    };
    let sample = |random: &mut SplitMix64| {
        let (t, radius, angle) =
            (random.uniform(0.0, 3.0), random.uniform(0.5, 2.0), random.uniform(-3.0, 3.0));
        let rho = radius * angle.sin();
        let place = [rho * (3.0 * t).cos(), rho * (3.0 * t).sin(), -radius * angle.cos()];
        (t, vec![place[0], place[1], place[2], random.normal()])
    };
    assert_equations("hoop", &mut motion, classical, sample);

    let start = [0.5f64.sin(), 0.0, -0.5f64.cos(), 0.2];
    let end = [-0.4293729059559143, 0.3675403740271767, -0.8249563510216384, -1.772882204740696];
    assert_motion("hoop", &mut motion, &start, (5.0, &end), &["radius", "across", "jacobi"]);
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
    let classical = |_: f64, y: &[f64]| {
        vec![y[2] + 0.7 * y[1], y[3] - 0.7 * y[0], 0.7 * y[3] - y[0], -0.7 * y[2] - 4.0 * y[1]]
    };
    assert_equations("chart", &mut motion, classical, |random| (0.0, normals::<4>(random).to_vec()));

    let start = [1.0, 0.0, 0.0, 1.5];
    let end = [-0.4202456629931698, -0.2319376450203162, 0.884420493138732, 0.2972106552854497];
    assert_motion("chart", &mut motion, &start, (8.0, &end), &["jacobi"]);
}

#[test]
fn rheonomic_systems_are_those_of_the_definition() {
    assert_definition("wire", |graph| WIRE.builder(graph).build().unwrap(), &[1.0, 0.0, -0.5]);
    assert_definition("hoop", |graph| HOOP.builder(graph).build().unwrap(), &[0.5, 0.0, -0.9, 0.2]);
}

//! Pendulums in Cartesian coordinates with frames that keep the lengths of their links: n > k.

use pc_mech::{Expr, Graph, LagrangianError, MechError, System};
use pc_tests::closed_form::spherical_pendulum_height;

use super::definition::assert_definition;
use super::harness::{compiled, integrate};
use super::judge::assert_builtin;

// Masses 1 and 2, links of lengths 1 and 0.8, g = 10.
const DOUBLE: [&str; 4] = ["x1", "y1", "x2", "y2"];

fn double_energy<'g>(x: &[Expr<'g>], velocity: &[Expr<'g>]) -> [Expr<'g>; 2] {
    let kinetic =
        (velocity[0].square() + velocity[1].square()) / 2.0 + velocity[2].square() + velocity[3].square();
    [kinetic, 10.0 * (x[1] + 2.0 * x[3])]
}

/// ẋ(x, η)
type Velocities<const N: usize> = for<'g> fn(&[Expr<'g>], &[Expr<'g>]) -> [Expr<'g>; N];

/// The double pendulum in a frame of two fields along its configurations.
fn double_pendulum(graph: &Graph, velocities: Velocities<4>) -> System<'_> {
    System::builder(graph)
        .coordinates(DOUBLE)
        .quasi_velocities(["u", "v"])
        .kinematics(|_, x, eta| velocities(x, eta))
        .lagrangian(|_, x, eta| {
            let [kinetic, potential] = double_energy(x, &velocities(x, eta));
            kinetic - potential
        })
        .integral("first length", |_, x, _| x[0].square() + x[1].square())
        .integral("second length", |_, x, _| (x[2] - x[0]).square() + (x[3] - x[1]).square())
        .build()
        .unwrap()
}

/// η = (ẋ_1, ẋ_2) (14)
const DOUBLE_BY_HORIZONTALS: Velocities<4> = |x, eta| {
    let fall = -x[0] / x[1] * eta[0];
    [eta[0], fall, eta[1], fall - (x[2] - x[0]) / (x[3] - x[1]) * (eta[1] - eta[0])]
};

/// η = (θ̇_1, θ̇_2), without a singular configuration
const DOUBLE_BY_RATES: Velocities<4> = |x, eta| {
    let (p, r) = (x[2] - x[0], x[3] - x[1]);
    let (across, up) = (-x[1] * eta[0], x[0] * eta[0]);
    [across, up, across - r * eta[1], up + p * eta[1]]
};

#[test]
fn a_double_pendulum_by_horizontal_velocities() {
    let graph = Graph::new();
    let system = double_pendulum(&graph, DOUBLE_BY_HORIZONTALS);
    assert_eq!(system.structure().nonzero().count(), 0);
    let mut motion = compiled(&system);
    assert_builtin("double-pendulum-cartesian", &mut motion, &CONSERVED);
}

const CONSERVED: [&str; 3] = ["energy", "first length", "second length"];

#[test]
fn a_double_pendulum_by_the_rates_of_its_links() {
    let graph = Graph::new();
    let system = double_pendulum(&graph, DOUBLE_BY_RATES);
    assert_eq!(system.structure().nonzero().count(), 0);
    let mut motion = compiled(&system);
    assert_builtin("double-pendulum-links", &mut motion, &CONSERVED);
}

/// The spherical pendulum of length 1 with g = 10, in a frame on the spheres about its point of support.
fn spherical_pendulum(graph: &Graph, velocities: Velocities<3>) -> System<'_> {
    System::builder(graph)
        .coordinates(["x", "y", "z"])
        .quasi_velocities(["u", "v"])
        .kinematics(|_, x, eta| velocities(x, eta))
        .lagrangian(|_, x, eta| {
            velocities(x, eta).iter().map(|v| v.square()).sum::<Expr<'_>>() / 2.0 - 10.0 * x[2]
        })
        .integral("length", |_, x, _| x[0].square() + x[1].square() + x[2].square())
        .integral("area", |_, x, eta| {
            let velocity = velocities(x, eta);
            x[0] * velocity[1] - x[1] * velocity[0]
        })
        .build()
        .unwrap()
}

/// η = (ẋ, ẏ) (14)
const SPHERICAL_BY_HORIZONTALS: Velocities<3> =
    |x, eta| [eta[0], eta[1], -(x[0] * eta[0] + x[1] * eta[1]) / x[2]];

/// Unit fields along meridians and parallels of the unit sphere.
const SPHERICAL_BY_MERIDIANS: Velocities<3> = |x, eta| {
    let rho = (x[0].square() + x[1].square()).sqrt();
    [
        (x[0] * x[2] * eta[0] - x[1] * eta[1]) / rho,
        (x[1] * x[2] * eta[0] + x[0] * eta[1]) / rho,
        -rho * eta[0],
    ]
};

#[test]
fn a_spherical_pendulum_by_horizontal_velocities() {
    let graph = Graph::new();
    let system = spherical_pendulum(&graph, SPHERICAL_BY_HORIZONTALS);
    assert_eq!(system.structure().nonzero().count(), 0);
    let mut motion = compiled(&system);
    assert_builtin("spherical-pendulum-cartesian", &mut motion, &["energy", "length", "area"]);
    let times = [0.4, 1.0, 2.0, 3.0];
    for (t, y) in times.iter().zip(integrate(&mut motion, &[0.6, 0.0, -0.8, 0.0, 1.5], &times)) {
        let height = spherical_pendulum_height(*t);
        assert!((y[2] - height).abs() < 1e-9, "t = {t}: z = {}, not {height}", y[2]);
    }
}

/// c_12^2 = −z/ρ.
#[test]
fn a_spherical_pendulum_by_meridians_and_parallels() {
    let graph = Graph::new();
    let system = spherical_pendulum(&graph, SPHERICAL_BY_MERIDIANS);
    let [x, y, z] = graph.symbols(["x", "y", "z"]);
    let rho = (x.square() + y.square()).sqrt();
    let brackets: Vec<_> = system.structure().nonzero().collect();
    assert_eq!(brackets, [(1, 2, 2, -z / rho)]);

    let mut motion = compiled(&system);
    assert_builtin("spherical-pendulum-meridian", &mut motion, &["energy", "length", "area"]);
}

fn cross<'g>(u: &[Expr<'g>], v: &[Expr<'g>]) -> [Expr<'g>; 3] {
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
}

/// ẋ = ω × x: a rotation about x itself moves nothing, so the energy says nothing of its rate.
#[test]
fn a_spherical_pendulum_by_rotations_is_refused() {
    let graph = Graph::new();
    let error = System::builder(&graph)
        .coordinates(["x", "y", "z"])
        .quasi_velocities(["w1", "w2", "w3"])
        .kinematics(|_, x, w| cross(w, x))
        .lagrangian(|_, x, w| cross(w, x).iter().map(|v| v.square()).sum::<Expr<'_>>() / 2.0 - 10.0 * x[2])
        .build()
        .unwrap()
        .poincare()
        .unwrap_err();
    let expected = MechError::Lagrangian(LagrangianError::Degenerate {
        rank: 2,
        size: 3,
        quasi_velocities: vec!["w3".to_owned()],
    });
    assert_eq!(error, expected);
    assert_eq!(
        error.to_string(),
        "the Lagrangian is degenerate: its Hessian in the quasi-velocities has rank 2 of 3, so `w3` is not \
         determined by its equation"
    );
}

#[test]
fn pendulums_are_those_of_the_definition() {
    let double = [0.48, -0.88, 0.17, -1.61, 0.3, 0.1];
    let spherical = [0.6, 0.0, -0.8, 1.0, 1.5];
    assert_definition("double (a)", |graph| double_pendulum(graph, DOUBLE_BY_HORIZONTALS), &double);
    assert_definition("double (b)", |graph| double_pendulum(graph, DOUBLE_BY_RATES), &double);
    assert_definition(
        "spherical (a)",
        |graph| spherical_pendulum(graph, SPHERICAL_BY_HORIZONTALS),
        &spherical,
    );
    assert_definition("spherical (b)", |graph| spherical_pendulum(graph, SPHERICAL_BY_MERIDIANS), &spherical);
}

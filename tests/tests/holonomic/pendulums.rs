//! Pendulums in Cartesian coordinates with frames that keep the lengths of their links: n > k.

use pc_mech::{Expr, Graph, MechError, Motion, System};
use pc_tests::classical::SplitMix64;

use super::definition::assert_definition;
use super::harness::{compiled, normals};
use super::judge::{assert_equations, assert_motion};

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

/// Angular accelerations of the two links at place x and rates w:
/// (m_1 + m_2) |r_1|² θ̈_1 + m_2 r_1·r_2 θ̈_2 = m_2 (r_1 × r_2) θ̇_2² − (m_1 + m_2) g x_1,
/// m_2 r_1·r_2 θ̈_1 + m_2 |r_2|² θ̈_2 = −m_2 (r_1 × r_2) θ̇_1² − m_2 g p.
fn angular_accelerations(x: &[f64], w: [f64; 2]) -> [f64; 2] {
    let (p, r) = (x[2] - x[0], x[3] - x[1]);
    let (along, across) = (x[0] * p + x[1] * r, x[0] * r - x[1] * p);
    let (a, b, c) = (3.0 * (x[0] * x[0] + x[1] * x[1]), 2.0 * along, 2.0 * (p * p + r * r));
    let f = [2.0 * across * w[1] * w[1] - 30.0 * x[0], -2.0 * across * w[0] * w[0] - 20.0 * p];
    let determinant = a * c - b * b;
    [(c * f[0] - b * f[1]) / determinant, (a * f[1] - b * f[0]) / determinant]
}

/// Links of lengths from 0.5 to 1.5, the first at most 1.2 from the vertical, so that no link is horizontal.
fn double_sample(random: &mut SplitMix64) -> (f64, Vec<f64>) {
    let mut link = || (random.uniform(-1.2, 1.2), random.uniform(0.5, 1.5));
    let ((q, l), (s, m)) = (link(), link());
    let (x, y) = (l * q.sin(), -l * q.cos());
    let mut state = vec![x, y, x + m * s.sin(), y - m * s.cos()];
    state.extend(normals::<2>(random));
    (0.0, state)
}

#[test]
fn a_double_pendulum_by_horizontal_velocities() {
    let graph = Graph::new();
    let system = double_pendulum(&graph, DOUBLE_BY_HORIZONTALS);
    assert_eq!(system.structure().nonzero().count(), 0);
    let mut motion = compiled(&system);
    let classical = |_: f64, y: &[f64]| {
        let (p, r) = (y[2] - y[0], y[3] - y[1]);
        let w = [-y[4] / y[1], -(y[5] - y[4]) / r];
        let a = angular_accelerations(y, w);
        let first = -a[0] * y[1] - w[0] * w[0] * y[0];
        let second = first - a[1] * r - w[1] * w[1] * p;
        vec![y[4], y[0] * w[0], y[5], y[0] * w[0] + p * w[1], first, second]
    };
    assert_equations("double pendulum (a)", &mut motion, classical, double_sample);

    let (first, second) = (0.5f64, -0.4f64);
    let start = [
        first.sin(),
        -first.cos(),
        first.sin() + 0.8 * second.sin(),
        -first.cos() - 0.8 * second.cos(),
        0.3 * first.cos(),
        0.3 * first.cos() - 0.2 * 0.8 * second.cos(),
    ];
    let end = [
        0.1075973531859469,
        -0.994194553187342,
        -0.003406053713783327,
        -1.786456027485224,
        2.882067093982383,
        0.04105203743530662,
    ];
    assert_motion("double pendulum (a)", &mut motion, &start, (2.0, &end), &CONSERVED);
}

const CONSERVED: [&str; 3] = ["energy", "first length", "second length"];

#[test]
fn a_double_pendulum_by_the_rates_of_its_links() {
    let graph = Graph::new();
    let system = double_pendulum(&graph, DOUBLE_BY_RATES);
    assert_eq!(system.structure().nonzero().count(), 0);
    let mut motion = compiled(&system);
    let classical = |_: f64, y: &[f64]| {
        let (p, r) = (y[2] - y[0], y[3] - y[1]);
        let a = angular_accelerations(y, [y[4], y[5]]);
        let (across, up) = (-y[1] * y[4], y[0] * y[4]);
        vec![across, up, across - r * y[5], up + p * y[5], a[0], a[1]]
    };
    assert_equations("double pendulum (b)", &mut motion, classical, double_sample);

    let (first, second) = (2.0f64, 1.0f64);
    let start = [
        first.sin(),
        -first.cos(),
        first.sin() + 0.8 * second.sin(),
        -first.cos() - 0.8 * second.cos(),
        0.0,
        0.0,
    ];
    let end = [
        0.9481097084126219,
        -0.3179433610153435,
        1.390369965759976,
        0.3486943702683365,
        0.1756020728610197,
        -0.01873474030024682,
    ];
    assert_motion("double pendulum (b)", &mut motion, &start, (3.0, &end), &CONSERVED);
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

/// r̈ = −g e_z + λ r with λ = (gz − |ṙ|²)/|r|².
fn tension(place: &[f64], velocity: [f64; 3]) -> f64 {
    let square = |v: &[f64]| v.iter().map(|v| v * v).sum::<f64>();
    (10.0 * place[2] - square(&velocity)) / square(&place[..3])
}

fn assert_spherical(name: &str, motion: &mut Motion, classical: impl Fn(f64, &[f64]) -> Vec<f64>) {
    // Below the equator and off the axis, where both frames are regular.
    assert_equations(name, motion, classical, |random| {
        let (angle, rho, z) =
            (random.uniform(-3.0, 3.0), random.uniform(0.3, 1.5), random.uniform(-1.5, -0.3));
        let [u, v] = normals(random);
        (0.0, vec![rho * angle.cos(), rho * angle.sin(), z, u, v])
    });
}

#[test]
fn a_spherical_pendulum_by_horizontal_velocities() {
    let graph = Graph::new();
    let system = spherical_pendulum(&graph, SPHERICAL_BY_HORIZONTALS);
    assert_eq!(system.structure().nonzero().count(), 0);
    let mut motion = compiled(&system);
    assert_spherical("spherical pendulum (a)", &mut motion, |_, y| {
        let rise = -(y[0] * y[3] + y[1] * y[4]) / y[2];
        let lambda = tension(y, [y[3], y[4], rise]);
        vec![y[3], y[4], rise, lambda * y[0], lambda * y[1]]
    });
    let end = [
        -0.3772148967129942,
        -0.4542546847935442,
        -0.8070697634287403,
        1.038123256567866,
        -1.135765451057696,
    ];
    let start = [0.6, 0.0, -0.8, 0.0, 1.5];
    assert_motion("spherical pendulum (a)", &mut motion, &start, (3.0, &end), &["energy", "length", "area"]);
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
    assert_spherical("spherical pendulum (b)", &mut motion, |_, y| {
        let [x, y, z, u, v] = [y[0], y[1], y[2], y[3], y[4]];
        let rho = x.hypot(y);
        vec![
            (x * z * u - y * v) / rho,
            (y * z * u + x * v) / rho,
            -rho * u,
            (z * v * v / rho + 10.0 * rho) / (rho * rho + z * z),
            -z * u * v / rho,
        ]
    });
    let end =
        [-0.4271817087427997, -0.5141819126376677, -0.7437289482276804, 0.5585339047000348, 1.34633533781675];
    let start = [0.6, 0.0, -0.8, 1.0, 1.5];
    assert_motion("spherical pendulum (b)", &mut motion, &start, (3.0, &end), &["energy", "length", "area"]);
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
    let expected =
        MechError::DegenerateLagrangian { rank: 2, size: 3, quasi_velocities: vec!["w3".to_owned()] };
    assert_eq!(error, expected);
    assert_eq!(
        error.to_string(),
        "the Lagrangian is degenerate: its Hessian in the quasi-velocities has rank 2 of 3, so that `w3` is not \
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

//! The free rigid body on SE(3): place r in space, quaternion q, body velocities ω and v.

use std::ops::{Add, Mul, Neg, Sub};

use pc_mech::{Expr, Graph, LieAlgebra, Number, System};
use pc_tests::classical::SplitMix64;

use super::definition::assert_definition;
use super::harness::{compiled, normals};
use super::judge::{assert_builtin, assert_equations, assert_motion};

/// What expressions and numbers have in common here.
trait Real: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Neg<Output = Self> {}
impl Real for f64 {}
impl Real for Expr<'_> {}

/// Columns are the body axes in space, times |q|².
fn rotation<T: Real>(q: &[T]) -> [[T; 3]; 3] {
    let [a, b, c, d] = [q[0], q[1], q[2], q[3]];
    let twice = |x: T| x + x;
    [
        [a * a + b * b - c * c - d * d, twice(b * c - a * d), twice(b * d + a * c)],
        [twice(b * c + a * d), a * a - b * b + c * c - d * d, twice(c * d - a * b)],
        [twice(b * d - a * c), twice(c * d + a * b), a * a - b * b - c * c + d * d],
    ]
}

/// q ⊗ ω, twice the velocity of the quaternion.
fn quaternion_rates<T: Real>(q: &[T], w: &[T]) -> [T; 4] {
    [
        -(q[1] * w[0]) - q[2] * w[1] - q[3] * w[2],
        q[0] * w[0] - q[3] * w[1] + q[2] * w[2],
        q[3] * w[0] + q[0] * w[1] - q[1] * w[2],
        -(q[2] * w[0]) + q[1] * w[1] + q[0] * w[2],
    ]
}

fn dot<T: Real>(u: &[T], v: &[T]) -> T {
    u[0] * v[0] + u[1] * v[1] + u[2] * v[2]
}

fn cross<T: Real>(u: &[T], v: &[T]) -> [T; 3] {
    [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
}

fn times<T: Real>(matrix: &[[T; 3]; 3], v: &[T]) -> [T; 3] {
    matrix.map(|row| dot(&row, v))
}

fn transposed<T: Real>(matrix: &[[T; 3]; 3]) -> [[T; 3]; 3] {
    std::array::from_fn(|i| std::array::from_fn(|j| matrix[j][i]))
}

const COORDINATES: [&str; 7] = ["r1", "r2", "r3", "q0", "q1", "q2", "q3"];
const VELOCITIES: [&str; 6] = ["w1", "w2", "w3", "v1", "v2", "v3"];
const CONSERVED: [&str; 5] = ["energy", "norm", "moment 1", "moment 2", "moment 3"];

/// A body of the given moments of inertia and mass in the force function U(r, R).
fn body<'g>(
    graph: &'g Graph,
    inertia: [f64; 3],
    mass: f64,
    force_function: impl Fn(&[Expr<'g>], &[[Expr<'g>; 3]; 3]) -> Expr<'g>,
) -> System<'g> {
    // r × m R v + R I ω
    let moment = |x: &[Expr<'g>], eta: &[Expr<'g>], i: usize| {
        let axes = rotation(&x[3..]);
        let spin: [Expr<'g>; 3] = std::array::from_fn(|j| inertia[j] * eta[j]);
        cross(x, &times(&axes, &eta[3..]))[i] * mass + times(&axes, &spin)[i]
    };
    System::builder(graph)
        .coordinates(COORDINATES)
        .quasi_velocities(VELOCITIES)
        .kinematics(|_, x, eta| {
            let place = times(&rotation(&x[3..]), &eta[3..]);
            place.into_iter().chain(quaternion_rates(&x[3..], eta).map(|rate| rate / 2.0))
        })
        .lagrangian(|_, x, eta| {
            let turning: Expr<'g> = (0..3).map(|i| inertia[i] * eta[i].square()).sum();
            let moving: Expr<'g> = (3..6).map(|i| mass * eta[i].square()).sum();
            (turning + moving) / 2.0 + force_function(x, &rotation(&x[3..]))
        })
        .integral("norm", |_, x, _| x[3..].iter().map(|q| q.square()).sum())
        .integral("moment 1", |_, x, eta| moment(x, eta, 0))
        .integral("moment 2", |_, x, eta| moment(x, eta, 1))
        .integral("moment 3", |_, x, eta| moment(x, eta, 2))
        .near(
            COORDINATES
                .into_iter()
                .zip([2.0, 0.0, 0.5, 1.0, 0.0, 0.0, 0.0])
                .map(|(name, at)| (graph.symbol(name), at)),
        )
        .build()
        .unwrap()
}

/// [ω_i, ω_j] = ε_ijk ω_k, [ω_i, v_j] = ε_ijk v_k, [v_i, v_j] = 0.
fn se3() -> LieAlgebra {
    let cycles = [(0, 1, 2), (1, 2, 0), (2, 0, 1)];
    let brackets: Vec<_> = cycles
        .into_iter()
        .flat_map(|(i, j, k)| {
            let minus = Number::MINUS_ONE;
            [(i, j, k, Number::ONE), (i, j + 3, k + 3, Number::ONE), (j, i + 3, k + 3, minus)]
        })
        .collect();
    LieAlgebra::from_brackets(6, &brackets).unwrap()
}

fn assert_rigid_body(system: &System<'_>) {
    assert_eq!(system.frame().rank(), 6);
    assert_eq!(system.structure().lie_algebra(), Some(se3()));
    assert!(system.structure().nonzero().all(|(r, ..)| r > 0));
}

/// m(v̇ − v × ω) = RᵀF and Iω̇ = Iω × ω + N, with (F, N) from `load` (r, R).
fn newton_euler(
    inertia: [f64; 3],
    mass: f64,
    load: impl Fn(&[f64], &[[f64; 3]; 3]) -> [[f64; 3]; 2],
) -> impl Fn(f64, &[f64]) -> Vec<f64> {
    move |_, y| {
        let (axes, w, v) = (rotation(&y[3..7]), &y[7..10], &y[10..13]);
        let [force, torque] = load(&y[..3], &axes);
        let pull = times(&transposed(&axes), &force);
        let spin: [f64; 3] = std::array::from_fn(|i| inertia[i] * w[i]);
        let (gyroscopic, turned) = (cross(&spin, w), cross(v, w));
        let mut rates = times(&axes, v).to_vec();
        rates.extend(quaternion_rates(&y[3..7], w).map(|rate| rate / 2.0));
        rates.extend((0..3).map(|i| (gyroscopic[i] + torque[i]) / inertia[i]));
        rates.extend((0..3).map(|i| turned[i] + pull[i] / mass));
        rates
    }
}

/// |q| = 1 and |r| = 2: the forces of the textbooks take the axes to be orthonormal.
fn sample(random: &mut SplitMix64) -> (f64, Vec<f64>) {
    let mut y = normals::<13>(random);
    for (part, length) in [(0..3, 2.0), (3..7, 1.0)] {
        let norm = y[part.clone()].iter().map(|v| v * v).sum::<f64>().sqrt();
        y[part].iter_mut().for_each(|v| *v *= length / norm);
    }
    (0.0, y.to_vec())
}

const ON_SPRING: [f64; 3] = [1.0, 2.0, 3.0];

/// A spring of stiffness 5 from the body's point a to the origin of space.
fn on_a_spring(graph: &Graph) -> System<'_> {
    body(graph, ON_SPRING, 2.0, |r, axes| {
        let end = (0..3).map(|i| r[i] + axes[i][0] * 0.5 + axes[i][2] * 0.25);
        -2.5 * end.map(Expr::square).sum::<Expr<'_>>()
    })
}

#[test]
fn a_body_on_a_spring() {
    let graph = Graph::new();
    let system = on_a_spring(&graph);
    assert_rigid_body(&system);
    let mut motion = compiled(&system);
    let classical = newton_euler(ON_SPRING, 2.0, |r, axes| {
        let arm = [0.5, 0.0, 0.25];
        let offset = times(axes, &arm);
        let force: [f64; 3] = std::array::from_fn(|i| -5.0 * (r[i] + offset[i]));
        [force, cross(&arm, &times(&transposed(axes), &force))]
    });
    assert_equations("spring", &mut motion, classical, sample);

    let start = [1.0, 0.0, 0.5, 1.0, 0.0, 0.0, 0.0, 0.2, 1.0, -0.5, 0.0, 1.0, 0.25];
    let end = [
        -1.140945166148047,
        0.7263254744283224,
        -0.7227663253423252,
        0.3897601027424155,
        -0.01097431943109551,
        -0.1266670633709688,
        -0.9120976272747457,
        0.5008907877012798,
        -0.3061340288325673,
        -0.4985240296966563,
        0.9778134749615663,
        -1.157454528508979,
        -0.02097596715975546,
    ];
    assert_motion("spring", &mut motion, &start, (5.0, &end), &CONSERVED);
}

const IN_ORBIT: [f64; 3] = [0.1, 0.2, 0.25];

/// MacCullagh's potential of a body far from an attracting centre with μ = 1.
fn in_a_gravity_gradient(graph: &Graph) -> System<'_> {
    body(graph, IN_ORBIT, 1.0, |r, axes| {
        let distance = dot(r, r).sqrt();
        let seen = times(&transposed(axes), r);
        let moment: Expr<'_> = (0..3).map(|i| IN_ORBIT[i] * seen[i].square()).sum();
        1.0 / distance + 0.55 / 2.0 / distance.powi(3) - 1.5 * moment / distance.powi(5)
    })
}

#[test]
fn a_body_in_a_gravity_gradient() {
    let graph = Graph::new();
    let system = in_a_gravity_gradient(&graph);
    assert_rigid_body(&system);
    let mut motion = compiled(&system);
    assert_builtin("gravity-gradient", &mut motion, &CONSERVED);
}

#[test]
fn rigid_bodies_are_those_of_the_definition() {
    let centre = [2.0, 0.0, 0.5, 1.0, 0.2, 0.0, 0.0, 0.2, 1.0, -0.5, 0.0, 1.0, 0.25];
    assert_definition("body on a spring", on_a_spring, &centre);
    assert_definition("body in a gravity gradient", in_a_gravity_gradient, &centre);
}

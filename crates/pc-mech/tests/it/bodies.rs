//! Particles and rigid bodies against Lagrangians and equations of motion written by hand.

use crate::common;
use pc_algebra::RigidMotions;
use pc_mech::{
    EulerAngles, Expr, Graph, LagrangianError, LieGroup, Matrix, MechError, Particle, RigidBody, System,
    SystemBuilder, UnitQuaternions, VectorField,
};
use proptest::prelude::*;
use proptest::test_runner::{RngSeed, TestRunner};

type Vector = [f64; 3];

/// Products of numbers of order one, sums of some dozen terms: a few hundred units of rounding of the largest.
const ROUNDING: f64 = 1e-12;

/// Bodies placed by expressions have it as well as those on joints; parameters in it are bound with the others.
#[test]
fn gravity_is_that_of_the_bodies() {
    fn falling<'g>(builder: SystemBuilder<'g>) -> [[Expr<'g>; 3]; 2] {
        let system = builder.build().unwrap();
        [system.gravity(), system.with_parameters_bound().gravity()]
    }
    let graph = Graph::new();
    let [m, g] = graph.symbols(["m", "g"]);
    let particle = || {
        let builder = System::builder(&graph).parameter(m, 1.0).parameter(g, 10.0).coordinates(["x", "y"]);
        builder.particle(|_, x, _| Particle::new(m, [x[0], x[1]]))
    };
    let [symbolic, bound] = falling(particle().gravity(|_| [Expr::ZERO, -g]));
    assert_eq!(symbolic, [Expr::ZERO, -g, Expr::ZERO]);
    assert_eq!(bound, [Expr::ZERO, (-10.0).into(), Expr::ZERO]);
    assert_eq!(falling(particle()), [[Expr::ZERO; 3]; 2]);
}

fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: Vector, b: Vector) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn times(m: [Vector; 3], v: Vector) -> Vector {
    m.map(|row| dot(row, v))
}

fn transposed(m: [Vector; 3]) -> [Vector; 3] {
    std::array::from_fn(|i| std::array::from_fn(|j| m[j][i]))
}

/// |q|² times the rotation of the quaternion.
fn rotation(q: [f64; 4]) -> [Vector; 3] {
    let [a, b, c, d] = q;
    [
        [a * a + b * b - c * c - d * d, 2.0 * (b * c - a * d), 2.0 * (b * d + a * c)],
        [2.0 * (b * c + a * d), a * a - b * b + c * c - d * d, 2.0 * (c * d - a * b)],
        [2.0 * (b * d - a * c), 2.0 * (c * d + a * b), a * a - b * b - c * c + d * d],
    ]
}

/// States of `size` numbers in (−2, 2), the same on every run.
fn states(size: usize, check: impl Fn(Vec<f64>)) {
    let config = ProptestConfig {
        cases: 40,
        rng_seed: RngSeed::Fixed(16),
        failure_persistence: None,
        ..ProptestConfig::default()
    };
    let outcome = TestRunner::new(config).run(&prop::collection::vec(-2.0..2.0, size), |y| {
        check(y);
        Ok(())
    });
    outcome.unwrap();
}

/// The rates of the compiled motion at (t, y).
fn rates(system: &System<'_>) -> impl Fn(f64, &[f64]) -> Vec<f64> + use<> {
    let motion = system.poincare().unwrap().compile().unwrap();
    move |t, y| {
        let mut ydot = vec![0.0; y.len()];
        motion.clone().rhs(t, y, &mut ydot).unwrap();
        ydot
    }
}

fn assert_close(found: &[f64], expected: &[f64], y: &[f64]) {
    let size = expected.iter().fold(1.0f64, |size, v| size.max(v.abs()));
    assert_eq!(found.len(), expected.len());
    for (i, (found, expected)) in found.iter().zip(expected).enumerate() {
        let error = (found - expected).abs() / size;
        assert!(error < ROUNDING, "component {i} at {y:?}: {found} against {expected}");
    }
}

#[test]
fn two_particles_make_the_double_pendulum() {
    let graph = Graph::new();
    let [m1, m2, l1, l2, g] = graph.symbols(["m1", "m2", "l1", "l2", "g"]);
    let [a, b, a_rate, b_rate] = graph.symbols(["α", "β", "α'", "β'"]);
    let upper = [l1 * a.sin(), -l1 * a.cos()];
    let lower = [upper[0] + l2 * b.sin(), upper[1] - l2 * b.cos()];
    let bodies = System::builder(&graph)
        .coordinates(["α", "β"])
        .particle(|_, _, _| Particle::new(m1, upper))
        .particle(|_, _, _| Particle::new(m2, lower))
        .potential(|_, _, _| g * (m1 * upper[1] + m2 * lower[1]))
        .build()
        .unwrap();
    let kinetic = (m1 + m2) * l1.square() * a_rate.square() / 2.0
        + m2 * l2.square() * b_rate.square() / 2.0
        + m2 * l1 * l2 * a_rate * b_rate * (a - b).cos();
    let by_hand = kinetic + (m1 + m2) * g * l1 * a.cos() + m2 * g * l2 * b.cos();
    assert_eq!(bodies.lagrangian(), by_hand);

    // The weights as forces: the same equations.
    let weighed = System::builder(&graph)
        .coordinates(["α", "β"])
        .particle(|_, _, _| Particle::new(m1, upper).force([0.into(), -m1 * g]))
        .particle(|_, _, _| Particle::new(m2, lower).force([0.into(), -m2 * g]))
        .build()
        .unwrap();
    assert_eq!(weighed.lagrangian(), by_hand);
    assert_eq!(weighed.forces(), [Expr::ZERO; 2]);
    let (one, other) = (bodies.poincare().unwrap(), weighed.poincare().unwrap());
    assert_eq!(one.right_hand_side(), other.right_hand_side());
}

const INERTIA: Vector = [2.0, 3.0, 4.0];
const CENTRE: Vector = [0.1, 0.2, 0.3];
const WEIGHT: f64 = 10.0;

/// I ω̇ = Iω × ω + mg γ × r
fn top_acceleration(vertical: Vector, omega: Vector) -> Vector {
    let momentum = std::array::from_fn(|i| INERTIA[i] * omega[i]);
    let (gyroscopic, arm) = (cross(momentum, omega), cross(vertical, CENTRE));
    std::array::from_fn(|i| (gyroscopic[i] + WEIGHT * arm[i]) / INERTIA[i])
}

/// The height of the mass centre: r · γ, γ the last row of R.
fn height<'g>(rotation: &Matrix<Expr<'g>>) -> Expr<'g> {
    CENTRE.iter().zip(&*rotation.row(2)).map(|(&r, &gamma)| r * gamma).sum()
}

#[test]
fn the_heavy_top_in_eulers_angles() {
    let graph = Graph::new();
    let angles = EulerAngles::about("zxz").unwrap();
    let system = common::in_eulers_angles(&graph)
        .rigid_body(|_, x, _| RigidBody::rotating(5, [0; 3], INERTIA, angles.rotation_matrix(x)))
        .potential(|_, x, _| WEIGHT * height(&angles.rotation_matrix(x)))
        .build()
        .unwrap();
    let [w1, w2, w3] = graph.symbols(["ω1", "ω2", "ω3"]);
    let kinetic = w1.square() + 1.5 * w2.square() + 2.0 * w3.square();
    assert_eq!(
        system.lagrangian() + WEIGHT * height(&angles.rotation_matrix(&graph.symbols(["ψ", "θ", "φ"]))),
        kinetic
    );
    let rates = rates(&system);
    states(6, |mut y| {
        y[1] = 1.5 + y[1] / 2.0; // away from the poles
        let (theta, phi) = (y[1], y[2]);
        let vertical = [theta.sin() * phi.sin(), theta.sin() * phi.cos(), theta.cos()];
        assert_close(&rates(0.0, &y)[3..], &top_acceleration(vertical, [y[3], y[4], y[5]]), &y);
    });
}

/// On the sphere and off it, where gravity is scaled by |q|².
#[test]
fn the_heavy_top_with_a_quaternion() {
    let graph = Graph::new();
    let q = graph.symbols(["q0", "q1", "q2", "q3"]);
    let builder = || {
        System::builder(&graph)
            .coordinates(["q0", "q1", "q2", "q3"])
            .quasi_velocities(["ω1", "ω2", "ω3"])
            .frame(UnitQuaternions.left_frame(&graph, graph.symbol("t"), q.to_vec()).unwrap())
            .rigid_body(|_, x, _| RigidBody::rotating(5, [0; 3], INERTIA, UnitQuaternions.rotation_matrix(x)))
    };
    let [w1, w2, w3] = graph.symbols(["ω1", "ω2", "ω3"]);
    let free = builder().build().unwrap();
    assert_eq!(free.lagrangian(), w1.square() + 1.5 * w2.square() + 2.0 * w3.square());
    let heavy =
        builder().potential(|_, x, _| WEIGHT * height(&UnitQuaternions.rotation_matrix(x))).build().unwrap();
    let rates = rates(&heavy);
    states(7, |y| {
        let vertical = rotation([y[0], y[1], y[2], y[3]])[2];
        assert_close(&rates(0.0, &y)[4..], &top_acceleration(vertical, [y[4], y[5], y[6]]), &y);
    });
}

/// The same top by its mass centre and the inertia about that, I_0 = I − m (r² 1 − r rᵀ), under its weight.
#[test]
fn a_body_may_be_given_by_its_mass_centre() {
    let graph = Graph::new();
    let angles = EulerAngles::about("zxz").unwrap();
    let mass = 0.8;
    let [x, y, z] = CENTRE;
    let central = [
        INERTIA[0] - mass * (y * y + z * z),
        INERTIA[1] - mass * (z * z + x * x),
        INERTIA[2] - mass * (x * x + y * y),
        mass * x * y,
        mass * y * z,
        mass * z * x,
    ];
    let system = common::in_eulers_angles(&graph)
        .rigid_body(|_, x, _| {
            let r = angles.rotation_matrix(x);
            let place = (0..3).map(|i| CENTRE.iter().zip(&*r.row(i)).map(|(&c, &r)| c * r).sum::<Expr<'_>>());
            RigidBody::rotating(mass, place, central, r.clone()).force([0.0, 0.0, -WEIGHT])
        })
        .build()
        .unwrap();
    let rates = rates(&system);
    states(6, |mut y| {
        y[1] = 1.5 + y[1] / 2.0;
        let (theta, phi) = (y[1], y[2]);
        let vertical = [theta.sin() * phi.sin(), theta.sin() * phi.cos(), theta.cos()];
        assert_close(&rates(0.0, &y)[3..], &top_acceleration(vertical, [y[3], y[4], y[5]]), &y);
    });
}

/// A free rigid body on SE(3), coordinates (q, r), quasi-velocities (ω, v) along body axes.
fn free<'g>(graph: &'g Graph) -> SystemBuilder<'g> {
    let names = ["q0", "q1", "q2", "q3", "x", "y", "z"];
    System::builder(graph)
        .coordinates(names)
        .quasi_velocities(["ω1", "ω2", "ω3", "v1", "v2", "v3"])
        .frame(RigidMotions.left_frame(graph, graph.symbol("t"), graph.symbols(names).to_vec()).unwrap())
}

/// R as rows of expressions applied to a vector.
fn turned<'g>(rotation: &Matrix<Expr<'g>>, v: [Expr<'g>; 3]) -> [Expr<'g>; 3] {
    std::array::from_fn(|i| rotation.row(i).iter().zip(v).map(|(&r, v)| r * v).sum())
}

fn crossed<'g>(a: [Expr<'g>; 3], b: [Expr<'g>; 3]) -> [Expr<'g>; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn scalar<'g>(a: [Expr<'g>; 3], b: [Expr<'g>; 3]) -> Expr<'g> {
    a.into_iter().zip(b).map(|(a, b)| a * b).sum()
}

/// A body of mass `m` with the moments of inertia `inertia` against m(v̇ − v × ω) = RᵀF, I ω̇ = Iω × ω + N.
fn assert_newton_euler(
    system: &System<'_>,
    (m, inertia): (f64, Vector),
    load: impl Fn(Vector, [Vector; 3]) -> (Vector, Vector),
) {
    let rates = rates(system);
    states(13, |mut y| {
        let norm = y[..4].iter().map(|q| q * q).sum::<f64>().sqrt();
        y[..4].iter_mut().for_each(|q| *q /= norm);
        y[4] += 4.0; // away from the centre of attraction
        let rotation = rotation([y[0], y[1], y[2], y[3]]);
        let (omega, v) = ([y[7], y[8], y[9]], [y[10], y[11], y[12]]);
        let (force, torque) = load([y[4], y[5], y[6]], rotation);
        let momentum = std::array::from_fn(|i| inertia[i] * omega[i]);
        let (turning, drag, pull) =
            (cross(momentum, omega), cross(v, omega), times(transposed(rotation), force));
        let mut expected = times(rotation, v).to_vec();
        expected.extend((0..3).map(|i| (turning[i] + torque[i]) / inertia[i]));
        expected.extend((0..3).map(|i| drag[i] + pull[i] / m));
        assert_close(&rates(0.0, &y)[4..], &expected, &y);
    });
}

#[test]
fn a_free_body_on_a_spring() {
    const M: f64 = 2.0;
    const I: Vector = [1.0, 2.0, 3.0];
    const A: Vector = [0.5, 0.0, 0.25];
    const K: f64 = 5.0;
    let graph = Graph::new();
    let a = A.map(Expr::from);
    let by_potential = free(&graph)
        .rigid_body(|_, x, _| RigidBody::rotating(M, x[4..].to_vec(), I, UnitQuaternions.rotation_matrix(x)))
        .potential(|_, x, _| {
            let arm = turned(&UnitQuaternions.rotation_matrix(x), a);
            (0..3).map(|i| (x[4 + i] + arm[i]).square()).sum::<Expr<'_>>() * K / 2.0
        })
        .build()
        .unwrap();
    let by_load = free(&graph)
        .rigid_body(|_, x, _| {
            let r = UnitQuaternions.rotation_matrix(x);
            let arm = turned(&r, a);
            let force: [Expr<'_>; 3] = std::array::from_fn(|i| -K * (x[4 + i] + arm[i]));
            let torque = crossed(a, turned(&r.transpose(), force));
            RigidBody::rotating(M, x[4..].to_vec(), I, r).force(force).torque(torque)
        })
        .build()
        .unwrap();
    let load = |place: Vector, r: [Vector; 3]| {
        let arm = times(r, A);
        let force = std::array::from_fn(|i| -K * (place[i] + arm[i]));
        (force, cross(A, times(transposed(r), force)))
    };
    assert_newton_euler(&by_potential, (M, I), load);
    assert_newton_euler(&by_load, (M, I), load);
}

/// MacCullagh's potential: U = m/ρ + tr I/(2ρ³) − 3 r·RIRᵀr/(2ρ⁵).
#[test]
fn a_satellite_under_the_gradient_of_gravity() {
    const M: f64 = 1.0;
    const I: Vector = [0.1, 0.2, 0.25];
    let trace: f64 = I.iter().sum();
    let graph = Graph::new();
    let by_potential = free(&graph)
        .rigid_body(|_, x, _| RigidBody::turning(M, x[4..].to_vec(), I, graph.symbols(["ω1", "ω2", "ω3"])))
        .lagrangian(|_, x, _| {
            let place = [x[4], x[5], x[6]];
            let body = turned(&UnitQuaternions.rotation_matrix(x).transpose(), place);
            let rho = scalar(place, place).sqrt();
            let quadratic = scalar(body, std::array::from_fn(|i| I[i] * body[i]));
            M / rho + trace / (2.0 * rho.powi(3)) - 3.0 * quadratic / (2.0 * rho.powi(5))
        })
        .build()
        .unwrap();
    let by_load = free(&graph)
        .rigid_body(|_, x, eta| {
            let (r, place) = (UnitQuaternions.rotation_matrix(x), [x[4], x[5], x[6]]);
            let rho = scalar(place, place).sqrt();
            let n = place.map(|x| x / rho);
            let body = turned(&r.transpose(), n);
            let moment: [Expr<'_>; 3] = std::array::from_fn(|i| I[i] * body[i]);
            let along = M / rho.square() + 1.5 * (trace - 5.0 * scalar(body, moment)) / rho.powi(4);
            let across = turned(&r, moment);
            let force: [Expr<'_>; 3] = std::array::from_fn(|i| -along * n[i] - 3.0 * across[i] / rho.powi(4));
            let torque = crossed(body, moment).map(|x| 3.0 * x / rho.powi(3));
            RigidBody::turning(M, place, I, [eta[0], eta[1], eta[2]]).force(force).torque(torque)
        })
        .build()
        .unwrap();
    let load = |place: Vector, r: [Vector; 3]| {
        let rho = dot(place, place).sqrt();
        let n = place.map(|x| x / rho);
        let body = times(transposed(r), n);
        let moment = std::array::from_fn(|i| I[i] * body[i]);
        let along = M / rho.powi(2) + 1.5 * (trace - 5.0 * dot(body, moment)) / rho.powi(4);
        let across = times(r, moment);
        let force = std::array::from_fn(|i| -along * n[i] - 3.0 * across[i] / rho.powi(4));
        (force, cross(body, moment).map(|x| 3.0 * x / rho.powi(3)))
    };
    assert_newton_euler(&by_potential, (M, I), load);
    assert_newton_euler(&by_load, (M, I), load);
}

/// A ladder in the plane, given by its rotation about z and by φ'; the mixed moments about z do not matter.
#[test]
fn bodies_in_the_plane() {
    let graph = Graph::new();
    let [m, j, l, phi, rate, s, s_rate] = graph.symbols(["m", "J", "l", "φ", "φ'", "s", "s'"]);
    let place = [s + l * phi.cos(), l * phi.sin()];
    let inertia = [0.into(), 0.into(), j];
    let builder = || System::builder(&graph).coordinates(["s", "φ"]);
    let about_z = Matrix::from_fn(3, 3, |i, k| match (i, k) {
        (2, 2) => Expr::ONE,
        (2, _) | (_, 2) => Expr::ZERO,
        (0, 1) => -phi.sin(),
        (1, 0) => phi.sin(),
        _ => phi.cos(),
    });
    let by_turn = builder().rigid_body(|_, _, _| RigidBody::rotating(m, place, inertia, about_z));
    let by_rate =
        builder().rigid_body(|_, _, v| RigidBody::turning(m, place, inertia, [Expr::ZERO, 0.into(), v[1]]));
    let expected = m * (s_rate.square() + l.square() * rate.square()) / 2.0
        - m * l * phi.sin() * s_rate * rate
        + j * rate.square() / 2.0;
    for builder in [by_turn, by_rate] {
        assert_eq!(builder.build().unwrap().lagrangian(), expected);
    }
}

/// A wire that turns in a vertical plane with unit angular velocity, in the distance s, and in X, Y with η = F ṡ,
/// F = 1 + t/2: s̈ = s − g sin t.
#[test]
fn a_bead_on_a_turning_wire() {
    let graph = Graph::new();
    let g = 3.0;
    let [s, s_rate] = graph.symbols(["s", "s'"]);
    let along = System::builder(&graph)
        .coordinates(["s"])
        .particle(|t, x, _| Particle::new(1, [x[0] * t.cos(), x[0] * t.sin()]).force([0.0, -g]))
        .build()
        .unwrap();
    let t = graph.symbol("t");
    assert_eq!(along.lagrangian(), (s_rate.square() + s.square()) / 2.0 - g * s * t.sin());
    assert_eq!(along.forces(), [Expr::ZERO]);

    let redundant = System::builder(&graph)
        .particle(|_, _, _| {
            let [x, y] = graph.symbols(["X", "Y"]);
            Particle::new(1, [x, y]).force([0.0, -g])
        })
        .coordinates(["X", "Y"])
        .quasi_velocities(["η"])
        .kinematics(|t, x, eta| {
            let rate = eta[0] / (1.0 + t / 2.0);
            [rate * t.cos() - x[1], rate * t.sin() + x[0]]
        })
        .build()
        .unwrap();
    let rates = rates(&redundant);
    states(3, |y| {
        let (t, s, eta) = (2.0 + y[0], y[1], y[2]);
        let f = 1.0 + t / 2.0;
        let found = rates(t, &[s * t.cos(), s * t.sin(), eta]);
        assert_close(&found[2..], &[eta / (2.0 * f) + f * (s - g * t.sin())], &y);
    });
}

/// A disk on a turntable: ω = Ω + φ', from the rotation Ωt + φ and from φ' in the rotating axes.
#[test]
fn a_turn_that_depends_on_time() {
    let graph = Graph::new();
    let [j, omega, rate, torque] = graph.symbols(["J", "Ω", "φ'", "N"]);
    let angles = EulerAngles::about("zxz").unwrap();
    let disk = System::builder(&graph)
        .coordinates(["φ"])
        .rigid_body(|t, x, _| {
            let turn = angles.rotation_matrix(&[omega * t, 0.into(), x[0]]);
            RigidBody::rotating(1, [0; 3], [j; 3], turn).torque([Expr::ZERO, 0.into(), torque])
        })
        .build()
        .unwrap();
    assert_eq!(disk.lagrangian(), j * (omega + rate).square() / 2.0);
    assert_eq!(disk.forces(), [torque]);
}

/// Velocities x' in a force and in ω are expressed by the frame.
#[test]
fn velocities_of_coordinates_stand_for_the_frame() {
    let graph = Graph::new();
    let [u, v, x, t] = graph.symbols(["u", "v", "x", "t"]);
    let [x_rate, y_rate, y] = graph.symbols(["x'", "y'", "y"]);
    let system = common::driven(&graph)
        .rigid_body(|_, x, _| {
            RigidBody::turning(1, [x[0]], [0, 0, 1], [Expr::ZERO, 0.into(), y_rate]).force([-x_rate])
        })
        .build()
        .unwrap();
    let along_x = u * (1.0 + t.square()) + t * y;
    let along_y = v * x - t * u + x.square();
    assert_eq!(system.lagrangian(), (along_x.square() + along_y.square()) / 2.0);
    assert_eq!(system.forces(), [-along_x * (1.0 + t.square()), 0.into()]);
}

#[test]
fn invalid_bodies_are_refused() {
    let graph = Graph::new();
    let [rate, x_rate] = graph.symbols(["w", "x'"]);
    let builder = || {
        System::builder(&graph).coordinates(["x"]).quasi_velocities(["w"]).kinematics(|_, x, w| [x[0] * w[0]])
    };
    let refused = |builder: SystemBuilder<'_>| builder.build().unwrap_err().to_string();
    let of_particle = |particle| refused(builder().particle(|_, _, _| particle));
    let of_body = |body| refused(builder().rigid_body(|_, _, _| body));
    assert_eq!(
        of_particle(Particle::new(1, [rate])),
        "the position of a body may depend on time and coordinates only, but depends on `w`"
    );
    assert_eq!(
        of_particle(Particle::new(x_rate, [1])),
        "the mass of a body may depend on time and coordinates only, but depends on `x'`"
    );
    assert_eq!(
        of_particle(Particle::new(1, [1, 2]).force([1])),
        "the force on a body has 1 entries where 2 are needed"
    );
    let square = |n| Matrix::from_fn(n, n, |_, _| rate);
    assert_eq!(
        of_body(RigidBody::rotating(1, [0], [1; 3], square(2))),
        "the list of rows of the rotation of a body has 2 entries where 3 are needed"
    );
    assert_eq!(
        of_body(RigidBody::rotating(1, [0], [1; 3], square(3))),
        "the rotation of a body may depend on time and coordinates only, but depends on `w`"
    );
    assert_eq!(
        of_body(RigidBody::turning(1, [0], [rate; 3], [1; 3])),
        "the inertia of a body may depend on time and coordinates only, but depends on `w`"
    );
    assert_eq!(
        of_body(RigidBody::turning(1, [0], [1; 3], [Expr::ZERO, x_rate * rate, 0.into()])),
        "an angular velocity must be affine in the quasi-velocities; its component `w^2*x` is not"
    );
    assert!(matches!(
        System::builder(&graph).coordinates(["x"]).build(),
        Err(MechError::Lagrangian(LagrangianError::Missing))
    ));
}

/// One sign wrong in a rotation about an axis, a column too long, a reflection.
#[test]
fn a_matrix_that_is_not_a_rotation_is_refused() {
    let refused = |entries: fn(Expr<'static>) -> [[Expr<'static>; 3]; 3]| {
        let graph: &'static Graph = Box::leak(Box::new(Graph::new()));
        let rotation = entries(graph.symbol("φ"));
        let rotation = Matrix::from_fn(3, 3, |i, j| rotation[i][j]);
        let body = RigidBody::rotating(1.0, [Expr::ZERO; 3], [0.1, 0.2, 0.3], rotation);
        let system = System::builder(graph).coordinates(["φ"]).rigid_body(|_, _, _| body).build();
        system.map(|_| ()).unwrap_err().to_string()
    };
    assert_eq!(
        refused(|phi| [
            [phi.cos(), Expr::ZERO, phi.sin()],
            [Expr::ZERO, Expr::ONE, Expr::ZERO],
            [phi.sin(), Expr::ZERO, phi.cos()]
        ]),
        "the matrix of a body is not a rotation: its columns 1 and 3 are not orthogonal and of equal length; the defect is \
         `2*cos(φ)*sin(φ)`"
    );
    assert_eq!(
        refused(|phi| [
            [phi.cos(), -phi.sin(), Expr::ZERO],
            [phi.sin(), phi.cos(), Expr::ZERO],
            [Expr::ZERO, Expr::ZERO, 2.into()]
        ]),
        "the matrix of a body is not a rotation: its columns 1 and 3 are not orthogonal and of equal length; the defect is `-3`"
    );
    assert_eq!(
        refused(|phi| [
            [phi.cos(), phi.sin(), Expr::ZERO],
            [phi.sin(), -phi.cos(), Expr::ZERO],
            [Expr::ZERO, Expr::ZERO, Expr::ONE]
        ]),
        "the rotation of a body is a reflection: its determinant is -1"
    );
}

/// A particle of unit mass in space under a force.
fn pushed<'g>(graph: &'g Graph, force: [Expr<'g>; 3]) -> System<'g> {
    let place = graph.symbols(["x", "y", "z"]);
    System::builder(graph)
        .parameter(graph.symbol("k"), 2.0)
        .coordinates(["x", "y", "z"])
        .particle(|_, _, _| Particle::new(1.0, place).force(force))
        .build()
        .unwrap()
}

/// Its energy at rest.
fn potential<'g>(system: &System<'g>) -> Expr<'g> {
    let still: Vec<_> = system.quasi_velocities().iter().map(|&v| (v, Expr::ZERO)).collect();
    system.graph().substitute(&[system.energy()], &still)[0]
}

/// A force that depends on the place alone, and is homogeneous in it, has a force function if its work is
/// exact; otherwise it counts as a force.
#[test]
fn forces_that_have_a_force_function_count_in_the_energy() {
    let graph = Graph::new();
    let [k, x, y, z] = graph.symbols(["k", "x", "y", "z"]);
    let place = [x, y, z];
    let system = |force| pushed(&graph, force);
    let square = x.square() + y.square() + z.square();
    let weight = system([Expr::ZERO, Expr::ZERO, -k]);
    assert_eq!(potential(&weight), k * z);
    let spring = system(place.map(|x| -k * x));
    assert!((potential(&spring) - k * square / 2.0).is_zero());
    let gravitation = system(place.map(|x| -k * x / square.pow(1.5)));
    assert!((potential(&gravitation) + k / square.sqrt()).is_zero());
    for conservative in [weight, spring, gravitation] {
        assert!(conservative.forces().iter().all(|q| q.is_zero()));
        assert!(conservative.energy_rate().is_zero());
    }
    let t = graph.symbol("t");
    let vx = graph.symbol("x'");
    // A force around an axis, one across a gradient, one of time, one of velocity.
    for force in [
        [-y, x, Expr::ZERO],
        [k * y, Expr::ZERO, Expr::ZERO],
        [t, Expr::ZERO, Expr::ZERO],
        [-vx, x * vx, -z * t],
    ] {
        let driven = system(force);
        assert_eq!(driven.forces(), force);
        assert!(potential(&driven).is_zero());
    }
    // Weight together with drag.
    let dragged = system([-vx, Expr::ZERO, -k]);
    assert_eq!(dragged.forces(), [-vx, Expr::ZERO, Expr::ZERO]);
    assert_eq!(potential(&dragged), k * z);
}

/// A uniform force and a spring keep their force functions in a frame with an irrational coefficient, whose
/// products are rounded.
#[test]
fn rounded_coefficients_leave_a_force_its_force_function() {
    let graph = Graph::new();
    let h = graph.symbol("h");
    let height = -0.23 * h;
    for (force, function) in [(Expr::ONE, height), (-2.0 * height, -height.square())] {
        let system = System::builder(&graph)
            .coordinates(["φ", "h"])
            .quasi_velocities(["ω"])
            // h = √(2 φ)
            .kinematics(|_, x, eta| [eta[0], Expr::from(2.0).sqrt() * x[0].sqrt() / (2.0 * x[0]) * eta[0]])
            .particle(|_, _, _| Particle::new(1.0, [Expr::ZERO, height]).force([Expr::ZERO, force]))
            .build()
            .unwrap();
        assert_eq!(system.forces(), [Expr::ZERO], "{force}");
        assert!((potential(&system) + function).is_zero(), "{}", potential(&system));
        assert!(system.energy_rate().is_zero());
    }
}

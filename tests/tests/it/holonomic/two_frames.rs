//! The same motion in two frames, and under a change of gauge.

use pc_mech::{Equations, Expr, Folding, Graph, LieAlgebra, System};
use pc_tests::classical::SplitMix64;
use pc_tests::reference::reference;

use super::definition::assert_definition;
use super::harness::{Description, STATES, distance, integrate, normals, rates};
use super::shared::{CHARGE, SCALED_OSCILLATOR, TURNING_CHART};

/// Two integrations at rtol = 1e-12, whose errors the motions magnify some ten times.
const ARRIVAL: f64 = 1e-9;
/// Right-hand sides of terms of order ten that are arranged in two ways.
const ROUNDING: f64 = 1e-11;

// The heavy top with I = (2, 3, 4), r = (0.1, 0.2, 0.3), mg = 10.
fn top_lagrangian<'g>(vertical: &[Expr<'g>], w: &[Expr<'g>]) -> Expr<'g> {
    let kinetic = w[0].square() + 1.5 * w[1].square() + 2.0 * w[2].square();
    kinetic - vertical[0] - 2.0 * vertical[1] - 3.0 * vertical[2]
}

fn vertical_of_angles<'g>(x: &[Expr<'g>]) -> [Expr<'g>; 3] {
    [x[1].sin() * x[2].sin(), x[1].sin() * x[2].cos(), x[1].cos()]
}

fn vertical_of_quaternion<'g>(q: &[Expr<'g>]) -> [Expr<'g>; 3] {
    [
        2.0 * (q[1] * q[3] - q[0] * q[2]),
        2.0 * (q[2] * q[3] + q[0] * q[1]),
        q[0].square() - q[1].square() - q[2].square() + q[3].square(),
    ]
}

/// Euler's angles 3-1-3 and the angular velocity on the body's axes.
const TOP_IN_ANGLES: Description = Description {
    coordinates: &["psi", "theta", "phi"],
    quasi_velocities: &["w1", "w2", "w3"],
    velocities: |_, x, w| {
        let across = w[0] * x[2].sin() + w[1] * x[2].cos();
        vec![across / x[1].sin(), w[0] * x[2].cos() - w[1] * x[2].sin(), w[2] - x[1].cot() * across]
    },
    lagrangian: |_, x, w| top_lagrangian(&vertical_of_angles(x), w),
};

const TOP_IN_QUATERNION: Description = Description {
    coordinates: &["q0", "q1", "q2", "q3"],
    quasi_velocities: &["w1", "w2", "w3"],
    velocities: |_, q, w| {
        vec![
            (-q[1] * w[0] - q[2] * w[1] - q[3] * w[2]) / 2.0,
            (q[0] * w[0] - q[3] * w[1] + q[2] * w[2]) / 2.0,
            (q[3] * w[0] + q[0] * w[1] - q[1] * w[2]) / 2.0,
            (-q[2] * w[0] + q[1] * w[1] + q[0] * w[2]) / 2.0,
        ]
    },
    lagrangian: |_, q, w| top_lagrangian(&vertical_of_quaternion(q), w),
};

const TOP_IN_VERTICAL: Description = Description {
    coordinates: &["g1", "g2", "g3"],
    quasi_velocities: &["w1", "w2", "w3"],
    velocities: |_, g, w| {
        vec![g[1] * w[2] - g[2] * w[1], g[2] * w[0] - g[0] * w[2], g[0] * w[1] - g[1] * w[0]]
    },
    lagrangian: |_, g, w| top_lagrangian(g, w),
};

#[test]
fn a_heavy_top_in_three_charts() {
    let times = [0.5, 1.0, 2.0, 3.5, 5.0];
    let w = [0.2, -0.3, 1.5];
    let (theta, phi) = (1.0f64, 0.3f64);
    let half = (theta / 2.0, phi / 2.0);
    let angles = vec![0.0, theta, phi];
    let quaternion = vec![
        half.0.cos() * half.1.cos(),
        half.0.sin() * half.1.cos(),
        -half.0.sin() * half.1.sin(),
        half.0.cos() * half.1.sin(),
    ];
    let vertical = vec![theta.sin() * phi.sin(), theta.sin() * phi.cos(), theta.cos()];

    let run = |description: Description, start: &[f64], given: bool| {
        let graph = Graph::new();
        let builder = description.builder(&graph);
        let builder = if given { builder.algebra(&LieAlgebra::so3()) } else { builder };
        let system = builder.build().unwrap();
        assert_eq!(system.structure().lie_algebra(), Some(LieAlgebra::so3()));
        let mut motion = system.poincare().unwrap().compile().unwrap();
        integrate(&mut motion, &[start, &w].concat(), &times)
    };
    let by_angles = run(TOP_IN_ANGLES, &angles, false);
    let by_quaternion = run(TOP_IN_QUATERNION, &quaternion, false);
    let by_vertical = run(TOP_IN_VERTICAL, &vertical, true);
    let end = reference("heavy-top-euler").unwrap().state;
    assert!(distance(by_angles.last().unwrap(), end) < ARRIVAL, "{by_angles:?}, not {end:?}");
    for i in 0..times.len() {
        let (a, q) = (&by_angles[i], &by_quaternion[i]);
        let of_angles = [a[1].sin() * a[2].sin(), a[1].sin() * a[2].cos(), a[1].cos(), a[3], a[4], a[5]];
        let of_quaternion = [
            2.0 * (q[1] * q[3] - q[0] * q[2]),
            2.0 * (q[2] * q[3] + q[0] * q[1]),
            q[0] * q[0] - q[1] * q[1] - q[2] * q[2] + q[3] * q[3],
            q[4],
            q[5],
            q[6],
        ];
        for other in [of_angles, of_quaternion] {
            let error = distance(&other, &by_vertical[i]);
            assert!(error < ARRIVAL, "t = {}: {other:?}, not {:?}", times[i], by_vertical[i]);
        }
    }
}

/// r, θ, φ with the velocities along them.
const SPHERICAL: Description = Description {
    coordinates: &["r", "theta", "phi"],
    quasi_velocities: &["u", "v", "w"],
    velocities: |_, x, eta| vec![eta[0], eta[1] / x[0], eta[2] / (x[0] * x[1].sin())],
    lagrangian: |_, _, eta| (eta[0].square() + eta[1].square() + eta[2].square()) / 2.0,
};

/// Position and velocity in space of a state of [`SPHERICAL`].
fn in_space(y: &[f64]) -> [f64; 6] {
    let ((s, c), (sin, cos)) = (y[1].sin_cos(), y[2].sin_cos());
    let axes = [[s * cos, s * sin, c], [c * cos, c * sin, -s], [-sin, cos, 0.0]];
    let velocity = |i: usize| (0..3).map(|s| axes[s][i] * y[3 + s]).sum();
    [y[0] * axes[0][0], y[0] * axes[0][1], y[0] * axes[0][2], velocity(0), velocity(1), velocity(2)]
}

#[test]
fn a_free_particle_goes_straight_in_spherical_coordinates() {
    let graph = Graph::new();
    let system = SPHERICAL.builder(&graph).build().unwrap();
    let [r, theta] = graph.symbols(["r", "theta"]);
    let brackets: Vec<_> = system.structure().nonzero().collect();
    assert_eq!(brackets, [(1, 2, 2, -1.0 / r), (1, 3, 3, -1.0 / r), (2, 3, 3, -theta.cot() / r)]);

    let cartesian = Graph::new();
    let free = System::builder(&cartesian)
        .coordinates(["x", "y", "z"])
        .lagrangian(|_, _, v| (v[0].square() + v[1].square() + v[2].square()) / 2.0)
        .build()
        .unwrap();
    let start = [1.0, 1.2, 0.4, -0.5, 0.3, 0.8];
    let times = [0.5, 1.0, 2.0, 4.0];
    let mut motion = system.poincare().unwrap().compile().unwrap();
    let mut straight = free.poincare().unwrap().compile().unwrap();
    let lines = integrate(&mut straight, &in_space(&start), &times);
    for ((t, y), line) in times.iter().zip(integrate(&mut motion, &start, &times)).zip(&lines) {
        let begin = in_space(&start);
        let expected: [f64; 6] =
            std::array::from_fn(|i| if i < 3 { begin[i] + t * begin[i + 3] } else { begin[i] });
        assert!(distance(&in_space(&y), &expected) < ARRIVAL, "t = {t}: {y:?}");
        assert!(distance(line, &expected) < ARRIVAL, "t = {t}: {line:?}");
    }
}

/// A relativistic particle about a centre, c = 2: the Hessian depends on η.
const RELATIVISTIC: Description = Description {
    coordinates: &["rho", "phi"],
    quasi_velocities: &["u", "v"],
    velocities: |_, x, eta| vec![eta[0], eta[1] / x[0]],
    lagrangian: |_, x, eta| -4.0 * (1.0 - (eta[0].square() + eta[1].square()) / 4.0).sqrt() + 1.0 / x[0],
};

/// The same system with η = ẋ: L(t, x, a ẋ + a_0), with a, a_0 from `quasi_velocities`.
fn lagrange_form<'g>(
    graph: &'g Graph,
    description: Description,
    quasi_velocities: fn(Expr<'g>, &[Expr<'g>], &[Expr<'g>]) -> Vec<Expr<'g>>,
) -> Equations<'g> {
    let system = System::builder(graph)
        .coordinates(description.coordinates)
        .lagrangian(|t, x, v| (description.lagrangian)(t, x, &quasi_velocities(t, x, v)))
        .build()
        .unwrap();
    assert_eq!(system.structure().nonzero().count(), 0);
    system.poincare().unwrap()
}

/// ẍ = d/dt (b η + b_0) along the motion in the frame is the acceleration of Lagrange's equations.
fn assert_same(
    description: Description,
    quasi_velocities: for<'g> fn(Expr<'g>, &[Expr<'g>], &[Expr<'g>]) -> Vec<Expr<'g>>,
    sample: impl Fn(&mut SplitMix64) -> Vec<f64>,
) {
    let graph = Graph::new();
    let framed = description.builder(&graph).build().unwrap().poincare().unwrap();
    let system = framed.system();
    let (time, x, eta) = (system.frame().time(), system.frame().coordinates(), system.quasi_velocities());
    let n = x.len();
    let along: Vec<_> = x
        .iter()
        .copied()
        .zip(framed.velocities().iter().copied())
        .chain(eta.iter().copied().zip(framed.accelerations()))
        .chain([(time, Expr::ONE)])
        .collect();
    let mut outputs = framed.velocities().to_vec();
    outputs.extend(graph.directional(framed.velocities(), &along));

    let other = Graph::new();
    let mut plain = lagrange_form(&other, description, quasi_velocities).compile().unwrap();
    let mut random = SplitMix64::new(17);
    for _ in 0..STATES {
        let (t, y) = (random.uniform(0.0, 2.0), sample(&mut random));
        let symbols = x.iter().chain(eta).copied().zip(y.iter().copied()).chain([(time, t)]);
        let found = graph.evaluate(&outputs, &symbols.collect::<Vec<_>>()).unwrap();
        let state = [&y[..n], &found[..n]].concat();
        let expected = rates(&mut plain, t, &state);
        assert!(distance(&found, &expected) < ROUNDING, "t = {t}, {y:?}: {found:?}, not {expected:?}");
    }
}

fn polar_velocities<'g>(_: Expr<'g>, x: &[Expr<'g>], v: &[Expr<'g>]) -> Vec<Expr<'g>> {
    vec![v[0], x[0] * v[1]]
}

fn polar_sample(random: &mut SplitMix64) -> Vec<f64> {
    let (speed, direction) = (random.uniform(0.0, 1.8), random.uniform(0.0, 6.0));
    vec![random.uniform(0.5, 2.0), random.normal(), speed * direction.cos(), speed * direction.sin()]
}

#[test]
fn lagranges_equations_give_the_same_accelerations() {
    assert_same(CHARGE, polar_velocities, polar_sample);
    assert_same(RELATIVISTIC, polar_velocities, polar_sample);
    assert_same(
        TURNING_CHART,
        |_, x, v| vec![v[0] - 0.7 * x[1], v[1] + 0.7 * x[0]],
        |random| normals::<4>(random).to_vec(),
    );
    assert_same(
        SCALED_OSCILLATOR,
        |t, x, v| vec![(t / 4.0).exp() * (v[0] - x[0] / 4.0)],
        |random| normals::<2>(random).to_vec(),
    );
    assert_same(
        SPHERICAL,
        |_, x, v| vec![v[0], x[0] * v[1], x[0] * x[1].sin() * v[2]],
        |random| {
            let [a, b, c, d] = normals(random);
            vec![random.uniform(0.5, 2.0), random.uniform(0.4, 2.6), a, b, c, d]
        },
    );
    assert_same(
        TOP_IN_ANGLES,
        |_, x, v| {
            let ((s, c), sin) = ((x[2].sin(), x[2].cos()), x[1].sin());
            vec![v[0] * sin * s + v[1] * c, v[0] * sin * c - v[1] * s, v[2] + v[0] * x[1].cos()]
        },
        top_sample,
    );
}

fn top_sample(random: &mut SplitMix64) -> Vec<f64> {
    let angles: [f64; 3] = std::array::from_fn(|_| random.uniform(0.4, 2.6));
    [angles, normals(random)].concat()
}

/// L + dF/dt has the equations of L, whatever F(t, x); dF/dt = ∂F/∂t + ẋ_i ∂F/∂x_i = X_0 F + η_s X_s F.
fn assert_gauge_invariant(
    name: &str,
    description: Description,
    sample: impl Fn(&mut SplitMix64) -> Vec<f64>,
) {
    let mut random = SplitMix64::new(19);
    for case in 0..6 {
        // By value the new terms cancel as expressions, otherwise as numbers.
        let folding = if case % 2 == 0 { Folding::ByValue } else { Folding::Structural };
        let graph = Graph::with_folding(folding);
        let plain = description.builder(&graph).build().unwrap();
        let mut coefficient = || Expr::from((random.uniform(-2.0, 2.0) * 8.0).round() / 8.0);
        let changed = description
            .builder(&graph)
            .lagrangian(|t, x, eta| {
                let wave: Expr<'_> =
                    x.iter().map(|&x| coefficient() * x).sum::<Expr<'_>>() + coefficient() * t;
                let product: Expr<'_> = x.iter().fold(Expr::ONE, |product, &x| product * (x + coefficient()));
                let f = coefficient() * wave.sin() + t * product + x[0] * x[0] * coefficient();
                let velocities = (description.velocities)(t, x, eta);
                let transport = graph.sum(x.iter().zip(velocities).map(|(&x, v)| f.derivative(x) * v));
                (description.lagrangian)(t, x, eta) + f.derivative(t) + transport
            })
            .build()
            .unwrap();
        assert_ne!(changed.momenta(), plain.momenta());
        let mut plain = plain.poincare().unwrap().compile().unwrap();
        let mut changed = changed.poincare().unwrap().compile().unwrap();
        for _ in 0..STATES / 4 {
            let (t, y) = (random.uniform(0.0, 2.0), sample(&mut random));
            let (found, expected) = (rates(&mut changed, t, &y), rates(&mut plain, t, &y));
            let error = distance(&found, &expected);
            assert!(error < ROUNDING, "{name}, F number {case}, t = {t}, {y:?}: {found:?}, not {expected:?}");
        }
    }
}

#[test]
fn a_change_of_gauge_changes_no_motion() {
    assert_gauge_invariant("chart", TURNING_CHART, |random| normals::<4>(random).to_vec());
    assert_gauge_invariant("charge", CHARGE, polar_sample);
    assert_gauge_invariant("relativistic", RELATIVISTIC, polar_sample);
    assert_gauge_invariant("scaled oscillator", SCALED_OSCILLATOR, |random| normals::<2>(random).to_vec());
    assert_gauge_invariant("top in angles", TOP_IN_ANGLES, top_sample);
    // In γ the frame has rank 2 with three operators.
    assert_gauge_invariant("top in γ", TOP_IN_VERTICAL, |random| normals::<6>(random).to_vec());
}

#[test]
fn each_frame_is_that_of_the_definition() {
    let described: [(&str, Description, &[f64]); 7] = [
        ("chart", TURNING_CHART, &[1.0, 0.0, 0.0, 1.5]),
        ("charge", CHARGE, &[1.0, 0.0, 0.5, 1.0]),
        ("relativistic", RELATIVISTIC, &[1.0, 0.0, 0.0, 1.1]),
        ("scaled oscillator", SCALED_OSCILLATOR, &[1.0, 0.75]),
        ("spherical coordinates", SPHERICAL, &[1.0, 1.2, 0.4, -0.5, 0.3, 0.8]),
        ("top in angles", TOP_IN_ANGLES, &[0.0, 1.0, 0.3, 0.2, -0.3, 1.5]),
        ("top in a quaternion", TOP_IN_QUATERNION, &[0.9, 0.5, -0.1, 0.1, 0.2, -0.3, 1.5]),
    ];
    for (name, description, centre) in described {
        assert_definition(name, |graph| description.builder(graph).build().unwrap(), centre);
    }
    // The frame in γ does not determine the brackets.
    let so3 = LieAlgebra::so3();
    assert_definition(
        "top in γ",
        |graph| TOP_IN_VERTICAL.builder(graph).algebra(&so3).build().unwrap(),
        &[0.2, 0.8, 0.5, 0.2, -0.3, 1.5],
    );
}

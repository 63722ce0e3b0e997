//! The surface where constraints hold: which of its states is nearest, and what holds components.

use pc_mech::{Constraint, Expr, Graph, MechError, Motion, System, VectorField};

use crate::multipliers::{on_surface, pendulum};
use crate::random::numbers;

/// The projection reaches the surface by the shortest way, a combination of M⁻¹ ∂f/∂x, and leaves states of
/// the surface unchanged.
#[test]
fn projection_goes_to_the_surface_by_the_shortest_way() {
    let graph = Graph::new();
    let mut motion = pendulum(&graph).compile().unwrap();
    let mut next = numbers(11);
    for _ in 0..40 {
        let t = next();
        let y = on_surface(&mut motion, t, &mut next);
        let residuals = motion.constraint_residuals(t, &y);
        assert!(residuals.iter().all(|r| r.abs() < 1e-14), "{residuals:?}");
        let mut again = y.clone();
        motion.project(t, &mut again).unwrap();
        // The last correction is of the size of the rounding of f, over the least singular value of C.
        assert!(again.iter().zip(&y).all(|(a, b)| (a - b).abs() < 1e-14), "a state of the surface stays");

        let size = 1e-5;
        let near: Vec<f64> = y.iter().map(|y| y + size * next()).collect();
        let mut projected = near.clone();
        motion.project(t, &mut projected).unwrap();
        let way: Vec<f64> = projected.iter().zip(&near).map(|(a, b)| a - b).collect();
        // A displacement δ with C δ = 0 is orthogonal to the correction in the kinetic metric diag(1, 1, 2,
        // 2).
        let support = 0.3 * (2.0 * t).sin();
        let (r1, r2) = ([y[0], y[1] - support], [y[2] - y[0], y[3] - y[1]]);
        let turn = [-r1[1], r1[0], -r1[1], r1[0]];
        let fold = [0.0, 0.0, -r2[1], r2[0]];
        for tangent in [turn, fold] {
            let mass = [1.0, 1.0, 2.0, 2.0];
            let product: f64 = (0..4).map(|i| mass[i] * tangent[i] * way[i]).sum();
            // The normals at the end and along the way differ by the order of the distance.
            assert!(product.abs() < 100.0 * size * size, "{product:e}");
        }
    }
}

/// At the lowest point of the circle the coordinates are smaller than the rounding of its equation.
#[test]
fn states_near_the_origin_of_coordinates_are_projected() {
    let graph = Graph::new();
    let [x, y] = graph.symbols(["x", "y"]);
    let system = System::builder(&graph)
        .coordinates(["x", "y"])
        .lagrangian(|_, _, v| (v[0].square() + v[1].square()) / 2.0)
        .build()
        .unwrap();
    let circle = Constraint::new("circle", x.square() + (y - 1.7).square() - 1.7_f64.powi(2));
    let mut motion = system.with_multipliers(&[circle]).unwrap().compile().unwrap();
    for exponent in 0..40 {
        let x = 10f64.powi(-exponent / 2);
        let mut state = [x, 0.1 * x * x, 1e-9 * x, 1e-7 * x];
        motion.project(0.0, &mut state).unwrap();
        let residual = motion.constraint_residuals(0.0, &state)[0];
        assert!(residual.abs() < 6e-15, "{state:?}: {residual:e}"); // some roundings of 2.89
    }
}

/// Where a coordinate is too large to be changed by its part of a rounding error, the other one approaches by
/// halves.
#[test]
fn a_projection_does_not_follow_rounding() {
    let graph = Graph::new();
    let [x, y, vx, vy] = graph.symbols(["x", "y", "x'", "y'"]);
    let system = System::builder(&graph)
        .coordinates(["x", "y"])
        .lagrangian(|_, _, v| (v[0].square() + v[1].square()) / 2.0)
        .build()
        .unwrap();
    for constraint in [x + y - 1.0, (x.square() + y.square()).sqrt() - 1.0, vx + vy - 1.0] {
        let mut motion =
            system.with_multipliers(&[Constraint::new("c", constraint)]).unwrap().compile().unwrap();
        for small in [1e-15, 1e-16, 1e-17, 1e-20] {
            let mut state = [1.0, small, 1.0, small];
            motion.project(0.0, &mut state).unwrap();
            let residual = motion.constraint_residuals(0.0, &state)[0];
            assert!(residual.abs() < 1e-15, "{state:?}: {residual:e}");
        }
    }
}

/// A step along which T vanishes still has a length.
#[test]
fn steps_are_not_measured_by_an_indefinite_metric() {
    let graph = Graph::new();
    let [x, y, z, vx, vz] = graph.symbols(["x", "y", "z", "x'", "z'"]);
    let system = |masses: [f64; 3]| {
        System::builder(&graph)
            .coordinates(["x", "y", "z"])
            .lagrangian(|_, _, v| graph.sum((0..3).map(|i| masses[i] * v[i].square() / 2.0)))
            .build()
            .unwrap()
    };
    let (indefinite, massless) = (system([1.0, -1.0, 1.0]), system([1.0, 0.0, 1.0]));
    let sines = [Constraint::new("a", x - z.sin()), Constraint::new("b", y - z.sin())];
    let tie = [Constraint::new("tie", y - x.square() - z)];
    let free = [Constraint::new("rate", graph.symbol("y'") - vx * z.cos() - vz)];
    for (system, constraints) in [(&indefinite, &sines[..]), (&massless, &tie), (&massless, &free)] {
        let mut motion = system.with_multipliers(constraints).unwrap().compile().unwrap();
        let mut state = [0.3, 0.4, 0.5, 1.0, 1.1, 1.2];
        motion.project(0.0, &mut state).unwrap();
        let residuals = motion.constraint_residuals(0.0, &state);
        assert!(residuals.iter().all(|r| r.abs() < 1e-15), "{state:?}: {residuals:?}");
    }
}

/// Steps are not short against a large coordinate in other units.
#[test]
fn a_large_coordinate_hides_no_distance() {
    let graph = Graph::new();
    let x = graph.symbol("x");
    let system = System::builder(&graph)
        .coordinates(["s", "x"])
        .lagrangian(|_, _, v| (v[0].square() + v[1].square()) / 2.0)
        .build()
        .unwrap();
    let mut motion = system.with_multipliers(&[Constraint::new("c", x.atan())]).unwrap().compile().unwrap();
    let mut state = [1e10, 3.0, 1.0, 0.0];
    motion.project(0.0, &mut state).unwrap();
    assert!(state[1].abs() < 1e-15, "{state:?}");
}

/// Far from a curved surface Newton's full step overshoots.
#[test]
fn a_projection_may_take_a_long_way() {
    let graph = Graph::new();
    let [x, y, z, t] = graph.symbols(["x", "y", "z", "t"]);
    let system = System::builder(&graph)
        .coordinates(["x", "y", "z"])
        .lagrangian(|_, x, v| {
            (2.0 + x[2].square()) * v[0].square() / 2.0
                + (1.5 + x[1].cos()) * v[1].square() / 2.0
                + 0.6 * v[2].square()
        })
        .build()
        .unwrap();
    let bent = Constraint::new("bent", x.square() + y * z + z * t.sin() + 0.3 * z);
    let steep = Constraint::new("steep", (3.0 * x).atan() + y.tanh());
    let mut next = numbers(5);
    for constraint in [bent, steep] {
        let mut motion = system.with_multipliers(&[constraint]).unwrap().compile().unwrap();
        for _ in 0..300 {
            let mut state: Vec<f64> = (0..6).map(|_| next()).collect();
            motion.project(0.412, &mut state).unwrap();
            let residual = motion.constraint_residuals(0.412, &state)[0];
            assert!(residual.abs() < 1e-14, "{state:?}: {residual}"); // some roundings of numbers below 5
        }
    }
}

/// A particle in space that keeps its speed under gravity, by Chetaev's condition: with θ the angle of its
/// velocity with the vertical θ̇ = (g/v) sin θ, so that tan(θ/2) grows as e^(g t/v), and the horizontal
/// direction stays.
#[test]
fn a_nonlinear_constraint_turns_the_velocity_only() {
    let (gravity, speed) = (10.0, 5.0);
    let graph = Graph::new();
    let particle = System::builder(&graph)
        .coordinates(["x", "y", "z"])
        .lagrangian(|_, x, v| (v[0].square() + v[1].square() + v[2].square()) / 2.0 - gravity * x[2])
        .build()
        .unwrap();
    let v: Vec<Expr<'_>> = particle.quasi_velocities().to_vec();
    let square = v[0].square() + v[1].square() + v[2].square();
    let kept = square - speed * speed;
    let error = particle.with_multipliers(&[Constraint::new("speed", kept)]).map(|_| ()).unwrap_err();
    assert_eq!(error.to_string(), "the constraint `speed` is not affine in the quasi-velocities");
    let constraint = Constraint::nonlinear("speed", kept);
    let mut motion = particle.with_multipliers(&[constraint]).unwrap().compile().unwrap();

    // From far off, Newton's method brings the velocity to the sphere along its own direction.
    let mut y = [0.0, 0.0, 0.0, 0.6, 0.8, 0.1];
    motion.project(0.0, &mut y).unwrap();
    let length = y[3..].iter().map(|v| v * v).sum::<f64>().sqrt();
    assert!((length - speed).abs() < 1e-14 && (y[3] * 0.8 - y[4] * 0.6).abs() < 1e-14, "{y:?}");

    let tangent = |y: &[f64]| {
        let cosine = y[5] / speed;
        ((1.0 - cosine) / (1.0 + cosine)).sqrt()
    };
    let start = tangent(&y);
    let (step, steps) = (1e-3, 1000);
    for i in 0..steps {
        // The classical Runge–Kutta method, projected.
        let t = step * f64::from(i);
        let mut rate = |t: f64, y: &[f64]| {
            let mut rate = [0.0; 6];
            motion.rhs(t, y, &mut rate).unwrap();
            rate
        };
        let moved =
            |y: &[f64; 6], k: &[f64; 6], h: f64| -> [f64; 6] { std::array::from_fn(|i| y[i] + h * k[i]) };
        let k1 = rate(t, &y);
        let k2 = rate(t, &moved(&y, &k1, step / 2.0));
        let k3 = rate(t, &moved(&y, &k2, step / 2.0));
        let k4 = rate(t, &moved(&y, &k3, step));
        for i in 0..6 {
            y[i] += step / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
        }
        motion.project(t + step, &mut y).unwrap();
    }
    let expected = start * (gravity / speed).exp();
    // step⁴ times (g/v)⁵, for a method of order 4
    assert!((tangent(&y) / expected - 1.0).abs() < 1e-11, "{} instead of {expected}", tangent(&y));
    assert!((y[3] * 0.8 - y[4] * 0.6).abs() < 1e-13, "the horizontal direction stays");
}

/// Two bobs on a rod of length one, the second four times as heavy.
#[test]
fn held_components_stay_and_the_rest_moves_the_shortest_way() {
    let graph = Graph::new();
    let system = System::builder(&graph)
        .coordinates(["x1", "x2", "y"])
        .lagrangian(|_, _, v| (v[0].square() + 4.0 * v[1].square() + v[2].square()) / 2.0)
        .build()
        .unwrap();
    let [x1, x2] = graph.symbols(["x1", "x2"]);
    let rod = Constraint::new("rod", x2 - x1 - 1.0);
    let mut motion = system.with_multipliers(&[rod]).unwrap().compile().unwrap();
    let off = [0.0, 1.5, 7.0, 1.0, 2.0, 3.0];
    let mut moved = |coordinates: &[usize], velocities: &[usize]| {
        let mut state = off;
        motion.project_holding(0.0, &mut state, coordinates, velocities).map(|()| state)
    };
    // The displacements are proportional to 1/m.
    for (found, expected) in moved(&[], &[]).unwrap().iter().zip([0.4, 1.4, 7.0, 1.8, 1.8, 3.0]) {
        assert!((found - expected).abs() < 1e-14, "{found} {expected}");
    }
    let held = moved(&[0], &[1]).unwrap();
    assert_eq!([held[0], held[4]], [0.0, 2.0]);
    for (found, expected) in held.iter().zip([0.0, 1.0, 7.0, 2.0, 2.0, 3.0]) {
        assert!((found - expected).abs() < 1e-14, "{found} {expected}");
    }
    let failure = MechError::from(moved(&[0, 1], &[]).unwrap_err());
    assert_eq!(failure.singular_constraint(), Some("rod"));
}

/// The same two bobs, with a third as heavy as both that hangs on the second in y: what is held changes only where it must.
#[test]
fn held_velocities_yield_only_to_conditions_on_them_alone() {
    let graph = Graph::new();
    let system = System::builder(&graph)
        .coordinates(["x1", "x2", "y"])
        .lagrangian(|_, _, v| (v[0].square() + 4.0 * v[1].square() + 5.0 * v[2].square()) / 2.0)
        .build()
        .unwrap();
    let [x1, x2, y] = graph.symbols(["x1", "x2", "y"]);
    let rod = Constraint::new("rod", x2 - x1 - 1.0);
    let mut one = system.with_multipliers(std::slice::from_ref(&rod)).unwrap().compile().unwrap();
    let hook = Constraint::new("hook", y - 2.0 * x2);
    let mut both = system.with_multipliers(&[rod, hook]).unwrap().compile().unwrap();
    let place = [0.0, 1.0, 2.0];
    let moved = |motion: &mut Motion, velocities: [f64; 3], held: &[usize]| {
        let mut state = [place, velocities].concat();
        motion.project_velocities_holding(0.0, &mut state, held).unwrap();
        assert_eq!(state[..3], place);
        state[3..].to_vec()
    };
    let near = |found: Vec<f64>, expected: [f64; 3]| {
        for (x, y) in found.iter().zip(&expected) {
            assert!((x - y).abs() < 1e-14, "{found:?} is not {expected:?}");
        }
    };
    near(moved(&mut one, [1.0, 2.0, 3.0], &[1]), [2.0, 2.0, 3.0]);
    // On the first two alone the rod acts as if the third were not there: (1 + 4·2)/5.
    near(moved(&mut one, [1.0, 2.0, 3.0], &[0, 1]), [1.8, 1.8, 3.0]);
    near(moved(&mut both, [1.0, 2.0, 3.0], &[0, 1]), [1.8, 1.8, 3.6]);
    near(moved(&mut both, [1.5, 1.5, 7.0], &[0, 1]), [1.5, 1.5, 3.0]);
    near(moved(&mut both, [1.0, 2.0, 3.0], &[2]), [1.5, 1.5, 3.0]);
    // All together: v (1 + 4 + 5·4) = 1 + 8 + 5·2·3.
    near(moved(&mut both, [1.0, 2.0, 3.0], &[]), [1.56, 1.56, 3.12]);
    near(moved(&mut both, [1.0, 2.0, 3.0], &[0, 1, 2]), [1.56, 1.56, 3.12]);
}

/// x = y holds where (x − y)(x + y) = 0 and x > 0, but not on the other branch.
#[test]
fn a_constraint_that_no_longer_follows_is_an_error() {
    let graph = Graph::new();
    let system = System::builder(&graph)
        .coordinates(["x", "y"])
        .lagrangian(|_, _, v| (v[0].square() + v[1].square()) / 2.0)
        .build()
        .unwrap();
    let [x, y] = graph.symbols(["x", "y"]);
    let lines = Constraint::new("lines", x.square() - y.square());
    let diagonal = Constraint::new("diagonal", x - y);
    let held = system.with_multipliers(&[lines]).unwrap().followed_by(&[diagonal]);
    let mut motion = held.compile().unwrap();
    motion.project(0.0, &mut [1.0, 1.0, 0.5, 0.5]).unwrap();
    let failure = motion.project(0.0, &mut [1.0, -1.0, 0.5, -0.5]).unwrap_err();
    let message = failure.to_string();
    assert!(
        message.starts_with(
            "the constraint `diagonal`, which followed from the others, no longer does at t = 0"
        ),
        "{message}"
    );
}

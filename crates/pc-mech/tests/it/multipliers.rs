//! Constraints with multipliers against the same in independent velocities, and the projection of states.

use pc_algebra::{LieGroup, UnitQuaternions};
use pc_mech::{
    AlgebraError, CompileOptions, Constraint, ConstraintError, EvaluationError, Expr, Frame, FrameError,
    Graph, Matrix, MechError, Motion, Multipliers, System, VectorField,
};

use crate::random::numbers;

/// A double pendulum in Cartesian coordinates, its point of support moved up and down; a force depends on velocities.
fn pendulum(graph: &Graph) -> Multipliers<'_> {
    let [m, l, t, x1, y1, x2, y2] = graph.symbols(["m", "l", "t", "x1", "y1", "x2", "y2"]);
    let system = System::builder(graph)
        .parameter(m, 2.0)
        .parameter(l, 0.8)
        .coordinates(["x1", "y1", "x2", "y2"])
        .lagrangian(|_, x, v| {
            let kinetic = (v[0].square() + v[1].square() + m * (v[2].square() + v[3].square())) / 2.0;
            kinetic - 10.0 * (x[1] + m * x[3])
        })
        .forces(|_, x, v| [-0.1 * v[0], 0.0.into(), x[0] * v[3], -0.2 * v[3] * v[2]])
        .build()
        .unwrap();
    let support = 0.3 * (2.0 * t).sin();
    let links = [
        Constraint::new("upper", x1.square() + (y1 - support).square() - 1.0),
        Constraint::new("lower", (x2 - x1).square() + (y2 - y1).square() - l.square()),
    ];
    system.with_multipliers(&links).unwrap()
}

/// A state of the surface near a random one.
fn on_surface(motion: &mut Motion, t: f64, next: &mut impl FnMut() -> f64) -> Vec<f64> {
    loop {
        let mut y: Vec<f64> = (0..motion.dim()).map(|_| 1.5 * next()).collect();
        if motion.project(t, &mut y).is_ok() {
            return y;
        }
    }
}

fn values<'g>(graph: &'g Graph, motion: &Motion, t: f64, y: &[f64]) -> Vec<(Expr<'g>, f64)> {
    let state = motion.names().iter().map(|name| graph.symbol(name)).zip(y.iter().copied());
    state.chain([(graph.symbol("t"), t)]).collect()
}

#[test]
fn rates_are_those_of_independent_velocities() {
    let graph = Graph::new();
    let multipliers = pendulum(&graph);
    let mut motion = multipliers.compile().unwrap();
    let mut next = numbers(3);
    let mut choices = Vec::new();
    for _ in 0..40 {
        let t = next();
        let y = on_surface(&mut motion, t, &mut next);
        let at = values(&graph, &motion, t, &y);
        let system = multipliers.in_independent_velocities(&at).unwrap();
        let free: Vec<usize> = system
            .quasi_velocities()
            .iter()
            .map(|eta| motion.names().iter().position(|name| *name == eta.to_string()).unwrap())
            .collect();
        let mut independent = system.poincare().unwrap().compile().unwrap();
        let state: Vec<f64> = y[..4].iter().copied().chain(free.iter().map(|&s| y[s])).collect();
        let (mut rates, mut expected) = (vec![0.0; 8], vec![0.0; 6]);
        motion.rhs(t, &y, &mut rates).unwrap();
        independent.rhs(t, &state, &mut expected).unwrap();
        let found = rates[..4].iter().copied().chain(free.iter().map(|&s| rates[s]));
        for (found, expected) in found.zip(&expected) {
            // Rounding, times the condition of the choice and the size of rates up to some hundreds.
            assert!((found - expected).abs() < 1e-11 * (1.0 + expected.abs()), "{found} {expected}");
        }
        if !choices.contains(&free) {
            choices.push(free);
        }
    }
    assert!(choices.len() >= 4, "all choices of independent velocities occur: {choices:?}");
}

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

#[test]
fn derivatives_are_limits_of_difference_quotients() {
    let graph = Graph::new();
    let options = CompileOptions::default().jvp(true).parameter_jacobian(true);
    let mut motion = pendulum(&graph).compile_for(options).unwrap();
    let mut next = numbers(5);
    for _ in 0..10 {
        let t = next();
        let y = on_surface(&mut motion, t, &mut next);
        let mut jacobian = [0.0; 64];
        motion.jacobian(t, &y, &mut jacobian).unwrap();
        let step = 1e-5;
        let rate = |motion: &mut Motion, y: &[f64]| {
            let mut rate = vec![0.0; 8];
            motion.rhs(t, y, &mut rate).unwrap();
            rate
        };
        let size = jacobian.iter().fold(1.0f64, |size, j| size.max(j.abs()));
        // The quotient errs by step² times a third derivative, and by rounding over the step.
        let tolerance = 1e-6 * size;
        for j in 0..8 {
            let at = |h: f64| {
                y.iter().enumerate().map(|(i, y)| if i == j { y + h } else { *y }).collect::<Vec<_>>()
            };
            let (up, down) = (rate(&mut motion, &at(step)), rate(&mut motion, &at(-step)));
            for i in 0..8 {
                let quotient = (up[i] - down[i]) / (2.0 * step);
                assert!((quotient - jacobian[i + 8 * j]).abs() < tolerance, "{i} {j}");
            }
        }
        let v: Vec<f64> = (0..8).map(|_| next()).collect();
        let mut product = [0.0; 8];
        motion.jvp(t, &y, &v, &mut product).unwrap();
        for i in 0..8 {
            let expected: f64 = (0..8).map(|j| jacobian[i + 8 * j] * v[j]).sum();
            assert!((product[i] - expected).abs() < 1e-11 * size);
        }
        let mut by_parameters = [0.0; 16];
        motion.parameter_jacobian(t, &y, &mut by_parameters).unwrap();
        let mass = motion.parameters()[0];
        motion.parameters_mut()[0] = mass + step;
        let up = rate(&mut motion, &y);
        motion.parameters_mut()[0] = mass - step;
        let down = rate(&mut motion, &y);
        motion.parameters_mut()[0] = mass;
        for i in 0..8 {
            assert!(((up[i] - down[i]) / (2.0 * step) - by_parameters[i]).abs() < tolerance);
        }
    }
}

/// A quaternion of a body under two conditions, on positions and on velocities, in quasi-velocities that are
/// not velocities.
#[test]
fn conditions_of_both_kinds_bind_quasi_velocities() {
    let graph = Graph::new();
    let [q0, q1, q2, q3, w1, w3] = graph.symbols(["q0", "q1", "q2", "q3", "ω1", "ω3"]);
    let body = System::builder(&graph)
        .coordinates(["q0", "q1", "q2", "q3"])
        .quasi_velocities(["ω1", "ω2", "ω3"])
        .frame(UnitQuaternions.left_frame(&graph, graph.symbol("t"), vec![q0, q1, q2, q3]).unwrap())
        .lagrangian(|_, _, w| {
            (w[0].square() + 2.0 * w[1].square() + 3.0 * w[2].square()) / 2.0 + w[0] * w[2] / 5.0
        })
        .build()
        .unwrap();
    // The third axis of the body stays at an angle to the vertical, and ω1 + 2 ω3 = 1.
    let tilt = Constraint::new("tilt", q0.square() - q1.square() - q2.square() + q3.square() - 0.5);
    let gear = Constraint::new("gear", w1 + 2.0 * w3 - 1.0);
    let multipliers = body.with_multipliers(&[tilt, gear]).unwrap();
    assert!(multipliers.is_holonomic(0) && !multipliers.is_holonomic(1));
    let mut motion = multipliers.observe_reactions().compile().unwrap();
    let mut y = vec![0.9, 0.3, 0.1, 0.2, 0.3, 0.2, 0.1];
    motion.project(0.0, &mut y).unwrap();
    assert!((y[4] + 2.0 * y[6] - 1.0).abs() < 1e-15);
    let mut rates = [0.0; 7];
    motion.rhs(0.0, &y, &mut rates).unwrap();
    assert!((rates[4] + 2.0 * rates[6]).abs() < 1e-14, "ω̇1 + 2 ω̇3 = 0");
    // M ω̇ − Mω × ω = Cᵀ λ, with γ = (2(q1q3 − q0q2), 2(q2q3 + q0q1), …) and γ̇3 = γ1 ω2 − γ2 ω1
    let (w, a) = (&y[4..], &rates[4..]);
    let momentum = |w: &[f64]| [w[0] + w[2] / 5.0, 2.0 * w[1], 3.0 * w[2] + w[0] / 5.0];
    let (m, left) = (momentum(w), momentum(a));
    let cross = [m[1] * w[2] - m[2] * w[1], m[2] * w[0] - m[0] * w[2], m[0] * w[1] - m[1] * w[0]];
    let gamma = [2.0 * (y[1] * y[3] - y[0] * y[2]), 2.0 * (y[2] * y[3] + y[0] * y[1])];
    let observed = motion.observe(0.0, &y);
    let [tilt, gear] = [observed[observed.len() - 2], observed[observed.len() - 1]];
    let right = [gear - tilt * gamma[1], tilt * gamma[0], 2.0 * gear];
    for s in 0..3 {
        assert!((left[s] - cross[s] - right[s]).abs() < 1e-13, "{s}");
    }
}

#[test]
fn constraints_that_cannot_be_held_are_refused() {
    let graph = Graph::new();
    let [x, y, vx, vy] = graph.symbols(["x", "y", "x'", "y'"]);
    let system = System::builder(&graph)
        .coordinates(["x", "y", "z"])
        .lagrangian(|_, _, v| (v[0].square() + v[1].square() + v[2].square()) / 2.0)
        .build()
        .unwrap();
    let refused = |constraints: &[Constraint<'_>]| {
        system.with_multipliers(constraints).map(|_| ()).unwrap_err().to_string()
    };
    let circle = Constraint::new("circle", x.square() + y.square() - 1.0);
    let rolling = Constraint::new("rolling", x * vx + y * vy);
    let line = Constraint::new("line", x - y);
    let third = Constraint::new("third", vx + x * vy);
    assert_eq!(
        refused(&[circle.clone(), rolling]),
        "the constraint `rolling` restricts no velocity that those before it leave free"
    );
    assert_eq!(
        refused(&[circle.clone(), line.clone(), third]),
        "the constraints leave nothing free: there are 3 of them for 3 quasi-velocities"
    );
    assert_eq!(
        refused(&[Constraint::new("speed", vx.square() + vy.square() - 1.0)]),
        "the constraint `speed` is not affine in the quasi-velocities"
    );
    assert_eq!(
        refused(&[Constraint::new("nothing", graph.symbol("t").sin())]),
        "the constraint `nothing` restricts no velocity that those before it leave free"
    );

    // x² + y² = 1 and x = y are independent except where the gradient of the circle vanishes: at the origin.
    let mut motion = system.with_multipliers(&[circle, line]).unwrap().compile().unwrap();
    let failure = motion.rhs(0.5, &[0.0, 0.0, 1.0, 0.0, 0.0, 0.0], &mut [0.0; 6]).unwrap_err();
    assert_eq!(
        failure.to_string(),
        "the constraint `circle` restricts no velocity that the others leave free at t = 0.5, x = 0, y = 0, z = 1, \
         x' = 0, y' = 0, z' = 0"
    );
    let cut = Constraint::new("cut", x.square() + 1.0);
    let mut motion = system.with_multipliers(&[cut]).unwrap().compile().unwrap();
    let failure = motion.project(0.0, &mut [0.7, 0.0, 0.0, 0.0, 0.0, 0.0]).unwrap_err();
    let text = failure.to_string();
    assert!(
        text.starts_with("no state that satisfies the constraints `cut` was found near t = 0, x = "),
        "{text}"
    );
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

/// x' − c y' has a mass that cancels under the constraint.
#[test]
fn a_mass_that_cancels_under_constraints_is_singular() {
    let graph = Graph::new();
    let [z, vx, vy] = graph.symbols(["z", "x'", "y'"]);
    let c = 0.1;
    let system = System::builder(&graph)
        .coordinates(["x", "y", "z"])
        .lagrangian(|_, x, v| ((v[0] - c * v[1]).square() + v[2].square()) / 2.0 - x[1])
        .build()
        .unwrap();
    for factor in [1.0, 3.0] {
        let constraint = Constraint::new("a", factor * vx - (z + factor * c) * vy);
        let mut motion = system.with_multipliers(&[constraint]).unwrap().compile().unwrap();
        let error = motion.rhs(0.0, &[0.0, 0.0, 0.0, c, 1.0, 1.0], &mut [0.0; 6]).unwrap_err();
        assert!(
            matches!(
                error.cause().downcast_ref(),
                Some(MechError::Evaluation(EvaluationError::SingularMassMatrix { .. }))
            ),
            "{error}"
        );
    }
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

/// A disk of atomic size and mass that rolls: x' = r θ' cos φ, y' = r θ' sin φ.
#[test]
fn units_do_not_matter_under_constraints() {
    let graph = Graph::new();
    let [phi, vx, vy, turn] = graph.symbols(["φ", "x'", "y'", "θ'"]);
    let (m, r, inertia) = (2e-26, 1e-10, 1e-46);
    let system = System::builder(&graph)
        .coordinates(["x", "y", "φ", "θ"])
        .lagrangian(|_, _, v| {
            (m * (v[0].square() + v[1].square()) + inertia * (v[2].square() + v[3].square())) / 2.0
        })
        .build()
        .unwrap();
    let rolling = [
        Constraint::new("along", vx - r * turn * phi.cos()),
        Constraint::new("across", vy - r * turn * phi.sin()),
    ];
    let mut motion = system.with_multipliers(&rolling).unwrap().compile().unwrap();
    let (sin, cos) = 0.3f64.sin_cos();
    let state = [0.0, 0.0, 0.3, 0.0, 3.0 * r * cos, 3.0 * r * sin, 0.7, 3.0];
    let mut rates = [0.0; 8];
    motion.rhs(0.0, &state, &mut rates).unwrap();
    // It goes in a circle: v̇ = φ' v across the direction; the other rates are zero.
    let expected = [-3.0 * r * 0.7 * sin, 3.0 * r * 0.7 * cos, 0.0, 0.0];
    for (found, (expected, unit)) in rates[4..].iter().zip(expected.iter().zip([r, r, 1.0, 1.0])) {
        assert!((found - expected).abs() < 1e-14 * unit, "{rates:?}"); // some roundings of numbers about 1
    }
}

#[test]
fn independent_velocities_need_integrable_constraints() {
    let graph = Graph::new();
    let [x, y, vx, vy, vz] = graph.symbols(["x", "y", "x'", "y'", "z'"]);
    let system = System::builder(&graph)
        .coordinates(["x", "y", "z"])
        .lagrangian(|_, _, v| (v[0].square() + v[1].square() + v[2].square()) / 2.0)
        .build()
        .unwrap();
    let at = [(x, 0.3), (y, 0.5), (graph.symbol("z"), 0.1), (vx, 1.0), (vy, 2.0), (vz, 0.5)];
    let knife = Constraint::new("knife", vz - y * vx);
    let error = system.with_multipliers(&[knife]).unwrap().in_independent_velocities(&at).unwrap_err();
    assert!(matches!(error, MechError::Algebra(AlgebraError::NotClosed { pair: (1, 2), .. })), "{error:?}");
    // … and y = const is integrable in every form.
    let groove = Constraint::new("groove", vy * (1.0 + x.square()));
    let system = system.with_multipliers(&[groove]).unwrap().in_independent_velocities(&at).unwrap();
    assert_eq!(system.quasi_velocities(), [vx, vz]);
}

/// L = −√(1 − v²) − y of a bead on the unit circle: M = γ (1 + γ² v vᵀ), θ̈ = −cos θ (1 − v²)^(3/2).
#[test]
fn the_mass_matrix_may_depend_on_velocities() {
    let graph = Graph::new();
    let [x, y] = graph.symbols(["x", "y"]);
    let bead = System::builder(&graph)
        .coordinates(["x", "y"])
        .lagrangian(|_, x, v| -(1.0 - v[0].square() - v[1].square()).sqrt() - x[1])
        .build()
        .unwrap();
    let circle = Constraint::new("circle", x.square() + y.square() - 1.0);
    let mut motion = bead.with_multipliers(&[circle]).unwrap().compile().unwrap();
    for (angle, speed) in [(0.3f64, 0.9f64), (-1.4, 0.5), (2.9, -0.99)] {
        let (s, c) = angle.sin_cos();
        let mut rates = [0.0; 4];
        motion.rhs(0.0, &[c, s, -s * speed, c * speed], &mut rates).unwrap();
        let along = -c * (1.0 - speed * speed).powf(1.5);
        let expected = [-s * along - c * speed * speed, c * along - s * speed * speed];
        for (found, expected) in rates[2..].iter().zip(expected) {
            // Rounding, times γ² which is 50 at most.
            assert!((found - expected).abs() < 1e-13, "{found} {expected}");
        }
        // The velocity is projected by the metric of the state: M δη is along the normal.
        let (u, v) = (-s * speed + 0.05 * c, c * speed + 0.05 * s);
        let mut projected = [c, s, u, v];
        motion.project(0.0, &mut projected).unwrap();
        let (du, dv) = (projected[2] - u, projected[3] - v);
        let gamma2 = 1.0 / (1.0 - u * u - v * v);
        let momentum = [du + gamma2 * u * (u * du + v * dv), dv + gamma2 * v * (u * du + v * dv)];
        assert!((projected[2] * c + projected[3] * s).abs() < 1e-15, "on the circle");
        assert!((momentum[1] * c - momentum[0] * s).abs() < 1e-13, "{momentum:?}");
    }
}

/// Units of masses and constraints, and masses of zero, change the multipliers only.
#[test]
fn units_do_not_matter() {
    let graph = Graph::new();
    let [vx, vy, vz, x, y] = graph.symbols(["x'", "y'", "z'", "x", "y"]);
    let rates = |mass: f64, units: [f64; 2]| {
        let system = System::builder(&graph)
            .coordinates(["x", "y", "z"])
            .lagrangian(|_, x, v| mass * ((v[0].square() + v[1].square()) / 2.0 - x[2]))
            .build()
            .unwrap();
        // z has no mass, and is bound to x and to y: k = 1 + m.
        let constraints = [
            Constraint::new("a", units[0] * (vz - vx * (1.0 + y.square()))),
            Constraint::new("b", units[1] * (vz - vy * (1.0 + x.square()))),
        ];
        let mut motion = system.with_multipliers(&constraints).unwrap().compile().unwrap();
        let mut rates = [0.0; 6];
        motion.rhs(0.0, &[0.3, -0.5, 0.2, 0.7, 1.25 / 1.09 * 0.7, 1.25 * 0.7], &mut rates).unwrap();
        rates
    };
    let expected = rates(1.0, [1.0, 1.0]);
    for (mass, units) in
        [(1e30, [1.0, 1.0]), (1e-30, [1.0, 1.0]), (1.0, [1e12, 1e-12]), (1e20, [1e-150, 1e100])]
    {
        for (found, expected) in rates(mass, units).iter().zip(&expected) {
            // The choice of independent velocities may differ: rounding of some dozen operations.
            assert!((found - expected).abs() < 1e-14, "{mass:e} {units:?}: {found} {expected}");
        }
    }
}

#[test]
fn values_that_are_not_finite_are_named() {
    let graph = Graph::new();
    let [x, y] = graph.symbols(["x", "y"]);
    let system = System::builder(&graph)
        .coordinates(["x", "y"])
        .lagrangian(|_, _, v| (v[0].square() + v[1].square()) / 2.0)
        .external_force(["y'"])
        .build()
        .unwrap();
    let curve = Constraint::new("curve", y - x.sqrt());
    let multipliers = system.with_multipliers(&[curve]).unwrap();
    let push = |t: f64, _: &[f64], q: &mut [f64]| q[0] = if t > 0.0 { f64::NAN } else { 2.0 };
    let mut motion = multipliers.compile_forced_for(CompileOptions::default(), push).unwrap();
    let state = [1.0, 1.0, 2.0, 1.0];
    let mut rates = [0.0; 4];
    motion.rhs(0.0, &state, &mut rates).unwrap();
    // (1, ½) q̈ = −ẋ²/4 · (0, 1) + forces along (1, ½): ẍ (1 + ¼) + ½ (−ẋ²/4) = ½ · 2
    assert!((rates[2] - (1.0 + 0.5) / 1.25).abs() < 1e-15, "{rates:?}");
    let failure = motion.rhs(1.0, &state, &mut rates).unwrap_err();
    assert_eq!(
        failure.to_string(),
        "the external force on `y'` is NaN at t = 1, x = 1, y = 1, x' = 2, y' = 1"
    );
    assert!(motion.observe(1.0, &state)[0].is_finite(), "the energy has no force in it");
    motion.project(1.0, &mut [1.1, 1.0, 2.0, 1.0]).unwrap();
    motion.rhs(0.0, &state, &mut rates).unwrap();
    // Off the domain of the constraint.
    let failure = motion.rhs(0.0, &[-1.0, 1.0, 2.0, 1.0], &mut rates).unwrap_err();
    assert!(failure.to_string().contains("sqrt(x)"), "{failure}");
    let failure = motion.project(0.0, &mut [-1.0, 1.0, 2.0, 1.0]).unwrap_err();
    assert!(failure.to_string().contains("sqrt(x)"), "{failure}");
}

/// The derivatives of |η| and of the sign of η do not contain η.
#[test]
fn constraints_are_affine_or_refused() {
    let graph = Graph::new();
    let [x, vx, vy] = graph.symbols(["x", "x'", "y'"]);
    let system = System::builder(&graph)
        .coordinates(["x", "y"])
        .lagrangian(|_, _, v| (v[0].square() + v[1].square()) / 2.0)
        .build()
        .unwrap();
    for expression in [vx.abs() - vy, vx.sign() - 1.0, vx.sign() * x, vx * vy, (x + vx).sin()] {
        let error = system.with_multipliers(&[Constraint::new("c", expression)]).unwrap_err();
        assert_eq!(
            error,
            MechError::Constraint(ConstraintError::NotAffine { constraint: "c".to_owned() }),
            "{expression}"
        );
    }
    let disguised = Constraint::new("c", ((vx + vy).square() - vy.square()) / (vx + 2.0 * vy) - x * vy - x);
    let (row, rest) = disguised.coefficients(&system).unwrap();
    assert_eq!((row, rest), (vec![1.0.into(), -x], -x));
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

/// A velocity in b_0 would count as a constant.
#[test]
fn a_frame_contains_no_velocities() {
    let graph = Graph::new();
    let [t, x, w, vx] = graph.symbols(["t", "x", "w", "x'"]);
    for (stray, name) in [(w, "w"), (vx, "x'")] {
        let b = Matrix::from_fn(1, 1, |_, _| Expr::ONE);
        let frame = Frame::new(&graph, t, vec![x], b, vec![0.3 * stray]).unwrap();
        let built = System::builder(&graph).quasi_velocities(["w"]).coordinates(["x"]).frame(frame);
        let error = built.lagrangian(|_, _, eta| eta[0].square() / 2.0).build().unwrap_err();
        assert_eq!(error, MechError::Frame(FrameError::OfVelocities { velocity: name.to_owned() }));
    }
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

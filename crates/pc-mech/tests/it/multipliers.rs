//! Constraints with multipliers against the same in independent velocities.

use pc_algebra::{LieGroup, UnitQuaternions};
use pc_mech::{
    AlgebraError, CompileOptions, Constraint, ConstraintError, EvaluationError, Expr, Frame, FrameError,
    Graph, Matrix, MechError, Motion, Multipliers, System, VectorField,
};

use crate::random::numbers;

/// A double pendulum in Cartesian coordinates, its point of support moved up and down; a force depends on velocities.
pub(crate) fn pendulum(graph: &Graph) -> Multipliers<'_> {
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
pub(crate) fn on_surface(motion: &mut Motion, t: f64, next: &mut impl FnMut() -> f64) -> Vec<f64> {
    loop {
        let mut y: Vec<f64> = (0..motion.dim()).map(|_| 1.5 * next()).collect();
        if motion.project(t, &mut y).is_ok() {
            return y;
        }
    }
}

pub(crate) fn values<'g>(graph: &'g Graph, motion: &Motion, t: f64, y: &[f64]) -> Vec<(Expr<'g>, f64)> {
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

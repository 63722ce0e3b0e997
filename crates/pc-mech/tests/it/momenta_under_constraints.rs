//! Momenta of all quasi-velocities under constraints, and their derivatives, against the motion of the
//! quasi-velocities.

use pc_mech::{CompileOptions, Constraint, Expr, Graph, Motion, Multipliers, System, VectorField};

/// A particle in a turning frame with a drag, on an ellipsoid that grows, on a skate: redundant velocities, brackets,
/// b_0, time, forces and both kinds of constraints.
fn held(graph: &Graph) -> Multipliers<'_> {
    let [m, x, y, z, u, v, w] = graph.symbols(["m", "x", "y", "z", "u", "v", "w"]);
    let t = graph.symbol("t");
    let system = System::builder(graph)
        .parameter(m, 2.0)
        .coordinates(["x", "y", "z", "φ"])
        .quasi_velocities(["u", "v", "w", "ω"])
        .kinematics(|_, x, eta| {
            let (s, c) = (x[3].sin(), x[3].cos());
            [c * eta[0] - s * eta[1] + x[1], s * eta[0] + c * eta[1] - x[0], eta[2], eta[3]]
        })
        .lagrangian(|t, x, eta| {
            m * (eta[0].square() + eta[1].square() + (1.0 + x[0].square()) * eta[2].square()) / 2.0
                + eta[3].square() / 3.0
                + x[1] * eta[2]
                - x[2] * (1.0 + t)
        })
        .forces(|_, x, eta| [-m * eta[0], x[2], Expr::ZERO, -eta[3] * x[0]])
        .build()
        .unwrap();
    let surface = Constraint::new("surface", x.square() + 2.0 * y.square() + z.square() - 1.0 - t / 3.0);
    let skate = Constraint::new("skate", x * v - z * u + w / 2.0 - 0.1);
    system.with_multipliers(&[surface, skate]).unwrap()
}

/// A state on the constraints, near one that is off them.
fn start(motion: &mut Motion, t: f64) -> Vec<f64> {
    let mut state = vec![0.5, 0.3, 0.7, 0.4, 0.2, -0.3, 0.5, 0.9];
    motion.project(t, &mut state).unwrap();
    state
}

/// ẋ is the same, and ẏ the derivative of ∂L/∂η along the motion of the quasi-velocities.
#[test]
fn the_motion_is_that_of_the_quasi_velocities() {
    let graph = Graph::new();
    let held = held(&graph);
    let mut usual = held.compile().unwrap();
    let mut motion = held.compile_in_momenta(CompileOptions::default(), &[0.0; 4]).unwrap();
    let mut transform = held.legendre_transform(&[0.0; 4]).unwrap();
    assert_eq!(motion.names(), ["x", "y", "z", "φ", "p_u", "p_v", "p_w", "p_ω"]);
    let (t, h) = (0.3, 1e-5);
    let state = start(&mut usual, t);
    let momenta = transform.to_momenta(t, &state).unwrap();
    let back = transform.to_quasi_velocities(t, &momenta).unwrap();
    for (found, expected) in back.iter().zip(&state) {
        assert!((found - expected).abs() < 1e-14, "{found} {expected}"); // roundings of an elimination of six rows
    }
    let mut rates = vec![0.0; 8];
    usual.rhs(t, &state, &mut rates).unwrap();
    let along: Vec<Vec<f64>> = [-h, h]
        .iter()
        .map(|h| {
            let moved: Vec<f64> = state.iter().zip(&rates).map(|(y, rate)| y + h * rate).collect();
            transform.to_momenta(t + h, &moved).unwrap()
        })
        .collect();
    let mut found = vec![0.0; 8];
    motion.rhs(t, &momenta, &mut found).unwrap();
    for i in 0..8 {
        let quotient = (along[1][i] - along[0][i]) / (2.0 * h);
        assert!((found[i] - quotient).abs() < 1e-9, "{i}: {} {quotient}", found[i]); // h² and rounding / h
    }
    assert_eq!(motion.constraint_names(), ["surface", "skate"]);
    assert!(motion.constraint_residuals(t, &momenta).iter().all(|residual| residual.abs() < 1e-14));
    for (a, b) in motion.observe(t, &momenta).iter().zip(usual.observe(t, &state)) {
        assert!((a - b).abs() < 1e-13, "{a} {b}");
    }
}

/// The Jacobians agree with difference quotients along the constraints, the only states at which the momenta
/// determine η.
#[test]
fn derivatives_agree_with_difference_quotients() {
    let graph = Graph::new();
    let held = held(&graph);
    let options = CompileOptions::default().parameter_jacobian(true);
    let mut motion = held.compile_in_momenta(options, &[0.0; 4]).unwrap();
    let mut transform = held.legendre_transform(&[0.0; 4]).unwrap();
    let (t, h) = (0.3, 1e-5);
    let state = start(&mut held.compile().unwrap(), t);
    let y = transform.to_momenta(t, &state).unwrap();
    let (mut jacobian, mut by_parameter) = (vec![0.0; 64], vec![0.0; 8]);
    motion.jacobian(t, &y, &mut jacobian).unwrap();
    motion.parameter_jacobian(t, &y, &mut by_parameter).unwrap();
    let rates = |motion: &mut Motion, y: &[f64]| {
        let mut rates = vec![0.0; 8];
        motion.rhs(t, y, &mut rates).unwrap();
        rates
    };
    for j in 0..8 {
        let [below, above] = [-h, h].map(|h| {
            let mut moved = y.clone();
            moved[j] += h;
            rates(&mut motion, &moved)
        });
        for i in 0..8 {
            let (found, quotient) = (jacobian[i + 8 * j], (above[i] - below[i]) / (2.0 * h));
            assert!((found - quotient).abs() < 1e-7 * (1.0 + found.abs()), "{i}, {j}: {found} {quotient}");
        }
    }
    let [below, above] = [2.0 - h, 2.0 + h].map(|m| {
        motion.parameters_mut()[0] = m;
        rates(&mut motion, &y)
    });
    for i in 0..8 {
        let (found, quotient) = (by_parameter[i], (above[i] - below[i]) / (2.0 * h));
        assert!((found - quotient).abs() < 1e-7 * (1.0 + found.abs()), "{i}: {found} {quotient}");
    }
}

/// A massless point on a rod with a massive one: L determines its velocity only with the constraint. And a
/// relativistic particle on a circle, where L is not quadratic.
#[test]
fn momenta_determine_velocities_with_the_constraints() {
    let graph = Graph::new();
    let [x, y] = graph.symbols(["x", "y"]);
    let light = System::builder(&graph)
        .coordinates(["x", "y"])
        .lagrangian(|_, x, v| v[0].square() / 2.0 - x[1])
        .build()
        .unwrap();
    let tied = light.with_multipliers(&[Constraint::new("tied", y - 2.0 * x)]).unwrap();
    let mut motion = tied.compile_in_momenta(CompileOptions::default(), &[0.0; 2]).unwrap();
    let mut rates = [0.0; 4];
    motion.rhs(0.0, &[0.5, 1.0, 0.25, 0.0], &mut rates).unwrap();
    assert_eq!(rates, [0.25, 0.5, -2.0, 0.0]); // ẍ = −2

    let fast = System::builder(&graph)
        .coordinates(["x", "y"])
        .lagrangian(|_, _, v| -(1.0 - v[0].square() - v[1].square()).sqrt())
        .build()
        .unwrap();
    let circle = fast.with_multipliers(&[Constraint::new("circle", x.square() + y.square() - 1.0)]).unwrap();
    let mut motion = circle.compile_in_momenta(CompileOptions::default(), &[0.0; 2]).unwrap();
    motion.rhs(0.0, &[0.6, 0.8, -0.6, 0.45], &mut rates).unwrap();
    // v = 0.6 along (−0.8, 0.6), y = v/√(1 − v²) = 0.75; the momentum turns with ω = 0.6.
    let expected = [-0.48, 0.36, -0.27, -0.36];
    for (found, expected) in rates.iter().zip(expected) {
        assert!((found - expected).abs() < 1e-12, "{rates:?}"); // Newton's method to rounding
    }
}

/// At a given speed a velocity and its opposite satisfy the constraint; the momentum of a convex L selects
/// one of them, for any guess.
#[test]
fn the_momentum_determines_the_sign_of_a_velocity() {
    let graph = Graph::new();
    let system = System::builder(&graph)
        .coordinates(["x", "y"])
        .lagrangian(|_, _, v| (v[0].square() + v[1].square()) / 2.0 + v[0].powi(4) / 20.0)
        .build()
        .unwrap();
    let v: Vec<Expr<'_>> = system.quasi_velocities().to_vec();
    let speed = Constraint::nonlinear("speed", v[0].square() + v[1].square() - 1.0);
    let held = system.with_multipliers(&[speed]).unwrap();
    let mut transform = held.legendre_transform(&[0.6, 0.8]).unwrap();
    for velocity in [[0.6, 0.8], [-0.6, 0.8], [-0.6, -0.8], [0.28, -0.96]] {
        let state = [0.0, 0.0, velocity[0], velocity[1]];
        let momenta = transform.to_momenta(0.0, &state).unwrap();
        let found = transform.to_quasi_velocities(0.0, &momenta).unwrap();
        let near = found.iter().zip(&state).all(|(a, b)| (a - b).abs() < 1e-14);
        assert!(near, "{found:?}, not {state:?}");
    }
}

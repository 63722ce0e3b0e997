//! Chetaev's canonical equations and Lagrange's equations of one system, against Poincaré's.

use crate::common;
use pc_mech::{Graph, MechError, Style, System, VectorField};

/// The heavy top in Euler's angles (ψ, θ, φ), quasi-velocities: the body angular velocity.
fn top(graph: &Graph) -> System<'_> {
    let [a, b, c, mgl] = graph.symbols(["A", "B", "C", "mgl"]);
    common::in_eulers_angles(graph)
        .parameter(a, 1.0)
        .parameter(b, 1.5)
        .parameter(c, 0.5)
        .parameter(mgl, 2.0)
        .lagrangian(|_, x, w| {
            (a * w[0].square() + b * w[1].square() + c * w[2].square()) / 2.0 - mgl * x[1].cos()
        })
        .integral("about the vertical", |_, x, w| {
            let across = a * w[0] * x[2].sin() + b * w[1] * x[2].cos();
            x[1].sin() * across + c * w[2] * x[1].cos()
        })
        .build()
        .unwrap()
}

/// A bead on a turning hoop with a driven frame: η = θ̇ − Ω sin t, a coordinate force, L with terms linear in η.
fn hoop(graph: &Graph) -> System<'_> {
    let [m, omega] = graph.symbols(["m", "Ω"]);
    System::builder(graph)
        .parameter(m, 1.3)
        .parameter(omega, 0.7)
        .coordinates(["θ", "s"])
        .quasi_velocities(["u", "v"])
        .kinematics(|t, x, eta| [eta[0] + omega * t.sin(), eta[1] * x[0].cos() + t * x[1]])
        .lagrangian(|t, x, eta| {
            let kinetic = m * (eta[0].square() + x[0].sin() * eta[0] * eta[1] + eta[1].square()) / 2.0;
            kinetic + t.cos() * x[1] * eta[0] + m * x[0].cos() * x[1]
        })
        .forces(|_, x, eta| [-eta[0] / 3.0, x[0] * eta[1]])
        .build()
        .unwrap()
}

/// The hoop with a Lagrangian that is not quadratic: η₁⁴, a product of exponentials, and terms linear in η.
fn steep_hoop(graph: &Graph) -> System<'_> {
    let [m, omega] = graph.symbols(["m", "Ω"]);
    System::builder(graph)
        .parameter(m, 1.3)
        .parameter(omega, 0.7)
        .coordinates(["θ", "s"])
        .quasi_velocities(["u", "v"])
        .kinematics(|t, x, eta| [eta[0] + omega * t.sin(), eta[1] * x[0].cos() + t * x[1]])
        .lagrangian(|t, x, eta| {
            let kinetic = m * (eta[0].square() + eta[1].square()) / 2.0 + eta[0].powi(4) / 12.0;
            let steep = (x[0].sin() * eta[0] - eta[1] / 2.0).exp();
            kinetic + m * steep + t.cos() * x[1] * eta[0] + m * x[0].cos() * x[1]
        })
        .forces(|_, x, eta| [-eta[0] / 3.0, x[0] * eta[1]])
        .build()
        .unwrap()
}

/// ẋ and η̇ by Poincaré's equations at (t, x, η) against the canonical equations: ẏ = d/dt ∂L/∂η.
fn forms_agree(system: &System<'_>, t: f64, x: &[f64], eta: &[f64]) {
    let graph = system.graph();
    let (n, k) = (x.len(), eta.len());
    let state: Vec<f64> = x.iter().chain(eta).copied().collect();
    let mut rates = vec![0.0; n + k];
    system.poincare().unwrap().compile().unwrap().rhs(t, &state, &mut rates).unwrap();

    let canonical = system.canonical().unwrap();
    let mut values = vec![(system.frame().time(), t)];
    values.extend(system.frame().coordinates().iter().copied().zip(x.iter().copied()));
    values.extend(system.quasi_velocities().iter().copied().zip(eta.iter().copied()));
    values.extend(system.parameters().iter().copied());
    let momenta = canonical.momenta_of_velocities();
    // ẏ = ∂p/∂t + ∂p/∂x ẋ + ∂p/∂η η̇
    let symbols: Vec<_> =
        system.frame().coordinates().iter().chain(system.quasi_velocities()).copied().collect();
    let expected: Vec<f64> = momenta
        .iter()
        .map(|&p| {
            let slopes = graph.gradient(p, &symbols);
            let slopes = graph.evaluate(&slopes, &values).unwrap();
            let drift = graph.evaluate(&[p.derivative(system.frame().time())], &values).unwrap()[0];
            drift + slopes.iter().zip(&rates).map(|(slope, rate)| slope * rate).sum::<f64>()
        })
        .collect();
    let y = graph.evaluate(momenta, &values).unwrap();
    let mut transform = canonical.legendre_transform().unwrap();
    let original = state;
    let state = transform.to_momenta(t, &original).unwrap();
    close(&state[n..], &y);
    close(&transform.to_quasi_velocities(t, &state).unwrap(), &original);
    let mut motion = canonical.compile_for(pc_mech::CompileOptions::default()).unwrap();
    let mut found = vec![0.0; n + k];
    motion.rhs(t, &state, &mut found).unwrap();
    let expected: Vec<f64> = rates[..n].iter().copied().chain(expected).collect();
    close(&found, &expected);

    // The values of the printed expressions.
    values.extend(canonical.momenta().iter().copied().zip(y.iter().copied()));
    let mut printed = graph.evaluate(canonical.velocities(), &values).unwrap();
    printed.extend(graph.evaluate(canonical.right_hand_side(), &values).unwrap());
    close(&printed, &expected);
    close(&graph.evaluate(canonical.quasi_velocities(), &values).unwrap(), eta); // the Legendre round trip
    let energies = graph.evaluate(&[canonical.hamiltonian(), system.energy()], &values).unwrap();
    close(&energies[..1], &energies[1..]);
}

/// Rounding of some hundred operations on numbers of order one to ten.
fn close(found: &[f64], expected: &[f64]) {
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() <= 1e-12 * (1.0 + b.abs()), "{found:?} where {expected:?} is right");
    }
}

#[test]
fn canonical_equations_are_poincares() {
    let graph = Graph::new();
    let top = top(&graph);
    let graph = Graph::new();
    let hoop = hoop(&graph);
    let graph = Graph::new();
    let steep = steep_hoop(&graph);
    assert!(hoop.canonical().unwrap().is_closed() && !steep.canonical().unwrap().is_closed());
    for i in 0..50 {
        let f = |j: i32| (f64::from(i * 7 + j * 13) * 0.618).sin();
        forms_agree(&top, 0.0, &[f(1), 1.5 + f(2), 3.0 * f(3)], &[2.0 * f(4), f(5), 3.0 * f(6)]);
        forms_agree(&hoop, f(7), &[f(1), f(2)], &[f(3), f(4)]);
        forms_agree(&steep, f(7), &[f(1), f(2)], &[2.0 * f(3), 2.0 * f(4)]);
    }
}

#[test]
fn lagranges_equations_are_poincares() {
    let graph = Graph::new();
    for (system, x, eta) in [
        (top(&graph), vec![0.3, 1.1, -0.4], vec![0.5, -0.2, 2.0]),
        (hoop(&graph), vec![0.3, 1.1], vec![0.5, -0.2]),
    ] {
        let (n, t) = (x.len(), 0.37);
        let lagrange = system.in_velocities().unwrap();
        let mut rates = vec![0.0; 2 * n];
        let state: Vec<f64> = x.iter().chain(&eta).copied().collect();
        system.poincare().unwrap().compile().unwrap().rhs(t, &state, &mut rates).unwrap();
        // ẍ by differentiating ẋ = b η + b_0 along the motion
        let velocities = system.frame().velocities(system.quasi_velocities());
        let symbols = || system.frame().coordinates().iter().chain(system.quasi_velocities()).copied();
        let mut values: Vec<_> = symbols().zip(state).chain([(system.frame().time(), t)]).collect();
        values.extend(system.parameters().iter().copied());
        let slopes = |f| graph.evaluate(&graph.gradient(f, &symbols().collect::<Vec<_>>()), &values).unwrap();
        let expected: Vec<f64> = velocities
            .iter()
            .map(|&f| {
                let drift = graph.evaluate(&[f.derivative(system.frame().time())], &values).unwrap()[0];
                drift + slopes(f).iter().zip(&rates).map(|(slope, rate)| slope * rate).sum::<f64>()
            })
            .collect();
        let state: Vec<f64> = x.iter().chain(&rates[..n]).copied().collect();
        let mut found = vec![0.0; 2 * n];
        lagrange.poincare().unwrap().compile().unwrap().rhs(t, &state, &mut found).unwrap();
        close(&found[n..], &expected);
    }
}

/// (25) with the moments of inertia A, B, C, since (A_2 − A_3)/(A_2 A_3) = 1/A_3 − 1/A_2.
#[test]
fn the_canonical_top_prints_as_in_the_paper() {
    let graph = Graph::new();
    let top = common::top_of_parameters(&graph).build().unwrap();
    let canonical = top.canonical().unwrap();
    let lines: Vec<String> =
        canonical.balance(Style::Text).into_iter().map(|(left, right)| format!("{left} = {right}")).collect();
    let expected = [
        "p_ω1' = m3*γ2 - m2*γ3 + p_ω2*p_ω3*(1/C - 1/B)",
        "p_ω2' = m1*γ3 - m3*γ1 + p_ω1*p_ω3*(1/A - 1/C)",
        "p_ω3' = m2*γ1 - m1*γ2 + p_ω1*p_ω2*(1/B - 1/A)",
    ];
    assert_eq!(lines, expected);
    assert!(matches!(top.in_velocities(), Err(MechError::Algebra(_))));
}

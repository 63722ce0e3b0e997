//! Complete integrals of Hamilton–Jacobi's equation, and the motions they give, against closed forms.

use pc_analysis::{AnalysisError, CompleteIntegral, hamilton_jacobi};
use pc_mech::{Canonical, Graph, System};

fn close(found: &[f64], expected: &[f64]) {
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() <= 1e-12 * (1.0 + b.abs()), "{found:?} where {expected:?} is right");
    }
}

/// x = x_0 + α t
#[test]
fn a_free_particle() {
    let graph = Graph::new();
    let [m, t, x, y, a, b] = graph.symbols(["m", "t", "x", "y", "a", "b"]);
    let particle = System::builder(&graph)
        .parameter(m, 2.0)
        .coordinates(["x", "y"])
        .lagrangian(|_, _, v| m * (v[0].square() + v[1].square()) / 2.0)
        .build()
        .unwrap();
    let canonical = particle.canonical().unwrap();
    let action = a * x + b * y - (a.square() + b.square()) * t / (2.0 * m);
    let mut integral = CompleteIntegral::new(&canonical, action, &["a", "b"]).unwrap();
    let alpha = [3.0, -1.0];
    let beta = integral.betas(0.5, &[0.2, 0.7], &alpha).unwrap();
    let state = integral.state(2.5, &alpha, &beta, &[0.0, 0.0]).unwrap();
    close(&state, &[0.2 + 1.5 * 2.0, 0.7 - 0.5 * 2.0, 3.0, -1.0]);
}

fn falling(graph: &Graph) -> Canonical<'_> {
    let [g] = graph.symbols(["g"]);
    let body = System::builder(graph)
        .parameter(g, 9.0)
        .coordinates(["x"])
        .lagrangian(|_, x, v| v[0].square() / 2.0 - g * x[0])
        .build()
        .unwrap();
    body.canonical().unwrap()
}

/// Thrown upwards with the energy E: S = −(2(E − g x))^(3/2)/(3g) − E t, and a second integral that is a
/// polynomial.
#[test]
fn a_falling_body() {
    let graph = Graph::new();
    let canonical = falling(&graph);
    let [g, t, x, e] = graph.symbols(["g", "t", "x", "E"]);
    let root = (2.0 * (e - g * x)).sqrt();
    let mut integral = CompleteIntegral::new(&canonical, -root.powi(3) / (3.0 * g) - e * t, &["E"]).unwrap();
    let (x0, v0) = (1.0, 6.0);
    let energy = v0 * v0 / 2.0 + 9.0 * x0;
    let beta = integral.betas(0.0, &[x0], &[energy]).unwrap();
    for time in [0.1, 0.3, 0.6] {
        // rising on this branch, until 2/3
        let state = integral.state(time, &[energy], &beta, &[x0]).unwrap();
        close(&state, &[x0 + v0 * time - 4.5 * time * time, v0 - 9.0 * time]);
    }
    // With the momentum p at t = 0: S = (p − g t) x + (p − g t)³/(6g)
    let p = graph.symbol("p");
    let momentum = p - g * t;
    let action = momentum * x + momentum.powi(3) / (6.0 * g);
    let mut integral = CompleteIntegral::new(&canonical, action, &["p"]).unwrap();
    let beta = integral.betas(0.0, &[x0], &[v0]).unwrap();
    close(&integral.state(2.0, &[v0], &beta, &[0.0]).unwrap(), &[x0 + 2.0 * v0 - 18.0, v0 - 18.0]);
}

/// S = x r/2 + (E/ω) arctan(ω x/r) − E t, r² = 2E − ω² x²: β = arctan(ω x/r)/ω − t, so x = √(2E) sin ω(t +
/// β)/ω.
#[test]
fn a_harmonic_oscillator() {
    let graph = Graph::new();
    let [omega, t, x, e] = graph.symbols(["ω", "t", "x", "E"]);
    let oscillator = System::builder(&graph)
        .parameter(omega, 1.5)
        .coordinates(["x"])
        .lagrangian(|_, x, v| (v[0].square() - (omega * x[0]).square()) / 2.0)
        .build()
        .unwrap();
    let canonical = oscillator.canonical().unwrap();
    let root = (2.0 * e - (omega * x).square()).sqrt();
    let action = x * root / 2.0 + e / omega * (omega * x / root).atan() - e * t;
    assert!(hamilton_jacobi(&canonical, action).unwrap().is_zero());
    let mut integral = CompleteIntegral::new(&canonical, action, &["E"]).unwrap();
    let (energy, phase) = (2.0f64, 0.4);
    for time in [-0.9, 0.0, 0.5] {
        let angle = 1.5 * (time + phase);
        let state = integral.state(time, &[energy], &[phase], &[0.0]).unwrap();
        close(&state, &[2.0 * angle.sin() / 1.5, 2.0 * angle.cos()]);
    }
}

/// The form of textbooks, S = x r/2 + (E/ω) arcsin(ω x/√(2E)) − E t, in which √(2E) √(1 − ω² x²/(2E)) = r is
/// unknown to the graph; and a function that differs from it.
#[test]
fn a_harmonic_oscillator_with_an_arc_sine() {
    let graph = Graph::new();
    let [omega, t, x, e] = graph.symbols(["ω", "t", "x", "E"]);
    let oscillator = System::builder(&graph)
        .parameter(omega, 1.5)
        .coordinates(["x"])
        .lagrangian(|_, x, v| (v[0].square() - (omega * x[0]).square()) / 2.0)
        .build()
        .unwrap();
    let canonical = oscillator.canonical().unwrap();
    let root = (2.0 * e - (omega * x).square()).sqrt();
    let with =
        |factor: f64| x * root / 2.0 + factor * e / omega * (omega * x / (2.0 * e).sqrt()).asin() - e * t;
    let mut integral = CompleteIntegral::new(&canonical, with(1.0), &["E"]).unwrap();
    let angle = 1.5 * (0.5 + 0.4);
    close(
        &integral.state(0.5, &[2.0], &[0.4], &[0.0]).unwrap(),
        &[2.0 * f64::sin(angle) / 1.5, 2.0 * f64::cos(angle)],
    );
    let wrong = CompleteIntegral::new(&canonical, with(1.0 + 1e-9), &["E"]).unwrap_err();
    assert!(matches!(wrong, AnalysisError::NotAnAction { .. }), "{wrong}");
}

/// A free particle in the polar frame η = (ρ̇, ρφ̇), whose operators do not commute: S = r − a arctan(r/a) +
/// a φ − E t, r² = 2E ρ² − a²; the motion is a straight line.
#[test]
fn a_particle_in_a_polar_frame() {
    let graph = Graph::new();
    let [t, rho, phi, e, a] = graph.symbols(["t", "ρ", "φ", "E", "a"]);
    let particle = System::builder(&graph)
        .coordinates(["ρ", "φ"])
        .quasi_velocities(["u", "v"])
        .kinematics(|_, x, eta| [eta[0], eta[1] / x[0]])
        .lagrangian(|_, _, eta| (eta[0].square() + eta[1].square()) / 2.0)
        .build()
        .unwrap();
    let canonical = particle.canonical().unwrap();
    let root = (2.0 * e * rho.square() - a.square()).sqrt();
    let action = root - a * (root / a).atan() + a * phi - e * t;
    let mut integral = CompleteIntegral::new(&canonical, action, &["E", "a"]).unwrap();
    assert_eq!(integral.momenta()[1], a / rho);

    // From (1, 1) with the velocity (2, 0.5): E = 2.125, a = 0.5 − 2 = −1.5.
    let polar = |x: f64, y: f64| [x.hypot(y), y.atan2(x)];
    let alpha = [2.125, -1.5];
    let beta = integral.betas(0.0, &polar(1.0, 1.0), &alpha).unwrap();
    let (x, y) = (1.0 + 2.0 * 0.8, 1.0 + 0.5 * 0.8);
    let [rho, phi] = polar(x, y);
    let state = integral.state(0.8, &alpha, &beta, &polar(1.0, 1.0)).unwrap();
    close(&state, &[rho, phi, (2.0 * x + 0.5 * y) / rho, -1.5 / rho]);
}

/// ẋ = η + x, so that X_0 = ∂/∂t + x ∂/∂x: S = α x e^{−t} + ¼ α² e^{−2t}.
#[test]
fn a_moving_frame() {
    let graph = Graph::new();
    let [t, x, a] = graph.symbols(["t", "x", "a"]);
    let particle = System::builder(&graph)
        .coordinates(["x"])
        .quasi_velocities(["η"])
        .kinematics(|_, x, eta| [eta[0] + x[0]])
        .lagrangian(|_, _, eta| eta[0].square() / 2.0)
        .build()
        .unwrap();
    let canonical = particle.canonical().unwrap();
    let action = a * x * (-t).exp() + a.square() * (-2.0 * t).exp() / 4.0;
    let mut integral = CompleteIntegral::new(&canonical, action, &["a"]).unwrap();
    // η̇ = −η, ẋ = η + x: x = (x_0 + ½η_0) e^t − ½η_0 e^{−t}
    let (x0, eta0) = (0.3f64, 0.8);
    let beta = integral.betas(0.0, &[x0], &[eta0]).unwrap();
    let time = 1.2f64;
    let expected = (x0 + eta0 / 2.0) * time.exp() - eta0 / 2.0 * (-time).exp();
    close(&integral.state(time, &[eta0], &beta, &[x0]).unwrap(), &[expected, eta0 * (-time).exp()]);
}

#[test]
fn an_incomplete_integral_is_refused() {
    let graph = Graph::new();
    let canonical = falling(&graph);
    let [t, x, c] = graph.symbols(["t", "x", "c"]);
    let message = |error: AnalysisError| error.to_string();
    let wrong = CompleteIntegral::new(&canonical, c * x, &["c"]).unwrap_err();
    assert_eq!(
        message(wrong),
        "S does not satisfy Hamilton–Jacobi's equation: X_0 S + H(t, x, X_s S) = g*x + 1/2*c^2"
    );
    let g = graph.symbol("g");
    let additive = -g * t * x - g.square() * t.powi(3) / 6.0 + c;
    let incomplete = CompleteIntegral::new(&canonical, additive, &["c"]).unwrap_err();
    assert_eq!(message(incomplete), "the integral is not complete: the matrix ∂(X_s S)/∂α has rank 0 of 1");
    let many = CompleteIntegral::new(&canonical, additive, &["c", "d"]).unwrap_err();
    assert_eq!(message(many), "the list of constants has 2 entries where 1 are needed");

    let e = graph.symbol("E");
    let root = (2.0 * (e - g * x)).sqrt();
    let mut integral = CompleteIntegral::new(&canonical, -root.powi(3) / (3.0 * g) - e * t, &["E"]).unwrap();
    let outside = integral.betas(0.0, &[3.0], &[1.0]).unwrap_err();
    assert!(matches!(outside, AnalysisError::Expr(_)), "{outside}");
    // After its greatest height it is on the other branch.
    let late = integral.state(2.0, &[27.0], &[-0.6], &[1.0]).unwrap_err();
    assert!(matches!(late, AnalysisError::NoPosition { t: 2.0, .. }), "{late}");
    assert!(late.to_string().starts_with("∂S/∂α = β has no solution near the guess: after "), "{late}");

    let graph = Graph::new();
    let damped = System::builder(&graph)
        .coordinates(["x"])
        .lagrangian(|_, _, v| v[0].square() / 2.0)
        .forces(|_, _, v| [-v[0]])
        .build()
        .unwrap();
    let forced = hamilton_jacobi(&damped.canonical().unwrap(), graph.symbol("x")).unwrap_err();
    assert_eq!(message(forced), "Hamilton–Jacobi's equation needs Q = 0; the force on `x'` is not zero");
}

//! Equilibria and steady motions, their first approximation and their second variation, against the classical
//! conditions.

use pc_analysis::{
    AnalysisError, SecondVariation, Spectrum, SteadyMotion, SteadyOptions, Verdict, first_approximation,
};
use pc_mech::{Equations, Graph, LieAlgebra, Matrix, Motion, System};

const A: f64 = 1.3;
const C: f64 = 0.7;
const MGL: f64 = 2.1;

/// Lagrange's top in Euler's angles.
fn top_in_angles() -> Motion {
    let graph = Graph::new();
    let [a, c, mgl] = graph.symbols(["A", "C", "mgl"]);
    let top = System::builder(&graph)
        .parameter(a, A)
        .parameter(c, C)
        .parameter(mgl, MGL)
        .coordinates(["ψ", "θ", "φ"])
        .lagrangian(|_, x, v| {
            let spin = v[2] + v[0] * x[1].cos();
            let across = v[1].square() + (v[0] * x[1].sin()).square();
            (a * across + c * spin.square()) / 2.0 - mgl * x[1].cos()
        })
        .build()
        .unwrap();
    top.poincare().unwrap().compile().unwrap()
}

/// The same top in Poisson's variables, which are regular at the vertical.
fn top_in_poisson_variables(graph: &Graph) -> Equations<'_> {
    let [a, c, mgl] = graph.symbols(["A", "C", "mgl"]);
    let top = System::builder(graph)
        .parameter(a, A)
        .parameter(c, C)
        .parameter(mgl, MGL)
        .coordinates(["γ1", "γ2", "γ3"])
        .quasi_velocities(["ω1", "ω2", "ω3"])
        .kinematics(|_, g, w| {
            [g[1] * w[2] - g[2] * w[1], g[2] * w[0] - g[0] * w[2], g[0] * w[1] - g[1] * w[0]]
        })
        .algebra(&LieAlgebra::so3())
        .lagrangian(|_, g, w| (a * (w[0].square() + w[1].square()) + c * w[2].square()) / 2.0 - mgl * g[2])
        .integral("vertical", |_, g, _| g[0].square() + g[1].square() + g[2].square())
        .integral("momentum", |_, g, w| a * (g[0] * w[0] + g[1] * w[1]) + c * g[2] * w[2])
        .integral("spin", |_, _, w| w[2])
        .build()
        .unwrap();
    top.poincare().unwrap()
}

fn euler_top(graph: &Graph) -> Equations<'_> {
    let moments = [1.0, 2.0, 3.0];
    let top = System::builder(graph)
        .quasi_velocities(["ω1", "ω2", "ω3"])
        .algebra(&LieAlgebra::so3())
        .lagrangian(|_, _, w| (0..3).map(|s| moments[s] * w[s].square() / 2.0).sum())
        .integral("momentum²", |_, _, w| (0..3).map(|s| (moments[s] * w[s]).square()).sum())
        .build()
        .unwrap();
    top.poincare().unwrap()
}

fn pendulum(damping: f64) -> Motion {
    let graph = Graph::new();
    let pendulum = System::builder(&graph)
        .coordinates(["θ"])
        .lagrangian(|_, x, v| v[0].square() / 2.0 + 4.0 * x[0].cos())
        .forces(|_, _, v| [-damping * v[0]])
        .build()
        .unwrap();
    pendulum.poincare().unwrap().compile().unwrap()
}

/// The middle of the last interval where `holds` changes from false to true, 2⁻⁵⁰ of the first.
fn threshold(mut low: f64, mut high: f64, mut holds: impl FnMut(f64) -> bool) -> f64 {
    assert!(!holds(low) && holds(high));
    for _ in 0..50 {
        let middle = (low + high) / 2.0;
        if holds(middle) { high = middle } else { low = middle }
    }
    (low + high) / 2.0
}

/// A cos θ Ω² − C ω_3 Ω + mgl = 0 with ω_3 = φ̇ + Ω cos θ: both roots Ω for one θ and φ̇, and Routh's
/// frequency of the nutation, ν² A² Ω² = A² Ω⁴ − 2 A mgl Ω² cos θ + (mgl)².
#[test]
fn lagranges_top_precesses_steadily() {
    let mut top = top_in_angles();
    let (theta, spin) = (1.0f64, 9.0);
    let options = SteadyOptions::default().fixed(["θ", "φ'"]);
    // (A − C) cos θ Ω² − C φ̇ Ω + mgl = 0
    let [p, q] = [(A - C) * theta.cos(), C * spin];
    let root = (q * q - 4.0 * p * MGL).sqrt();
    for (guess, expected) in [(0.1, 2.0 * MGL / (q + root)), (25.0, (q + root) / (2.0 * p))] {
        let start = [0.4, theta, -0.2, guess, 0.3, spin];
        let steady = SteadyMotion::near(&mut top, 0.0, &start, &options).unwrap();
        let omega = steady.state[3];
        let omega3 = steady.state[5] + omega * theta.cos();
        let relation = A * theta.cos() * omega * omega - C * omega3 * omega + MGL;
        assert!(relation.abs() < 1e-12 * (1.0 + (C * omega3 * omega).abs()), "{relation:e}");
        assert!((omega - expected).abs() < 1e-12 * expected, "{omega} where {expected} is right");
        assert!(steady.state[4].abs() < 1e-13);
        assert_eq!(steady.rates, [("ψ".to_owned(), omega), ("φ".to_owned(), spin)]);
        assert_eq!(steady.components, ["θ", "ψ'", "θ'", "φ'"]);

        assert_eq!(steady.verdict(), Verdict::Undecided);
        assert_eq!(steady.spectrum.zero_blocks(), [2]);
        let square = omega * omega;
        let nutation = (A * A * square * square - 2.0 * A * MGL * square * theta.cos() + MGL * MGL).sqrt();
        let found = steady.spectrum.eigenvalues().iter().map(|value| value.imaginary).fold(0.0, f64::max);
        let expected = nutation / (A * omega);
        assert!((found - expected).abs() < 1e-10 * expected, "{found} where {expected} is right");

        // With the angles included, each belongs to a Jordan block of two zeros: growth like t, which is no
        // instability.
        let whole = Spectrum::of(&first_approximation(&mut top, 0.0, &steady.state).unwrap(), 0.0).unwrap();
        assert_eq!(whole.zero_blocks(), [2, 2]);
        assert_eq!(whole.verdict(), Verdict::Undecided);
    }
}

/// Without fixed components the Jacobian is singular along a family of two dimensions; a solution near the
/// guess is found nevertheless.
#[test]
fn a_member_of_a_family_is_found_near_the_guess() {
    let mut top = top_in_angles();
    let guess = [0.0, 1.0, 0.0, 0.4, 0.1, 9.0];
    let steady = SteadyMotion::near(&mut top, 0.0, &guess, &SteadyOptions::default()).unwrap();
    let (theta, omega) = (steady.state[1], steady.state[3]);
    let omega3 = steady.state[5] + omega * theta.cos();
    assert!((A * theta.cos() * omega * omega - C * omega3 * omega + MGL).abs() < 1e-12);
    assert!(steady.state.iter().zip(guess).all(|(y, guess)| (y - guess).abs() < 0.15), "{:?}", steady.state);
}

/// In Poisson's variables γ² is part of the state: without it among the equations the iteration leaves γ² =
/// 1, and finds a steady motion of a heavier top. With γ² and the momentum about the vertical fixed, the
/// motion is a rotation about it, C ω_3 being that momentum.
#[test]
fn a_steady_motion_is_found_on_a_surface() {
    let graph = Graph::new();
    let mut motion = top_in_poisson_variables(&graph).compile().unwrap();
    let start = [0.36, 0.48, 0.8, 0.1, -0.2, 1.5];
    let momentum = |y: &[f64]| A * (y[0] * y[3] + y[1] * y[4]) + C * y[2] * y[5];
    let surface = |y: &[f64]| {
        let vertical = y[0] * y[0] + y[1] * y[1] + y[2] * y[2] - 1.0;
        let normals = [
            [2.0 * y[0], 2.0 * y[1], 2.0 * y[2], 0.0, 0.0, 0.0],
            [A * y[3], A * y[4], C * y[5], A * y[0], A * y[1], C * y[2]],
        ];
        Ok((vec![vertical, momentum(y) - momentum(&start)], Matrix::from_fn(2, 6, |i, j| normals[i][j])))
    };
    let options = SteadyOptions::default();
    let found = SteadyMotion::on_surface(&mut motion, 0.0, &start, &options, surface).unwrap();
    let [g1, g2, g3, w1, w2, w3] = found.state[..] else { panic!("six components") };
    // The iteration ends at rounding of numbers of size 1; a double root has half the digits.
    let close = |a: f64, b: f64| (a - b).abs() < 1e-7;
    assert!(close(g1 * g1 + g2 * g2 + g3 * g3, 1.0), "{found:?}");
    assert!(close(momentum(&found.state), momentum(&start)), "{found:?}");
    assert!(close(w1 * g2, w2 * g1) && close(w2 * g3, w3 * g2) && close(w3 * g1, w1 * g3), "{found:?}");

    let free = SteadyMotion::near(&mut motion, 0.0, &start, &options).unwrap();
    let square: f64 = free.state[..3].iter().map(|g| g * g).sum();
    assert!((square - 1.0).abs() > 1e-3, "{square}");
}

/// C² ω_3² = 4 A mgl, from the eigenvalues: unstable below. Near it the real part grows as a square root, so
/// that the tolerance of the verdict, about 10⁻⁷ |A|, is 10⁻¹³ in ω_3.
#[test]
fn the_sleeping_top_wakes_at_its_threshold() {
    let graph = Graph::new();
    let mut top = top_in_poisson_variables(&graph).compile().unwrap();
    let expected = (4.0 * A * MGL).sqrt() / C;
    let found = threshold(0.5 * expected, 1.7 * expected, |spin| {
        let steady =
            SteadyMotion::near(&mut top, 0.0, &[0.0, 0.0, 1.0, 0.0, 0.0, spin], &SteadyOptions::default())
                .unwrap();
        assert_eq!(steady.residual, 0.0);
        assert_eq!(steady.spectrum.zero_blocks(), [2]); // γ_3 and ω_3
        steady.verdict() != Verdict::Unstable
    });
    assert!((found - expected).abs() < 1e-9, "{found} where {expected} is right");
}

/// The same from the energy and its integrals, whose gradients depend on each other at the vertical: definite
/// for one of the free multipliers iff C² ω_3² > 4 A mgl. The second variation changes with the first power
/// of ω_3.
#[test]
fn the_sleeping_top_is_stable_above_its_threshold() {
    let graph = Graph::new();
    let top = top_in_poisson_variables(&graph);
    let expected = (4.0 * A * MGL).sqrt() / C;
    let at = |spin: f64| SecondVariation::at(&top, &[0.0, 0.0, 1.0, 0.0, 0.0, spin]).unwrap();
    let found = threshold(0.5 * expected, 1.7 * expected, |spin| at(spin).verdict == Verdict::Stable);
    assert!((found - expected).abs() < 1e-9, "{found} where {expected} is right");
    let fast = at(2.0 * expected);
    assert!(fast.residual < 1e-15);
    assert!(matches!(fast.signature(), (4, 0, 0) | (0, 4, 0)), "{fast:?}");
    let names: Vec<&str> = fast.multipliers.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["vertical", "momentum", "spin"]);
    // A λ² + C ω_3 λ + mgl < 0 for the multiplier λ of the momentum
    let lambda = fast.multipliers[1].1;
    assert!(A * lambda * lambda + C * 2.0 * expected * lambda + MGL < 0.0, "{lambda}");
}

/// Euler's top about its longest axis: H alone has no extremum there, but H under the momentum has; the
/// integrals are arguments here.
#[test]
fn the_second_variation_is_taken_under_given_integrals() {
    let graph = Graph::new();
    let top = euler_top(&graph);
    let state = [2.0, 0.0, 0.0];
    let declared = SecondVariation::at(&top, &state).unwrap();
    assert_eq!(declared.verdict, Verdict::Stable);
    assert_eq!(SecondVariation::under(&top, top.system().integrals(), &state).unwrap(), declared);
    assert_eq!(SecondVariation::under(&top, &[], &state).unwrap().verdict, Verdict::Undecided);
    let changing = [("ω1".to_owned(), graph.symbol("ω1"))];
    let refused = SecondVariation::under(&top, &changing, &state);
    assert!(matches!(refused, Err(AnalysisError::NotConserved { name }) if name == "ω1"));
}

#[test]
fn the_middle_axis_is_unstable() {
    let graph = Graph::new();
    let equations = euler_top(&graph);
    let mut top = equations.compile().unwrap();
    let growth = 2.0 / 3f64.sqrt(); // λ² = ω² (I_2 − I_1)(I_3 − I_2)/(I_1 I_3), ω = 2
    for (axis, first, second) in [
        (0, Verdict::Undecided, Verdict::Stable),
        (1, Verdict::Unstable, Verdict::Undecided),
        (2, Verdict::Undecided, Verdict::Stable),
    ] {
        let mut guess = [0.05, -0.04, 0.03];
        guess[axis] = 2.0;
        let name = ["ω1", "ω2", "ω3"][axis];
        let steady =
            SteadyMotion::near(&mut top, 0.0, &guess, &SteadyOptions::default().fixed([name])).unwrap();
        assert!((0..3).all(|s| s == axis || steady.state[s].abs() < 1e-13), "{:?}", steady.state);
        assert_eq!(steady.verdict(), first, "about axis {axis}");
        assert_eq!(steady.spectrum.zero_blocks(), [1]);
        if axis == 1 {
            assert!((steady.spectrum.eigenvalues()[0].real - growth).abs() < 1e-13);
        }
        let variation = SecondVariation::at(&equations, &steady.state).unwrap();
        assert_eq!(variation.verdict, second, "about axis {axis}");
        assert!(variation.residual < 1e-13);
        let expected = [(0, 2, 0), (1, 1, 0), (2, 0, 0)][axis]; // I_s (1 − I_s/I_axis)
        assert_eq!(variation.signature(), expected, "about axis {axis}");
    }
}

#[test]
fn a_pendulum_hangs_and_does_not_stand() {
    for (damping, guess, equilibrium, verdict) in [
        (0.0, 0.4, 0.0, Verdict::Undecided),
        (0.5, 0.4, 0.0, Verdict::AsymptoticallyStable),
        (0.0, 2.9, std::f64::consts::PI, Verdict::Unstable),
        (0.5, 2.9, std::f64::consts::PI, Verdict::Unstable),
    ] {
        let steady =
            SteadyMotion::near(&mut pendulum(damping), 0.0, &[guess, 0.1], &SteadyOptions::default())
                .unwrap();
        assert!(
            (steady.state[0] - equilibrium).abs() < 1e-15 && steady.state[1].abs() < 1e-15,
            "{:?}",
            steady.state
        );
        assert_eq!(steady.verdict(), verdict);
        // λ² + D λ ± 4 = 0
        let square = damping * damping / 4.0 + if equilibrium > 0.0 { 4.0 } else { -4.0 };
        let first = steady.spectrum.eigenvalues()[0];
        let expected = [-damping / 2.0 + square.max(0.0).sqrt(), (-square).max(0.0).sqrt()];
        assert!((first.real - expected[0]).abs() < 1e-14 && (first.imaginary - expected[1]).abs() < 1e-14);
    }
}

/// A block of n zeros, rotated so that its zeros are hidden: eigenvalue routines return ε^(1/n), part of it
/// growth.
#[test]
fn jordan_blocks_of_zero_do_not_count_as_growth() {
    let (c, s) = (0.6, 0.8);
    let turn = |i: usize, j: usize| match (i, j) {
        (0, 0) | (3, 3) => c,
        (0, 3) => -s,
        (3, 0) => s,
        _ => f64::from(u8::from(i == j)),
    };
    let block = |i: usize, j: usize| f64::from(u8::from(j == i + 1 && i < 3)) * (1.0 + i as f64);
    let sum = |i: usize, j: usize| -> f64 {
        (0..4).flat_map(|l| (0..4).map(move |m| turn(l, i) * block(l, m) * turn(m, j))).sum()
    };
    let spectrum = Spectrum::of(&Matrix::from_fn(4, 4, sum), 0.0).unwrap();
    assert_eq!(spectrum.zero_blocks(), [1, 1, 1, 1]);
    assert_eq!(spectrum.neutral(), 4);
    assert_eq!(spectrum.verdict(), Verdict::Undecided);
}

#[test]
fn failures_of_the_search_are_named() {
    let graph = Graph::new();
    let falling = System::builder(&graph)
        .coordinates(["x"])
        .lagrangian(|_, x, v| v[0].square() / 2.0 - 3.0 * x[0])
        .build()
        .unwrap();
    let mut falling = falling.poincare().unwrap().compile().unwrap();
    let message = |error: AnalysisError| error.to_string();
    let none = SteadyMotion::near(&mut falling, 0.0, &[0.0, 1.0], &SteadyOptions::default()).unwrap_err();
    assert_eq!(
        message(none),
        "no steady motion was found near the guess: after 0 steps the rates that should vanish have the \
         norm 3 at t = 0, x = 0, x' = 1"
    );
    let mut pendulum = pendulum(0.0);
    let options = SteadyOptions::default().cyclic(["θ"]);
    let not_cyclic = SteadyMotion::near(&mut pendulum, 0.0, &[0.0, 0.0], &options).unwrap_err();
    assert_eq!(message(not_cyclic), "`θ` is not cyclic: the rate of `θ'` depends on it");
    let options = SteadyOptions::default().fixed(["phi"]);
    let unknown = SteadyMotion::near(&mut pendulum, 0.0, &[0.0, 0.0], &options).unwrap_err();
    assert_eq!(message(unknown), "the state has no component `phi`; it has θ, θ'");
    let short = SteadyMotion::near(&mut pendulum, 0.0, &[0.0], &SteadyOptions::default()).unwrap_err();
    assert_eq!(message(short), "the guess has 1 entries where 2 are needed");

    let graph = Graph::new();
    let spun = System::builder(&graph)
        .quasi_velocities(["ω1", "ω2", "ω3"])
        .algebra(&LieAlgebra::so3())
        .lagrangian(|_, _, w| (w[0].square() + 2.0 * w[1].square() + 3.0 * w[2].square()) / 2.0)
        .integral("spin", |_, _, w| w[2])
        .build()
        .unwrap();
    let changing = SecondVariation::at(&spun.poincare().unwrap(), &[0.0, 0.0, 1.0]).unwrap_err();
    assert_eq!(
        message(changing),
        "`spin` is not a first integral free of time, so it does not prove stability"
    );
}

/// A free particle in polar coordinates moves along a ray; integrals leave one deviation, along which all
/// second variations vanish: rounding must not show an extremum, strict or not.
#[test]
fn a_form_that_vanishes_is_not_definite() {
    let graph = Graph::new();
    let plane = System::builder(&graph)
        .coordinates(["x", "y"])
        .lagrangian(|_, _, v| (v[0].square() + v[1].square()) / 2.0)
        .integral("ẋ", |_, _, v| v[0])
        .integral("ẏ", |_, _, v| v[1])
        .integral("moment", |_, x, v| x[0] * v[1] - x[1] * v[0])
        .build()
        .unwrap();
    let equations = plane.poincare().unwrap();
    for state in [[0.1, 0.7, 0.3, 0.6], [1.0 / 3.0, 0.0, 0.9, -0.1], [-1.0, 0.0, 0.964147, 0.0]] {
        assert_eq!(SecondVariation::at(&equations, &state).unwrap().verdict, Verdict::Undecided, "{state:?}");
    }
}

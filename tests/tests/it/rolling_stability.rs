//! Steady motions of nonholonomic systems and their first approximation: thresholds known in closed form, found by the
//! verdict on the eigenvalues.

use std::f64::consts::FRAC_PI_2;

use pc_analysis::{SteadyMotion, SteadyOptions, Verdict};
use pc_mech::{Graph, Motion};
use pc_nonholo::Constrained;
use pc_tests::nonholonomic::{ball_on_turntable, disk};

const GRAVITY: f64 = 10.0;

/// The rolling disk of mass and radius one with moments A about a diameter and C about the axle.
fn rolling(a: f64, c: f64) -> Motion {
    let graph = Graph::new();
    let [u, v] = graph.symbols(["u", "v"]);
    let constrained = Constrained::new(&disk(&graph).unwrap(), &[u, v]).unwrap();
    let mut motion = constrained.equations().compile().unwrap();
    motion.parameters_mut()[1..3].copy_from_slice(&[a, c]);
    motion
}

/// Upright, straight on, spinning with ω_3 = `spin`.
fn straight(motion: &mut Motion, spin: f64) -> SteadyMotion {
    let upright = [0.0, 0.0, 0.3, FRAC_PI_2, 0.0, 0.0, 0.0, spin];
    let options = SteadyOptions::default().cyclic(["X", "Y", "psi", "phi"]);
    SteadyMotion::near(motion, 0.0, &upright, &options).unwrap()
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

/// Straight rolling is stable iff Ω² > A m g r/(C (C + m r²)): g/(3 r) for a uniform disk, g/(4 r) for a hoop [Routh,
/// Advanced Part, 1905, art. 241; Neimark and Fufaev 1972]. Of the four eigenvalues that the coordinates leave, two are
/// the zeros of the family of steady motions, ω_2 and ω_3; the others are ±√(m g r − C (C + m r²) Ω²/A)/√(A + m r²).
#[test]
fn a_disk_rolls_straight_above_its_threshold() {
    for (name, a, c, expected) in
        [("uniform disk", 0.25, 0.5, GRAVITY / 3.0), ("hoop", 0.5, 1.0, GRAVITY / 4.0)]
    {
        let mut motion = rolling(a, c);
        let spin = threshold(0.5 * expected.sqrt(), 2.0 * expected.sqrt(), |spin| {
            straight(&mut motion, spin).verdict() != Verdict::Unstable
        });
        assert!((spin * spin - expected).abs() < 1e-8, "{name}: {} instead of {expected}", spin * spin);

        let fast = straight(&mut motion, 2.0 * expected.sqrt());
        assert_eq!(fast.components, ["theta", "w1", "w2", "w3"]);
        assert_eq!(fast.spectrum.zero_blocks().iter().sum::<usize>(), 2, "{name}");
        let square = (c * (c + 1.0) * 4.0 * expected / a - GRAVITY) / (a + 1.0);
        let found = fast.spectrum.eigenvalues().iter().fold(0.0f64, |size, value| size.max(value.imaginary));
        assert!((found - square.sqrt()).abs() < 1e-10, "{name}: {found}");
    }
}

/// A disk circles with constant tilt where A ω_2² cot θ − (C + m r²) ω_2 ω_3 − m g r cos θ = 0.
#[test]
fn a_disk_circles_steadily() {
    let mut motion = rolling(0.25, 0.5);
    let (theta, turn) = (1.1f64, -1.5);
    let guess = [0.0, 0.0, 0.0, theta, 0.0, 0.1, turn, 3.0];
    let options = SteadyOptions::default().cyclic(["X", "Y", "psi", "phi"]).fixed(["theta", "w2"]);
    let steady = SteadyMotion::near(&mut motion, 0.0, &guess, &options).unwrap();
    let spin = steady.state[7];
    let balance = 0.25 * turn * turn / theta.tan() - 1.5 * turn * spin - GRAVITY * theta.cos();
    assert!(balance.abs() < 1e-11 && steady.state[5].abs() < 1e-13, "{balance:e}");
}

/// The centre of a homogeneous ball on a turntable goes round with 2/7 of its rate, wherever it lies [Milne 1948].
/// Its attitude matters to nothing and is left out.
#[test]
fn a_ball_on_a_turntable_circles_with_two_sevenths() {
    let graph = Graph::new();
    let [u, v] = graph.symbols(["u", "v"]);
    let constrained = Constrained::new(&ball_on_turntable(&graph, false).unwrap(), &[u, v]).unwrap();
    let reduced = constrained.free_system().unwrap().reduced().unwrap();
    assert_eq!(reduced.frame().coordinates(), graph.symbols(["X", "Y"]));
    let mut motion = reduced.poincare().unwrap().compile().unwrap();
    // At rest in space at (1, ½): ω = Ω (X, Y)/R.
    let (rate, radius) = (2.0, 0.5);
    let start = [1.0, 0.5, rate * 1.0 / radius, rate * 0.5 / radius, 0.7];
    let steady = SteadyMotion::near(&mut motion, 0.0, &start, &SteadyOptions::default()).unwrap();
    assert!(steady.state.iter().zip(start).all(|(a, b)| (a - b).abs() < 1e-12), "{:?}", steady.state);
    let found = steady.spectrum.eigenvalues().iter().fold(0.0f64, |size, value| size.max(value.imaginary));
    assert!((found - rate * 2.0 / 7.0).abs() < 1e-8, "{found}");
    assert_eq!(steady.spectrum.zero_blocks().iter().sum::<usize>(), 3, "a place and a spin for each");
}

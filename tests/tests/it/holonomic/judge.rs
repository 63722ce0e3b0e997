//! The judgement of one system: equations against classical ones, the end of a motion, the drift of its integrals.

use pc_mech::Motion;
use pc_tests::classical::{SplitMix64, classical, sample};
use pc_tests::reference::reference;

use super::harness::{STATES, distance, integrate, rates};

/// Some dozens of products of numbers of order one to ten, divided by mass matrices of condition below 1000: at most a
/// few thousand units of rounding.
const ROUNDING: f64 = 1e-12;
/// An integration at rtol = 1e-12 makes errors near 1e-10; the motions magnify those of the start up to 100 times.
const ARRIVAL: f64 = 1e-8;

/// Derived and classical right-hand sides agree at random states.
pub(super) fn assert_equations(
    name: &str,
    motion: &mut Motion,
    classical: impl Fn(f64, &[f64]) -> Vec<f64>,
    sample: impl Fn(&mut SplitMix64) -> (f64, Vec<f64>),
) {
    let mut random = SplitMix64::new(11);
    for _ in 0..STATES {
        let (t, y) = sample(&mut random);
        let (derived, expected) = (rates(motion, t, &y), classical(t, &y));
        let error = distance(&derived, &expected);
        assert!(
            error <= ROUNDING,
            "{name} at t = {t}, {y:?}: {derived:?}, not {expected:?}, a relative error of {error:e}"
        );
    }
}

/// The motion is that of a built-in model: classical equations, end state, and observables named in `conserved`.
pub(super) fn assert_builtin(name: &str, motion: &mut Motion, conserved: &[&str]) {
    let (classical, reference) = (classical(name).expect(name), reference(name).expect(name));
    let rates = |t: f64, y: &[f64]| {
        let mut rates = vec![f64::NAN; y.len()];
        classical(t, y, &mut rates);
        rates
    };
    assert_equations(name, motion, rates, |random| sample(name, random).expect(name));
    assert_motion(name, motion, reference.start, (reference.t_end, reference.state), conserved);
}

/// The motion from `start` arrives at `end`, and the observables named in `conserved` keep their values on the way.
pub(super) fn assert_motion(
    name: &str,
    motion: &mut Motion,
    start: &[f64],
    (t_end, end): (f64, &[f64]),
    conserved: &[&str],
) {
    let times: Vec<f64> = (1..=20).map(|i| t_end * f64::from(i) / 20.0).collect();
    let states = integrate(motion, start, &times);
    let last = states.last().unwrap();
    for (i, (found, expected)) in last.iter().zip(end).enumerate() {
        assert!((found - expected).abs() <= ARRIVAL, "{name}: component {i} is {found}, not {expected}");
    }
    assert_eq!(last.len(), end.len(), "{name}: length of the state");
    let names = motion.observable_names().to_vec();
    let initial = motion.observe(0.0, start);
    for (t, y) in times.iter().zip(&states) {
        let now = motion.observe(*t, y);
        for integral in conserved {
            let i = names.iter().position(|known| known == integral).expect(integral);
            let drift = (now[i] - initial[i]).abs() / (1.0 + initial[i].abs());
            assert!(drift <= ARRIVAL, "{name}: {integral} drifts by {drift:e} at t = {t}");
        }
    }
}

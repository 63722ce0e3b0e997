//! The classical equations against closed forms, and against each other.

use super::*;
use crate::closed_form::{self, derivative};

fn assert_tangent(model: &str, motion: impl Fn(f64) -> Vec<f64>, times: &[f64]) {
    let f = classical(model).expect(model);
    for &t in times {
        let y = motion(t);
        let mut dy = vec![0.0; y.len()];
        f(t, &y, &mut dy);
        for i in 0..y.len() {
            let slope = derivative(|t| motion(t)[i], t);
            assert!(
                (slope - dy[i]).abs() < 1e-10,
                "{model}, component {i}, t = {t}: {slope} instead of {}",
                dy[i]
            );
        }
    }
}

#[test]
fn closed_forms_satisfy_the_classical_equations() {
    let times = [0.1, 0.7, 1.9, 3.3, 4.8];
    assert_tangent("euler-top", |t| closed_form::euler_top(t).to_vec(), &times);
    assert_tangent("euler-top", |t| closed_form::euler_top_separatrix(t).to_vec(), &times);
    assert_tangent("charged-particle", |t| closed_form::charged_particle(2.0, t).to_vec(), &times);
    assert_tangent("damped-oscillator", |t| closed_form::damped_oscillator(t).to_vec(), &times);
    let scaled = |t: f64| {
        let [x, velocity] = closed_form::damped_oscillator(t);
        vec![x, (t / 4.0).exp() * (velocity - x / 4.0)]
    };
    assert_tangent("damped-oscillator-scaled-frame", scaled, &times);
    assert_tangent("turning-wire", |t| closed_form::turning_wire(t).to_vec(), &times);
    assert_tangent("rotating-oscillator", |t| closed_form::rotating_oscillator(t).to_vec(), &times);
    let driven = |t: f64| vec![closed_form::relativistic_fall(2.0, 3.0, t), 3.0 * t / (1.5 * t).hypot(1.0)];
    assert_tangent("relativistic-constant-force", driven, &times);
}

/// Any motion of Euler's top, not the tabulated one alone.
#[test]
fn elliptic_motion_of_a_general_body_satisfies_eulers_equations() {
    let inertia = [0.7, 1.1, 2.3];
    let motion = |t| closed_form::euler_top_elliptic(inertia, 4.1, 5.9, t);
    for t in [0.0, 0.4, 2.2] {
        let mut dy = [0.0; 3];
        euler_top(inertia, &motion(t), &mut dy);
        for i in 0..3 {
            assert!((derivative(|t| motion(t)[i], t) - dy[i]).abs() < 1e-10, "t = {t}");
        }
    }
}

/// dy/dt = dy/dφ φ̇ along the rosette.
#[test]
fn relativistic_orbit_satisfies_the_classical_equations() {
    let f = classical("relativistic-particle").expect("listed");
    for angle in [0.2, 1.3, 3.0, 5.5] {
        let y = closed_form::relativistic_state(angle);
        let mut dy = [0.0; 4];
        f(0.0, &y, &mut dy);
        for i in 0..4 {
            let slope = derivative(|angle| closed_form::relativistic_state(angle)[i], angle) * dy[1];
            assert!((slope - dy[i]).abs() < 1e-10, "component {i} at φ = {angle}");
        }
    }
}

/// θ̈ of the equations is θ̈ of the closed form, for any angle φ of the symmetric body.
#[test]
fn nutation_of_the_symmetric_top_satisfies_the_classical_equations() {
    let f = classical("heavy-top-euler-symmetric").expect("listed");
    let nutation = closed_form::symmetric_top_nutation;
    for (t, phi) in [(0.3, 0.0_f64), (0.9, 0.7), (2.0, 2.9), (3.1, -1.4)] {
        let (theta, rate) = (nutation(t), derivative(nutation, t));
        // I_1 ψ̇ sin²θ + I_3 ω_3 cos θ keeps its value at the start, where ψ̇ = 0
        let precession = 0.5 * 4.0 * (0.5_f64.cos() - theta.cos()) / theta.sin().powi(2);
        let (sin_phi, cos_phi) = phi.sin_cos();
        let omega = [
            precession * theta.sin() * sin_phi + rate * cos_phi,
            precession * theta.sin() * cos_phi - rate * sin_phi,
        ];
        let mut dy = [0.0; 6];
        f(t, &[0.0, theta, phi, omega[0], omega[1], 4.0], &mut dy);
        assert!((dy[0] - precession).abs() < 1e-11 && (dy[1] - rate).abs() < 1e-11);
        let acceleration =
            dy[3] * cos_phi - dy[4] * sin_phi - dy[2] * (omega[0] * sin_phi + omega[1] * cos_phi);
        // a difference of differences: 1e-16 twice divided by the step 1e-2
        assert!((acceleration - derivative(|t| derivative(nutation, t), t)).abs() < 1e-9, "t = {t}");
    }
}

/// The three descriptions of one top give the same γ̇ and ω̇.
#[test]
fn descriptions_of_the_heavy_top_agree() {
    let mut rng = SplitMix64::new(1);
    for _ in 0..20 {
        let (_, y) = sample("heavy-top-euler", &mut rng).expect("listed");
        let vertical = |psi_theta_phi: &[f64]| {
            let (theta, phi) = (psi_theta_phi[1], psi_theta_phi[2]);
            [theta.sin() * phi.sin(), theta.sin() * phi.cos(), theta.cos()]
        };
        let (mut angles, mut poisson) = ([0.0; 6], [0.0; 6]);
        TRIAXIAL.in_euler_angles(&y, &mut angles);
        let mut state = vertical(&y).to_vec();
        state.extend(&y[3..]);
        TRIAXIAL.in_poisson_variables(&state, &mut poisson);
        assert_eq!(angles[3..], poisson[3..]);
        for i in 0..3 {
            let along = |s: f64| vertical(&std::array::from_fn::<f64, 3, _>(|j| y[j] + s * angles[j]))[i];
            assert!((derivative(along, 0.0) - poisson[i]).abs() < 1e-10);
        }

        let (_, y) = sample("heavy-top-quaternion", &mut rng).expect("listed");
        let vertical = |q: &[f64]| {
            let [a, b, c, d] = [q[0], q[1], q[2], q[3]];
            [2.0 * (b * d - a * c), 2.0 * (c * d + a * b), a * a - b * b - c * c + d * d]
        };
        let mut quaternion = [0.0; 7];
        TRIAXIAL.in_quaternion(&y, &mut quaternion);
        let mut state = vertical(&y).to_vec();
        state.extend(&y[4..]);
        TRIAXIAL.in_poisson_variables(&state, &mut poisson);
        assert_eq!(quaternion[4..], poisson[3..]);
        for i in 0..3 {
            let along = |s: f64| vertical(&std::array::from_fn::<f64, 4, _>(|j| y[j] + s * quaternion[j]))[i];
            let error = (derivative(along, 0.0) - poisson[i]).abs();
            assert!(error < 1e-10 * (1.0 + poisson[i].abs()), "{error:e}");
        }
    }
}

#[test]
fn samples_are_repeatable_and_regular() {
    for &model in MODELS {
        let f = classical(model).expect(model);
        let (mut rng, mut again) = (SplitMix64::new(7), SplitMix64::new(7));
        for _ in 0..100 {
            let (t, y) = sample(model, &mut rng).expect(model);
            assert_eq!(sample(model, &mut again), Some((t, y.clone())));
            let mut dy = vec![f64::NAN; y.len()];
            f(t, &y, &mut dy);
            assert!(dy.iter().all(|rate| rate.is_finite()), "{model} at t = {t}, {y:?}");
        }
    }
    assert!(classical("no such model").is_none());
    assert!(sample("no such model", &mut SplitMix64::new(0)).is_none());
}

/// The first numbers from the seed 1234567, as published with the generator.
#[test]
fn generator_is_splitmix64() {
    let mut rng = SplitMix64::new(1_234_567);
    assert_eq!(rng.next_bits(), 6_457_827_717_110_365_317);
    assert_eq!(rng.next_bits(), 3_203_168_211_198_807_973);
}

//! Known Lyapunov exponents.

use std::cell::Cell;

use crate::boxed::from_fn;
use pc_solve::{
    Failure, LyapunovOptions, Method, Options, Reason, SolveError, VectorField, lyapunov_exponents,
};

fn tolerance(tolerance: f64) -> Options {
    Options::default().relative_tolerance(tolerance).absolute_tolerance(tolerance)
}

/// The exponents of ẏ = Ay are the real parts of the eigenvalues; this A is block triangular, with
/// 0.5, −0.2 ± 3i, −1.
#[test]
fn linear_system() {
    let rhs = |_t: f64, y: &[f64], rate: &mut [f64]| {
        rate.copy_from_slice(&[
            0.5 * y[0] + y[1] - 2.0 * y[3],
            -0.2 * y[1] - 3.0 * y[2] + y[3],
            3.0 * y[1] - 0.2 * y[2],
            -y[3],
        ]);
        Ok(())
    };
    for method in [Method::Adams, Method::Bdf] {
        let options = Options::new(method).relative_tolerance(1e-10).absolute_tolerance(1e-12);
        // The rotation takes 2π/3, a multiple of the interval: then its pair of exponents is equal
        // after each turn.
        let turn = 2.0 * std::f64::consts::PI / 3.0;
        let lyapunov = LyapunovOptions::new(4, turn / 4.0, 40).transient(60);
        let found = lyapunov_exponents(from_fn(4, rhs), 0.0, &[0.0; 4], &options, &lyapunov).unwrap();
        // Directions have converged as e^(−0.7 · 31); the remaining errors are the tolerances, with
        // a few hundred steps an interval.
        for (found, expected) in found.exponents.iter().zip([0.5, -0.2, -0.2, -1.0]) {
            assert!((found - expected).abs() < 1e-7, "{method:?}: {found} is not {expected}");
        }
        assert_eq!((found.history.len(), found.state), (160, vec![0.0; 4]));
        assert_eq!(found.history[156..], found.exponents);
        assert!((found.time - 25.0 * turn).abs() < 1e-12);
    }
}

fn lorenz() -> impl VectorField {
    from_fn(3, |_t, y, rate| {
        rate.copy_from_slice(&[
            10.0 * (y[1] - y[0]),
            y[0] * (28.0 - y[2]) - y[1],
            y[0] * y[1] - 8.0 / 3.0 * y[2],
        ]);
        Ok(())
    })
    .with_jacobian(|_t, y, jacobian| {
        jacobian.copy_from_slice(&[-10.0, 28.0 - y[2], y[1], 10.0, -1.0, y[0], 0.0, -y[0], -8.0 / 3.0]);
        Ok(())
    })
}

/// λ = 0.9056, 0, −14.5723 [Viswanath, Lyapunov exponents from random Fibonacci sequences to the
/// Lorenz equations, Cornell 1998; Sprott, Chaos and Time-Series Analysis, Oxford 2003, p. 431].
#[test]
fn lorenz_system() {
    let lyapunov = LyapunovOptions::new(3, 0.25, 4000).transient(80);
    let found = lyapunov_exponents(lorenz(), 0.0, &[1.0, 1.0, 20.0], &tolerance(1e-7), &lyapunov).unwrap();
    // The rate fluctuates by about 0.6 with a correlation time of about 0.1: its mean over a time
    // of 1000 has an error of 0.006.
    for (found, expected) in found.exponents.iter().zip([0.9056, 0.0, -14.5723]) {
        assert!((found - expected).abs() < 0.02, "{found} is not {expected}");
    }
    // The divergence is −41/3 everywhere: the sum is as accurate as the integration, 1e-7 in
    // vectors as short as e^(−3.6).
    let sum: f64 = found.exponents.iter().sum();
    assert!((sum + 41.0 / 3.0).abs() < 1e-3, "{sum}");
}

/// The sum is the mean divergence, here that of a pendulum with drag that depends on its position,
/// ∇·f = −1 − cos φ, whose integral is a third component.
#[test]
fn sum_is_the_mean_divergence() {
    let pendulum = from_fn(3, |t: f64, y: &[f64], rate: &mut [f64]| {
        let drag = 1.0 + y[0].cos();
        rate.copy_from_slice(&[y[1], -2.0 * y[0].sin() - drag * y[1] + 1.5 * t.sin(), -drag]);
        Ok(())
    });
    let lyapunov = LyapunovOptions::new(3, 0.5, 40);
    let found = lyapunov_exponents(pendulum, 0.0, &[0.5, 0.0, 0.0], &tolerance(1e-10), &lyapunov).unwrap();
    let sum: f64 = found.exponents.iter().sum();
    assert!((sum - found.state[2] / 20.0).abs() < 1e-7, "{sum} {}", found.state[2] / 20.0);
}

/// The exponents of a Hamiltonian flow are pairs ±λ: for the system of Hénon and Heiles [Astron. J.
/// 69 (1964) 73] at H = 1/6, where most of its motions are chaotic.
#[test]
fn hamiltonian_pairs() {
    let field = from_fn(4, |_t, y, rate| {
        let [x, y, u, v] = [y[0], y[1], y[2], y[3]];
        rate.copy_from_slice(&[u, v, -x - 2.0 * x * y, -y - x * x + y * y]);
        Ok(())
    });
    // x = 0 and y = −0.15: ẋ from H = (ẋ² + ẏ² + x² + y²)/2 + x²y − y³/3 = 1/6 with ẏ = 0.
    let y0: f64 = -0.15;
    let u = (1.0 / 3.0 - y0 * y0 + 2.0 / 3.0 * y0.powi(3)).sqrt();
    let lyapunov = LyapunovOptions::new(4, 1.0, 1000).transient(50);
    let found = lyapunov_exponents(field, 0.0, &[0.0, y0, u, 0.0], &tolerance(1e-9), &lyapunov).unwrap();
    let e = &found.exponents;
    assert!(e[0] > 0.05, "{e:?} is not chaotic");
    // The means of a pair differ by the angles of its vectors at the ends, a few units of ln over a
    // time of 1000.
    assert!((e[0] + e[3]).abs() < 0.01 && (e[1] + e[2]).abs() < 0.01, "{e:?}");
    // The volume is conserved, up to the tolerance.
    assert!(e.iter().sum::<f64>().abs() < 1e-6, "{e:?}");
    assert!(e[1].abs() < 0.01, "{e:?}"); // along the motion, converging as ln t/t
}

#[test]
fn input_is_checked() {
    let options = Options::default();
    let refusal = |lyapunov: LyapunovOptions| {
        lyapunov_exponents(lorenz(), 0.0, &[1.0; 3], &options, &lyapunov).unwrap_err().to_string()
    };
    let expected = "the number of Lyapunov exponents is 4, but must be from 1 to 3, the number of components";
    assert_eq!(refusal(LyapunovOptions::new(4, 1.0, 1)), expected);
    assert_eq!(
        refusal(LyapunovOptions::new(0, 1.0, 1)),
        "the number of Lyapunov exponents is 0, but must be from 1 to 3, the number of components"
    );
    assert_eq!(refusal(LyapunovOptions::new(1, -1.0, 1)), "the interval is -1, but must be positive");
    assert_eq!(
        refusal(LyapunovOptions::new(1, 1.0, 0)),
        "the number of intervals is 0, but must be positive"
    );
    let late = lyapunov_exponents(lorenz(), 1e9, &[1.0; 3], &options, &LyapunovOptions::new(1, 1e-9, 1))
        .unwrap_err();
    assert_eq!(late.to_string(), "the end time equals the start time, t = 1000000000");
}

/// Vectors that become parallel to rounding within one interval are refused.
#[test]
fn long_intervals_are_refused() {
    let saddle = from_fn(2, |_t, y, rate| {
        rate.copy_from_slice(&[y[0], -y[1]]);
        Ok(())
    });
    let lyapunov = LyapunovOptions::new(2, 40.0, 1);
    let error = lyapunov_exponents(saddle, 0.0, &[0.0; 2], &Options::default(), &lyapunov).unwrap_err();
    let SolveError::Integration(error) = error else { panic!("it began") };
    assert_eq!((&error.reason, error.time), (&Reason::Collapsed { vector: 1 }, 40.0));
    assert_eq!(
        error.to_string(),
        "tangent vector number 1 (from 0) is a combination of those before it, up to rounding, at t = 40: choose shorter intervals"
    );
}

#[test]
fn failures_carry_the_state_reached() {
    #[derive(Debug, thiserror::Error)]
    #[error("no further")]
    struct NoFurther;
    let calls = Cell::new(0);
    let clock = from_fn(1, |t, _y, rate| {
        calls.set(calls.get() + 1);
        rate[0] = 1.0;
        if t > 3.5 { Err(Failure::fatal(NoFurther)) } else { Ok(()) }
    });
    let options = Options::default().max_step(0.1);
    let error =
        lyapunov_exponents(clock, 0.0, &[0.0], &options, &LyapunovOptions::new(1, 1.0, 9)).unwrap_err();
    let (t, y) = error.reached().unwrap();
    assert!(t > 3.3 && t <= 3.5 && (y[0] - t).abs() < 1e-9);
    assert!(calls.get() > 0);
}

//! Forward sensitivities against closed forms, and their effect on the motion.

use std::ops::ControlFlow;

use crate::boxed::{erased, from_fn};
use crate::offers::{Circle, Formulas, OFFERS, Offer, Offering, Oscillator, Pendulum, derivative, precise};
use pc_solve::{
    Correction, Integration, Method, NonlinearSolver, Options, Sensitivities, SensitivityStatistics, Solve,
    solve,
};

const OSCILLATOR: Oscillator = Oscillator { damping: 0.15, frequency: 1.3 };
const TIMES: [f64; 4] = [0.5, 1.0, 4.0, 10.0];

#[track_caller]
fn assert_near(found: f64, expected: f64, tolerance: f64, what: impl std::fmt::Debug) {
    assert!((found - expected).abs() < tolerance, "{what:?}: {found} is not {expected}");
}

/// ∂(x, ẋ)/∂(ω, c, x₀, ẋ₀) of the damped oscillator, in this order, by both methods, with all
/// corrections and all offers.
#[test]
fn damped_oscillator() {
    let (a, b) = (0.7, -0.4);
    let motion = |c, w, t, a, b, i| Oscillator { damping: c, frequency: w }.motion(t, a, b)[i];
    let Oscillator { damping: c, frequency: w } = OSCILLATOR;
    for options in precise() {
        for offer in OFFERS {
            for correction in [Correction::Staggered, Correction::Simultaneous] {
                let wanted =
                    Sensitivities::new().by_parameters([1, 0]).by_starts(0..2).correction(correction);
                let field = Offering(OSCILLATOR, offer);
                let found = Solve::new(erased(field), 0.0, &[a, b])
                    .method(&options)
                    .sensitivities(&wanted)
                    .run(&TIMES)
                    .unwrap();
                assert_eq!((found.trajectory.columns(), found.trajectory.motion().times()), (4, &TIMES[..]));
                for (t, y, s) in found.trajectory.iter() {
                    for i in 0..2 {
                        let expected = [
                            derivative(|w| motion(c, w, t, a, b, i), w),
                            derivative(|c| motion(c, w, t, a, b, i), c),
                            derivative(|a| motion(c, w, t, a, b, i), a),
                            derivative(|b| motion(c, w, t, a, b, i), b),
                        ];
                        assert_near(y[i], motion(c, w, t, a, b, i), 1e-8, "state");
                        for (j, expected) in expected.into_iter().enumerate() {
                            assert_near(s[i + 2 * j], expected, 1e-8, (&options, offer, correction, t, i, j));
                        }
                    }
                }
            }
        }
    }
}

/// ∂x/∂ω = −a t sin ωt in closed form, without a difference quotient.
#[test]
fn harmonic_oscillator_by_its_frequency() {
    let (a, w) = (0.9, 2.0);
    for options in precise() {
        for offer in OFFERS {
            let field = Offering(Oscillator { damping: 0.0, frequency: w }, offer);
            let wanted = Sensitivities::new().by_parameter(1);
            let found = Solve::new(erased(field), 0.0, &[a, 0.0])
                .method(&options)
                .sensitivities(&wanted)
                .run(&TIMES)
                .unwrap();
            for (t, _, s) in found.trajectory.iter() {
                let (sin, cos) = (w * t).sin_cos();
                // The derivative grows as t, and the error with it.
                assert_near(s[0] / (1.0 + t), -a * t * sin / (1.0 + t), 1e-8, (offer, t));
                assert_near(s[1] / (1.0 + t), -a * (sin + w * t * cos) / (1.0 + t), 1e-8, (offer, t));
            }
        }
    }
}

/// ẏ = p y (1 − y) from y₀ = p/4: the start depends on the parameter.
#[test]
fn a_start_that_depends_on_a_parameter() {
    struct Logistic(f64);
    impl Formulas for Logistic {
        const DIM: usize = 1;
        const PARAMETERS: usize = 1;
        fn rhs(&self, _t: f64, y: &[f64], rate: &mut [f64]) {
            rate[0] = self.0 * y[0] * (1.0 - y[0]);
        }
        fn jacobian(&self, _t: f64, y: &[f64], jacobian: &mut [f64]) {
            jacobian[0] = self.0 * (1.0 - 2.0 * y[0]);
        }
        fn by_parameters(&self, _t: f64, y: &[f64], jacobian: &mut [f64]) {
            jacobian[0] = y[0] * (1.0 - y[0]);
        }
    }
    let p = 1.2;
    let exact = |t: f64, p: f64, start: f64| 1.0 / (1.0 + (1.0 / start - 1.0) * (-p * t).exp());
    for options in precise() {
        for offer in OFFERS {
            let wanted = Sensitivities::new().by_parameter_from(0, [0.25]).by_parameter(0).along([2.0]);
            let field = Offering(Logistic(p), offer);
            let found = Solve::new(erased(field), 0.0, &[p / 4.0])
                .method(&options)
                .sensitivities(&wanted)
                .run(&[1.0, 3.0])
                .unwrap();
            for (i, t) in [1.0, 3.0].into_iter().enumerate() {
                let expected = [
                    derivative(|p| exact(t, p, p / 4.0), p),
                    derivative(|q| exact(t, q, p / 4.0), p),
                    2.0 * derivative(|start| exact(t, p, start), p / 4.0),
                ];
                for (j, expected) in expected.into_iter().enumerate() {
                    assert_near(found.trajectory.column(i, j)[0], expected, 1e-8, (offer, t, j));
                }
            }
        }
    }
}

/// S = e^(At) for a full matrix A with rotation, growth and decay, forwards and backwards: S(−t)
/// S(t) = 1.
#[test]
fn linear_systems() {
    const N: usize = 4;
    let entries: Vec<f64> = (0..N * N).map(|k| ((7 * k + 3) % 11) as f64 / 8.0 - 0.6).collect();
    let field = || {
        from_fn(N, |_t, y, rate| {
            for (i, rate) in rate.iter_mut().enumerate() {
                *rate = (0..N).map(|j| entries[i + j * N] * y[j]).sum();
            }
            Ok(())
        })
    };
    // The exponential series, by scaling and squaring.
    let product = |a: &[f64], b: &[f64]| -> Vec<f64> {
        (0..N * N).map(|k| (0..N).map(|l| a[k % N + l * N] * b[l + (k / N) * N]).sum()).collect()
    };
    let exponential = |t: f64| {
        let small: Vec<f64> = entries.iter().map(|a| a * t / 1024.0).collect();
        let unit: Vec<f64> = (0..N * N).map(|k| f64::from(u8::from(k % N == k / N))).collect();
        let (mut sum, mut term) = (unit.clone(), unit);
        for k in 1..10 {
            term = product(&term, &small).iter().map(|x| x / f64::from(k)).collect();
            sum = sum.iter().zip(&term).map(|(a, b)| a + b).collect();
        }
        (0..10).fold(sum, |power, _| product(&power, &power))
    };
    for options in precise() {
        for t in [2.0, -2.0] {
            let wanted = Sensitivities::new().by_starts(0..N);
            let start = [1.0, -1.0, 0.5, 2.0];
            let found = Solve::new(erased(field()), 0.0, &start)
                .method(&options)
                .sensitivities(&wanted)
                .run(&[t])
                .unwrap();
            let expected = exponential(t);
            let size = expected.iter().fold(1.0, |size: f64, x| size.max(x.abs()));
            for (found, expected) in found.trajectory.matrix(0).iter().zip(&expected) {
                assert_near(*found, *expected, 1e-8 * size, t);
            }
        }
    }
}

/// Without error control, and as long as the iteration for the columns converges, a staggered
/// correction does not change the motion, to the last bit.
#[test]
fn the_motion_is_unchanged_without_error_control() {
    let pendulum = Pendulum([1.0, 0.0, 0.3]);
    let times = [1.0, 2.5, 20.0];
    for method in [Method::Adams, Method::Bdf] {
        for offer in OFFERS {
            let options = Options::new(method);
            let alone = solve(erased(Offering(pendulum, offer)), 0.0, &[1.0, 0.5], &times, &options).unwrap();
            let with = |wanted: &Sensitivities| {
                let field = Offering(pendulum, offer);
                let mut cvode =
                    Integration::with_sensitivities(erased(field), 0.0, &[1.0, 0.5], &options, wanted)
                        .unwrap();
                cvode.set_stop_time(Some(20.0)).unwrap();
                let (mut states, mut matrix) = (Vec::new(), Vec::new());
                let output = |_, y: &[f64], s: &[f64]| {
                    states.extend_from_slice(y);
                    matrix = s.to_vec();
                    ControlFlow::Continue(())
                };
                cvode.run_with_sensitivities(&times, output, |_| ControlFlow::Continue(())).unwrap();
                (states, matrix, cvode.statistics().steps, cvode.sensitivity_statistics())
            };
            // Tolerances that the iteration for the columns reaches as fast as that for the state.
            let wanted = Sensitivities::new().by_parameters([0, 2]).by_starts(0..2).tolerances(1e-5, 1e-5);
            let (states, matrix, steps, work) = with(&wanted.clone().error_control(false));
            assert_eq!((work.error_test_failures, work.nonlinear_failures), (0, 0));
            assert_eq!(states, alone.states(), "{method:?} {offer:?}");
            assert_eq!(steps, alone.statistics().steps);
            // With error control there are more steps, and the derivatives are more accurate.
            let (_, exact, more_steps, _) = with(&wanted.tolerances(1e-12, 1e-12));
            assert!(more_steps > steps);
            let error = matrix.iter().zip(&exact).fold(0.0, |e: f64, (a, b)| e.max((a - b).abs()));
            assert!(error > 1e-8 && error < 1e-3, "{method:?} {offer:?}: {error}");
        }
    }
}

/// The tolerance of the columns determines their error: for the linear growth ẏ = y, s = e^t.
#[test]
fn tolerances_of_the_columns() {
    struct Growing;
    impl Formulas for Growing {
        const DIM: usize = 1;
        const PARAMETERS: usize = 0;
        fn rhs(&self, _t: f64, y: &[f64], rate: &mut [f64]) {
            rate[0] = y[0];
        }
        fn jacobian(&self, _t: f64, _y: &[f64], jacobian: &mut [f64]) {
            jacobian[0] = 1.0;
        }
        fn by_parameters(&self, _t: f64, _y: &[f64], _jacobian: &mut [f64]) {}
    }
    // The motion from 0 is at rest; only the column needs short steps.
    let error = |tolerance: f64| {
        let wanted = Sensitivities::new().by_start(0).tolerances(tolerance, tolerance);
        let field = Offering(Growing, Offer::Jacobian);
        let found = Solve::new(erased(field), 0.0, &[0.0])
            .method(&Options::default())
            .sensitivities(&wanted)
            .run(&[3.0])
            .unwrap();
        assert_eq!(found.trajectory.motion().state(0), [0.0]);
        (found.trajectory.matrix(0)[0] / 3.0_f64.exp() - 1.0).abs()
    };
    assert!(error(1e-11) < 1e-9); // the local errors of about 100 steps
    assert!(error(1e-3) > 1e-6);
}

/// Step by step, at outputs within steps too, and before the first step.
#[test]
fn stepping() {
    let options = &precise()[0];
    let wanted = Sensitivities::new().by_start(1).by_parameter_from(0, [3.0, 4.0]);
    let field = Offering(OSCILLATOR, Offer::Products);
    let mut cvode =
        Integration::with_sensitivities(erased(field), 0.0, &[1.0, 0.0], options, &wanted).unwrap();
    assert_eq!(cvode.sensitivities().unwrap(), [0.0, 1.0, 3.0, 4.0]);
    assert_eq!(cvode.sensitivity_statistics(), SensitivityStatistics::default());
    let check = |t: f64, s: &[f64]| {
        for i in 0..2 {
            let expected = derivative(|b| OSCILLATOR.motion(t, 1.0, b)[i], 0.0);
            assert_near(s[i], expected, 1e-8, t);
        }
    };
    while cvode.time() < 2.0 {
        let t = cvode.step_towards(10.0).unwrap();
        check(t, &cvode.sensitivities().unwrap());
    }
    let ahead = cvode.statistics().current_time;
    let inside = ahead + 1e-3;
    cvode.state_at(inside).unwrap();
    assert!(cvode.statistics().current_time > inside);
    check(inside, &cvode.sensitivities().unwrap());
    let mut seen = Vec::new();
    let stop_at_five = |t, _: &[f64], s: &[f64]| {
        check(t, s);
        seen.push(t);
        if t < 5.0 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
    };
    let ending =
        cvode.run_with_sensitivities(&[3.0, 5.0, 6.0], stop_at_five, |_| ControlFlow::Continue(())).unwrap();
    assert_eq!((ending, seen), (pc_solve::Ending::Stopped, vec![3.0, 5.0]));
    let work = cvode.sensitivity_statistics();
    assert!(work.evaluations > cvode.statistics().steps && work.nonlinear_iterations > 0);

    // Without columns it is an ordinary integration.
    let field = Offering(OSCILLATOR, Offer::Products);
    let none = Sensitivities::new();
    assert!(none.is_empty());
    let mut plain = Integration::with_sensitivities(erased(field), 0.0, &[1.0, 0.0], options, &none).unwrap();
    plain.state_at(1.0).unwrap();
    assert_eq!(plain.sensitivities().unwrap(), [0.0; 0]);
}

/// Difference quotients depend on no scale but that of the state: they are as accurate with y, t in
/// units a million times smaller or larger.
#[test]
fn difference_quotients_in_other_units() {
    let options = &precise()[1];
    for scale in [1e-6, 1e6] {
        let field = from_fn(1, |_t, y: &[f64], rate: &mut [f64]| {
            rate[0] = -y[0] * y[0] / scale;
            Ok(())
        });
        let options = options.clone().absolute_tolerance(1e-13 * scale);
        let wanted = Sensitivities::new().by_start(0).tolerances(1e-11, 1e-13);
        let found = Solve::new(erased(field), 0.0, &[scale])
            .method(&options)
            .sensitivities(&wanted)
            .run(&[1.0])
            .unwrap();
        assert_near(found.trajectory.matrix(0)[0], 0.25, 1e-8, scale);
    }
}

/// A stiff system: Newton's iteration uses the same matrix for the columns, with steps as long.
#[test]
fn stiff() {
    let field = || {
        from_fn(1, |t: f64, y: &[f64], rate: &mut [f64]| {
            rate[0] = -1e5 * (y[0] - t.cos());
            Ok(())
        })
    };
    let options =
        Options::new(Method::Bdf).nonlinear_solver(NonlinearSolver::Newton).relative_tolerance(1e-6);
    for correction in [Correction::Staggered, Correction::Simultaneous] {
        let wanted = Sensitivities::new().by_start(0).correction(correction);
        let found = Solve::new(erased(field()), 0.0, &[0.0])
            .method(&options)
            .sensitivities(&wanted)
            .run(&[10.0])
            .unwrap();
        assert!(found.trajectory.matrix(0)[0].abs() < 1e-12); // e^(−1e6), and the absolute tolerance
        assert!(
            found.trajectory.motion().statistics().steps < 2000,
            "{:?}",
            found.trajectory.motion().statistics()
        );
    }
}

/// Along projected states, columns that begin tangent to the circle stay tangent, and agree with
/// those of the angle.
#[test]
fn fields_with_a_projection() {
    // φ from the horizontal, φ̈ = −cos φ; from φ = 0 with φ̇ = 2.
    let by_angle = || {
        from_fn(2, |_t, y, rate| {
            rate.copy_from_slice(&[y[1], -y[0].cos()]);
            Ok(())
        })
        .with_jacobian(|_t, y, jacobian| {
            jacobian.copy_from_slice(&[0.0, y[0].sin(), 1.0, 0.0]);
            Ok(())
        })
    };
    let times: Vec<f64> = (1..=60).map(f64::from).collect();
    for method in [Method::Adams, Method::Bdf] {
        let options =
            |tolerance| Options::new(method).relative_tolerance(tolerance).absolute_tolerance(tolerance);
        let wanted = Sensitivities::new().by_start(1); // by φ̇₀
        let exact = Solve::new(erased(by_angle()), 0.0, &[0.0, 2.0])
            .method(&options(1e-12))
            .sensitivities(&wanted)
            .run(&times)
            .unwrap();
        let mut circle = Circle { farthest: 0.0 };
        let wanted = Sensitivities::new().along([0.0, 0.0, 0.0, 1.0]); // (x, z, ẋ, ż) by φ̇₀
        let start = [1.0, 0.0, 0.0, 2.0];
        let found = Solve::new(erased(&mut circle), 0.0, &start)
            .method(&options(1e-9))
            .sensitivities(&wanted)
            .run(&times)
            .unwrap();
        for ((t, y, s), (_, angle, by)) in found.trajectory.iter().zip(exact.trajectory.iter()) {
            assert_near(y[0].hypot(y[1]), 1.0, 1e-15, t);
            // Derivatives grow as t², to 3600, and with them the error from the tolerance 1e-9.
            assert_near(y[0] * s[0] + y[1] * s[1], 0.0, 1e-4, (method, t));
            let (sin, cos) = angle[0].sin_cos();
            let size = 1.0 + by[0].abs();
            assert_near(s[0] / size, -sin * by[0] / size, 1e-4, (method, t));
            assert_near(s[1] / size, cos * by[0] / size, 1e-4, (method, t));
        }
        // Linearised at projected states; without projection they would be a hundred times farther
        // off the circle.
        assert!(circle.farthest < 1e-7, "{method:?}: {}", circle.farthest);
    }
}

//! Failures of the vector field and of CVODES, and the state after them.

use std::cell::Cell;
use std::error::Error;

use crate::boxed::{erased, from_fn};
use pc_solve::{
    Code, Failure, Integration, Method, NonFinite, NonlinearSolver, Options, Reason, SolveError,
    SolveFailure, Trajectory, solve,
};

#[derive(Debug, PartialEq, thiserror::Error)]
#[error("sqrt({0}) is not real")]
struct NegativeRoot(f64);

fn root(x: f64) -> Result<f64, Failure> {
    if x < 0.0 { Err(Failure::recoverable(NegativeRoot(x))) } else { Ok(x.sqrt()) }
}

/// An error and its sources.
fn chain(error: &dyn Error) -> String {
    match error.source() {
        Some(source) => format!("{error} <- {}", chain(source)),
        None => error.to_string(),
    }
}

fn failure(result: Result<Trajectory, Box<SolveFailure>>) -> SolveFailure {
    *result.expect_err("the integration must fail")
}

fn methods() -> [Options; 3] {
    [
        Options::new(Method::Adams),
        Options::new(Method::Bdf),
        Options::new(Method::Adams).nonlinear_solver(NonlinearSolver::Newton),
    ]
}

/// ẏ = −2√y from y(0) = 1 is (1 − t)² until it reaches the wall y = 0 at t = 1; trial states beyond
/// the wall lead to shorter steps.
#[test]
fn recoverable_failures_are_answered_by_shorter_steps() {
    for options in methods() {
        let failures = Cell::new(0);
        let fall = from_fn(1, |_t, y, ydot| {
            ydot[0] = -2.0 * root(y[0]).inspect_err(|_| failures.set(failures.get() + 1))?;
            Ok(())
        });
        let options = options.relative_tolerance(1e-4).absolute_tolerance(1e-6).initial_step(0.999);
        let mut cvode = Integration::new(erased(fall), 0.0, &[1.0], &options).unwrap();
        let y = cvode.state_at(0.9).unwrap()[0];
        assert!((y - 0.01).abs() < 1e-3, "{y}");
        assert!(failures.get() > 0, "{options:?}");
    }
}

#[test]
fn a_singularity_stalls_the_integration_and_is_named() {
    for options in methods() {
        let clock = from_fn(1, |t, _y, ydot| {
            ydot[0] = 3.0 * root(1.0 - t)?;
            Ok(())
        });
        let failure = failure(solve(erased(clock), 0.0, &[0.0], &[0.5, 0.75, 2.0], &options));
        assert_eq!(failure.reached.times(), [0.5, 0.75]);
        assert!(!failure.reached.is_complete());
        for (t, y) in failure.reached.iter() {
            assert!((y[0] - 2.0 * (1.0 - (1.0 - t).powf(1.5))).abs() < 1e-7);
        }
        assert!(failure.reached.statistics().steps > 0);
        let (t, y) = failure.error.reached().unwrap();
        assert!(t <= 1.0 && t > 0.99, "{t}");
        assert!((y[0] - 2.0).abs() < 1e-3);
        // The steps become ever shorter, until t + h = t.
        let message = chain(&failure);
        let expected = format!("the steps have become too short to continue from t = {t} <- sqrt(-");
        assert!(message.starts_with(&expected), "{message}");
        assert!(failure.reached.statistics().steps < 3000);
        let cause = failure.source().unwrap().downcast_ref::<NegativeRoot>().unwrap();
        assert!(cause.0 < 0.0);
    }
}

#[test]
fn codes_of_a_failing_right_hand_side() {
    for recoverable in [true, false] {
        let field = |from: f64| {
            from_fn(1, move |t, _y, ydot| {
                ydot[0] = 1.0;
                match (t >= from, recoverable) {
                    (false, _) => Ok(()),
                    (true, true) => Err(Failure::recoverable(NegativeRoot(-1.0))),
                    (true, false) => Err(Failure::fatal(NegativeRoot(-2.0))),
                }
            })
        };
        let options = Options::new(Method::Adams).initial_step(0.5).max_step(0.5);
        let at_start = failure(solve(erased(field(0.0)), 0.0, &[0.0], &[1.0], &options));
        let later = failure(solve(erased(field(0.75)), 0.0, &[0.0], &[0.5, 1.0], &options.min_step(0.5)));
        assert_eq!(at_start.reached.len(), 0);
        assert_eq!(later.reached.times(), [0.5]);
        assert_eq!(later.error.reached(), Some((0.5, &[0.5][..])));
        if recoverable {
            assert_eq!(
                chain(&at_start),
                "CV_FIRST_RHSFUNC_ERR (-9) after reaching t = 0: The right-hand side routine failed at the first \
                 call. <- sqrt(-1) is not real"
            );
            assert_eq!(
                chain(&later),
                "CV_REPTD_RHSFUNC_ERR (-10) after reaching t = 0.5: At t = 0.5 repeated recoverable right-hand side \
                 function errors. <- sqrt(-1) is not real"
            );
        } else {
            assert_eq!(
                chain(&at_start),
                "CV_RHSFUNC_FAIL (-8) after reaching t = 0: At t = 0, the right-hand side routine failed in an \
                 unrecoverable manner. <- sqrt(-2) is not real"
            );
            assert_eq!(
                chain(&later),
                "CV_RHSFUNC_FAIL (-8) after reaching t = 0.5: At t = 0.5, the right-hand side routine failed in an \
                 unrecoverable manner. <- sqrt(-2) is not real"
            );
        }
        let SolveError::Integration(error) = later.error else { panic!("{later:?}") };
        assert_eq!(error.failure.unwrap().is_recoverable(), recoverable);
    }
}

/// After repeated failures of the error test CVODES restarts with f at the last state, which must
/// not fail.
#[test]
fn failure_where_no_smaller_step_helps() {
    let started = Cell::new(false);
    let jump = from_fn(1, |t, _y, ydot| {
        if t == 0.0 && started.replace(true) {
            return Err(Failure::recoverable(NegativeRoot(-3.0)));
        }
        ydot[0] = if t == 0.0 { 0.0 } else { 1e9 };
        Ok(())
    });
    let failure =
        failure(solve(erased(jump), 0.0, &[1.0], &[1.0], &Options::new(Method::Adams).initial_step(0.1)));
    assert_eq!(
        chain(&failure),
        "CV_UNREC_RHSFUNC_ERR (-11) after reaching t = 0: At t = 0, the right-hand side failed in a recoverable \
         manner, but no recovery is possible. <- sqrt(-3) is not real"
    );
}

#[test]
fn codes_of_a_failing_jacobian() {
    for recoverable in [true, false] {
        let field = from_fn(1, |_t, y, ydot| {
            ydot[0] = -1e3 * y[0];
            Ok(())
        })
        .with_jacobian(move |t, _y, _j| {
            let cause = NegativeRoot(t);
            Err(if recoverable { Failure::recoverable(cause) } else { Failure::fatal(cause) })
        });
        let failure =
            failure(solve(erased(field), 0.0, &[1.0], &[1.0], &Options::new(Method::Bdf).initial_step(1e-3)));
        let message = chain(&failure);
        let (head, cause) = message.split_once(" <- ").unwrap();
        assert!(cause.starts_with("sqrt(") && cause.ends_with(") is not real"), "{cause}");
        if recoverable {
            assert_eq!(
                head,
                "CV_CONV_FAILURE (-4) after reaching t = 0: At t = 0 and h = 3.8147e-09, the corrector convergence \
                 test failed repeatedly or with |h| = hmin."
            );
        } else {
            assert_eq!(
                head,
                "CV_LSETUP_FAIL (-6) after reaching t = 0: The Jacobian routine failed in an unrecoverable manner. \
                 At t = 0, the setup routine failed in an unrecoverable manner."
            );
        }
    }
}

#[test]
fn a_rate_that_is_not_finite_is_named() {
    for (value, written) in [(f64::NAN, "NaN"), (f64::INFINITY, "inf"), (f64::NEG_INFINITY, "-inf")] {
        let field = from_fn(2, move |_t, _y, ydot| {
            ydot[0] = 1.0;
            ydot[1] = value;
            Ok(())
        });
        let failure = failure(solve(
            erased(field.with_names(["x", "v"])),
            0.5,
            &[0.0, 0.0],
            &[1.0],
            &Options::new(Method::Adams),
        ));
        assert_eq!(
            chain(&failure),
            format!(
                "CV_FIRST_RHSFUNC_ERR (-9) after reaching t = 0.5: The right-hand side routine failed at the first \
                 call. <- the rate of v is {written} at t = 0.5"
            )
        );
        assert!(failure.source().unwrap().is::<NonFinite>());
    }
}

/// A NaN met by a long step only does no harm.
#[test]
fn a_rate_that_is_not_finite_is_recoverable() {
    let met = Cell::new(false);
    let field = from_fn(1, |_t, y, ydot| {
        ydot[0] = -2.0 * y[0].sqrt();
        met.set(met.get() || y[0] < 0.0);
        Ok(())
    });
    let options =
        Options::new(Method::Adams).relative_tolerance(1e-4).absolute_tolerance(1e-6).initial_step(0.999);
    let motion = solve(erased(field), 0.0, &[1.0], &[0.9], &options).unwrap();
    assert!(met.get());
    assert!((motion.state(0)[0] - 0.01).abs() < 1e-3);
}

#[test]
fn a_rate_that_is_not_written_is_named() {
    let field = from_fn(2, |_t, _y, ydot| {
        ydot[0] = 1.0;
        Ok(())
    });
    let failure = failure(solve(erased(field), 0.0, &[0.0, 0.0], &[1.0], &Options::new(Method::Adams)));
    assert_eq!(failure.source().unwrap().to_string(), "the rate of y[1] is NaN at t = 0");
}

#[test]
fn a_jacobian_that_is_not_finite_is_named() {
    let field = from_fn(2, |_t, y, ydot| {
        ydot[0] = -y[0];
        ydot[1] = -1e3 * y[1];
        Ok(())
    })
    .with_jacobian(|_t, _y, j| {
        j.copy_from_slice(&[-1.0, f64::INFINITY, 0.0, -1e3]);
        Ok(())
    })
    .with_names(["x"]);
    let failure = failure(solve(erased(field), 0.0, &[1.0, 1.0], &[1.0], &Options::new(Method::Bdf)));
    assert_eq!(failure.error.code(), Some(Code::ConvergenceFailure));
    let cause = failure.source().unwrap().to_string();
    assert!(cause.starts_with("the derivative of the rate of y[1] by x is inf at t = "), "{cause}");
}

#[test]
fn a_step_limit_ends_the_work_and_allows_more() {
    let oscillator = || {
        from_fn(2, |_t, y, ydot| {
            ydot[0] = y[1];
            ydot[1] = -y[0];
            Ok(())
        })
    };
    let options = Options::new(Method::Adams).max_steps(50);
    let failure = failure(solve(erased(oscillator()), 0.0, &[1.0, 0.0], &[0.1, 0.2, 1e6], &options));
    assert_eq!(failure.reached.len(), 2);
    let (t, y) = failure.error.reached().unwrap();
    assert!((y[0] - t.cos()).abs() < 1e-6);
    let said = chain(&failure);
    let expected = "50 steps were not enough to reach the output at t = 1000000: the last, of length ";
    assert!(said.starts_with(expected) && said.ends_with(&format!(", ended at t = {t}")), "{said}");

    let mut cvode = Integration::new(erased(oscillator()), 0.0, &[1.0, 0.0], &options).unwrap();
    let mut failures = 0;
    while let Err(error) = cvode.state_at(20.0) {
        assert_eq!(error.code(), Some(Code::TooMuchWork));
        assert_eq!(error.reached(), Some((cvode.time(), cvode.state())));
        failures += 1;
    }
    assert!(failures > 1);
    assert!((cvode.state()[0] - 20.0_f64.cos()).abs() < 1e-6);
}

#[test]
fn tolerances_below_rounding_error() {
    let growth = from_fn(1, |_t, y, ydot| {
        ydot[0] = y[0];
        Ok(())
    });
    let options = Options::new(Method::Adams).relative_tolerance(1e-18).absolute_tolerance(1e-30);
    let motion = solve(erased(growth), 0.0, &[1.0], &[1.0], &options).unwrap();
    assert!((motion.last().unwrap().1[0] - 1.0_f64.exp()).abs() < 1e-13);
}

/// ẏ = (1, 3) by steps of at most 1e-14 of the span: 10 000 of them reach 1e-10 of it.
#[test]
fn steps_that_hardly_advance_end_the_motion() {
    let point = from_fn(2, |_t, _y: &[f64], ydot: &mut [f64]| {
        (ydot[0], ydot[1]) = (1.0, 3.0);
        Ok(())
    })
    .with_names(["slow", "fast"]);
    let options = Options::new(Method::Dop853).max_step(1e-14).absolute_tolerance(1.0);
    let failure = failure(solve(erased(point), 0.0, &[0.0, 0.0], &[1.0], &options));
    let text = chain(&failure);
    assert!(text.starts_with("the last 10000 steps up to t = 0.0000000002"), "{text}");
    assert!(text.ends_with("kept short by fast, whose rate is the largest by the tolerances"), "{text}");
}

/// The distance is that of two neighbouring numbers, and the rates are of size 1.
#[test]
fn an_end_next_to_the_start() {
    let growth = from_fn(1, |_t, y, ydot| {
        ydot[0] = y[0];
        Ok(())
    });
    let end = 1.0 + f64::EPSILON;
    let motion = solve(erased(growth), 1.0, &[1.0], &[end], &Options::new(Method::Adams)).unwrap();
    assert_eq!(motion.last(), Some((end, &[end][..])));
}

/// Steps of the minimum length cannot pass the error test at a jump of f.
#[test]
fn error_test_failures() {
    let jump = from_fn(1, |t: f64, _y: &[f64], ydot: &mut [f64]| {
        ydot[0] = if t < 1.05 { 0.0 } else { 1e9 };
        Ok(())
    });
    let options = Options::new(Method::Adams).initial_step(0.1).min_step(0.1).max_step(0.1);
    let failure = failure(solve(erased(jump), 0.0, &[1.0], &[2.0], &options));
    let (t, y) = failure.error.reached().unwrap();
    assert!((t - 1.0).abs() < 1e-9);
    assert_eq!(y, [1.0]);
    assert_eq!(
        chain(&failure),
        format!(
            "CV_ERR_FAILURE (-3) after reaching t = {t}: At t = 1 and h = 0.1, the error test failed repeatedly or \
             with |h| = hmin."
        )
    );
}

/// ẏ = y² becomes infinite at t = 1.
#[test]
fn blow_up_ends() {
    for options in methods() {
        let blow_up = from_fn(1, |_t, y, ydot| {
            ydot[0] = y[0] * y[0];
            Ok(())
        });
        let failure = failure(solve(erased(blow_up), 0.0, &[1.0], &[0.5, 2.0], &options));
        assert!((failure.reached.state(0)[0] - 2.0).abs() < 1e-6);
        let (t, _) = failure.error.reached().unwrap();
        assert!((t - 1.0).abs() < 1e-4);
        assert_eq!(chain(&failure), format!("the steps have become too short to continue from t = {t}"));
    }
}

#[test]
fn overflow_is_named() {
    let field = from_fn(2, |_t, _y, ydot| {
        ydot[0] = 0.0;
        ydot[1] = 1e306;
        Ok(())
    });
    let failure =
        failure(solve(erased(field), 0.0, &[0.0, 1.7e308], &[1.0, 20.0], &Options::new(Method::Adams)));
    assert_eq!(failure.reached.len(), 1);
    let SolveError::Integration(error) = &failure.error else { panic!("{failure:?}") };
    let Reason::Overflow { component, value, t } = &error.reason else { panic!("{failure:?}") };
    assert_eq!((component.as_str(), *value), ("y[1]", f64::INFINITY));
    assert!(error.time < *t && error.state[1].is_finite());
    assert_eq!(chain(&failure), format!("y[1] is inf at t = {t}, after reaching t = {}", error.time));
}

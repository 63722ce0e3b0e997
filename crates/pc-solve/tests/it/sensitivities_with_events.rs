//! Derivatives of motions with events, across checkpoints and by parameters of any size, against
//! closed forms.

use std::ops::ControlFlow::Continue;

use crate::boxed::{erased, from_fn};
use pc_solve::{
    Checkpoint, Correction, DenseOutput, Event, FnEvents, InputError, Integration, Method, Options, Reason,
    Segment, Sensitivities, Solve, SolveError, VectorField,
};

fn sharp(method: Method) -> Options {
    Options::new(method).relative_tolerance(1e-11).absolute_tolerance(1e-13)
}

/// ẏ = v, v̇ = −g; parameters g and e, where e occurs in the reset only.
fn ball(g: f64) -> impl VectorField {
    from_fn(2, move |_t, y: &[f64], ydot: &mut [f64]| {
        ydot.copy_from_slice(&[y[1], -g]);
        Ok(())
    })
    .autonomous()
    .with_jvp(|_, _, v, product| {
        product.copy_from_slice(&[v[1], 0.0]);
        Ok(())
    })
    .with_parameters(2, |_, _, by| {
        by.copy_from_slice(&[0.0, -1.0, 0.0, 0.0]);
        Ok(())
    })
}

fn bounce(e: f64) -> FnEvents<'static> {
    let reset = move |_: f64, y: &mut [f64]| {
        y[1] *= -e;
        Ok(())
    };
    FnEvents::new()
        .with_reset(Event::new("bounce").falling(), |_, y| Ok(y[0]), reset)
        .with_parameter_derivatives(|_, j, _, y, by| {
            by.copy_from_slice(&[0.0, if j == 1 { -y[1] } else { 0.0 }]);
            Ok(0.0)
        })
}

/// Columns by h, v₀, g and e.
fn columns() -> Sensitivities {
    Sensitivities::new().by_starts([0, 1]).by_parameters([0, 1])
}

/// From height h at rest y = (1 + e)√(2gh) t − (1 + 2e) h − g t²/2 after the first bounce.
fn after_one_bounce(t: f64, h: f64, g: f64, e: f64) -> ([f64; 2], [f64; 8]) {
    let w = (2.0 * g * h).sqrt();
    let state = [(1.0 + e) * w * t - (1.0 + 2.0 * e) * h - g * t * t / 2.0, (1.0 + e) * w - g * t];
    let (by_h, by_g) = (w / (2.0 * h), w / (2.0 * g));
    let landing = w / g;
    let matrix = [
        (1.0 + e) * by_h * t - (1.0 + 2.0 * e),
        (1.0 + e) * by_h,
        t - landing - e * w / g,
        1.0,
        (1.0 + e) * by_g * t - t * t / 2.0,
        (1.0 + e) * by_g - t,
        w * t - 2.0 * h,
        w,
    ];
    (state, matrix)
}

fn assert_near(found: &[f64], expected: &[f64], tolerance: f64) {
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(expected) {
        assert!((found - expected).abs() <= tolerance * expected.abs().max(1.0), "{found} is not {expected}");
    }
}

/// The resets are differentiated by quotients, accurate to ten digits.
#[test]
fn a_bouncing_ball() {
    let (h, g, e) = (1.3, 9.81, 0.8);
    for method in [Method::Adams, Method::Bdf] {
        for correction in [Correction::Staggered, Correction::Simultaneous] {
            let columns = columns().correction(correction);
            let cvode =
                Integration::with_sensitivities(erased(ball(g)), 0.0, &[h, 0.0], &sharp(method), &columns)
                    .unwrap();
            let mut hybrid = cvode.with_events(bounce(e)).unwrap();
            let mut outputs = 0;
            let times = [0.4, 0.6, 0.9, 1.2];
            let compare = |t: f64, y: &[f64], matrix: &[f64]| {
                outputs += 1;
                if t > 0.52 {
                    let (state, derivatives) = after_one_bounce(t, h, g, e);
                    assert_near(y, &state, 1e-8);
                    assert_near(matrix, &derivatives, 1e-8);
                } else {
                    assert_near(matrix, &[1.0, 0.0, t, 1.0, -t * t / 2.0, -t, 0.0, 0.0], 1e-9);
                }
                Continue(())
            };
            hybrid.run_with_sensitivities(&times, compare, |_| Continue(())).unwrap();
            assert_eq!(outputs, 4);
        }
    }
}

/// The derivatives after many bounces against difference quotients of motions.
#[test]
fn many_bounces() {
    let end = 4.0;
    let motion = |h: f64, g: f64, e: f64| {
        let cvode = Integration::new(erased(ball(g)), 0.0, &[h, 0.0], &sharp(Method::Adams)).unwrap();
        let mut hybrid = cvode.with_events(bounce(e)).unwrap();
        hybrid.advance_to(end, |_| Continue(())).unwrap();
        hybrid.state().to_vec()
    };
    let cvode = Integration::with_sensitivities(
        erased(ball(9.81)),
        0.0,
        &[1.0, 0.0],
        &sharp(Method::Adams),
        &columns(),
    )
    .unwrap();
    let mut hybrid = cvode.with_events(bounce(0.9)).unwrap();
    let mut bounces = 0;
    hybrid
        .advance_to(end, |_| {
            bounces += 1;
            Continue(())
        })
        .unwrap();
    assert!(bounces > 5);
    let matrix = hybrid.sensitivities().unwrap();
    let d = 1e-5;
    for (column, (ahead, behind)) in [
        (0, (motion(1.0 + d, 9.81, 0.9), motion(1.0 - d, 9.81, 0.9))),
        (2, (motion(1.0, 9.81 + d, 0.9), motion(1.0, 9.81 - d, 0.9))),
        (3, (motion(1.0, 9.81, 0.9 + d), motion(1.0, 9.81, 0.9 - d))),
    ] {
        let quotient: Vec<f64> = ahead.iter().zip(&behind).map(|(a, b)| (a - b) / (2.0 * d)).collect();
        // The error of the quotients is d² times third derivatives of some hundred.
        assert_near(&matrix[2 * column..2 * column + 2], &quotient, 1e-6);
    }
}

/// ẍ = −x from rest at 1 hits a wall at c, the parameter, and returns with the fraction e of its
/// speed.
#[test]
fn an_impact_oscillator_whose_wall_moves_with_a_parameter() {
    let (c, e, t) = (0.5_f64, 0.7, 1.9);
    let field = from_fn(2, |_t, y: &[f64], ydot: &mut [f64]| {
        ydot.copy_from_slice(&[y[1], -y[0]]);
        Ok(())
    })
    .with_parameters(1, |_, _, by| {
        by.fill(0.0);
        Ok(())
    });
    let wall = FnEvents::new()
        .with_reset(
            Event::new("wall").falling(),
            move |_, y| Ok(y[0] - c),
            move |_, y| {
                y[1] *= -e;
                Ok(())
            },
        )
        .with_parameter_derivatives(|_, _, _, _, by| {
            by.fill(0.0);
            Ok(-1.0)
        });
    let columns = Sensitivities::new().by_parameter(0);
    let cvode =
        Integration::with_sensitivities(erased(field), 0.0, &[1.0, 0.0], &sharp(Method::Adams), &columns)
            .unwrap();
    let mut hybrid = cvode.with_events(wall).unwrap();
    hybrid.advance_to(t, |_| Continue(())).unwrap();
    // x = c cos s + e √(1 − c²) sin s with s = t − acos c
    let (root, s) = ((1.0 - c * c).sqrt(), t - c.acos());
    let by_s = [-c * s.sin() + e * root * s.cos(), -c * s.cos() - e * root * s.sin()];
    let by_c = [s.cos() - e * c / root * s.sin(), -s.sin() - e * c / root * s.cos()];
    let expected = [by_c[0] + by_s[0] / root, by_c[1] + by_s[1] / root];
    assert_near(&hybrid.sensitivities().unwrap(), &expected, 1e-8);
}

/// Events without resets do not change the derivatives.
#[test]
fn events_that_reset_nothing() {
    let passes = FnEvents::new().with(Event::new("half"), |_, y| Ok(y[0] - 0.5));
    let cvode = Integration::with_sensitivities(
        erased(ball(2.0)),
        0.0,
        &[1.0, 0.0],
        &sharp(Method::Adams),
        &columns(),
    )
    .unwrap();
    let mut hybrid = cvode.with_events(passes).unwrap();
    hybrid.advance_to(3.0, |_| Continue(())).unwrap();
    assert_near(&hybrid.sensitivities().unwrap(), &[1.0, 0.0, 3.0, 1.0, -4.5, -3.0, 0.0, 0.0], 1e-9);
}

/// Cases without derivatives, or with unknown ones, are refused.
#[test]
fn sensitivities_over_events_without_derivatives_are_refused() {
    let start = |h: f64, v: f64| {
        Integration::with_sensitivities(erased(ball(1.0)), 0.0, &[h, v], &sharp(Method::Adams), &columns())
            .unwrap()
    };
    let turn = |_: f64, y: &mut [f64]| {
        y[1] = y[1].abs();
        Ok(())
    };
    let silent = FnEvents::new().with_reset(Event::new("bounce"), |_, y| Ok(y[0]), turn);
    assert!(matches!(
        start(1.0, 0.0).with_events(silent).unwrap_err(),
        SolveError::Input(InputError::EventParameters)
    ));
    let both = || {
        FnEvents::new()
            .with_reset(Event::new("one"), |_, y| Ok(y[0]), turn)
            .with_reset(Event::new("two"), |_, y| Ok(3.0 * y[0]), turn)
            .with_parameter_derivatives(|_, _, _, _, by| {
                by.fill(0.0);
                Ok(0.0)
            })
    };
    let error = start(1.0, 0.0).with_events(both()).unwrap().advance_to(3.0, |_| Continue(())).unwrap_err();
    let SolveError::Integration(error) = error else { panic!("{error}") };
    assert!(matches!(&error.reason, Reason::Together { events, .. } if events == &["one", "two"]), "{error}");
}

/// A motion resumed from a checkpoint has the derivatives of the uninterrupted one; resuming
/// without mention of them is refused.
#[test]
fn derivatives_continue_from_a_checkpoint() {
    let options = sharp(Method::Adams);
    let decay = || {
        from_fn(1, |_t, y: &[f64], ydot: &mut [f64]| {
            ydot[0] = -y[0] * y[0];
            Ok(())
        })
    };
    let start = Sensitivities::new().by_start(0);
    let mut motion = Integration::with_sensitivities(erased(decay()), 0.0, &[2.0], &options, &start).unwrap();
    motion.state_at(1.0).unwrap();
    let kept = Checkpoint::from_bytes(&motion.checkpoint().to_bytes("")).unwrap().0;
    assert_near(kept.sensitivities(), &[1.0 / 9.0], 1e-9);
    let mut later = Integration::resume_with_sensitivities(decay(), &kept, &options, &start).unwrap();
    later.state_at(1.5).unwrap();
    assert_near(&later.sensitivities().unwrap(), &[1.0 / 16.0], 1e-9);
    let mut same =
        Integration::resume_with_sensitivities(decay(), &motion.checkpoint(), &options, &start).unwrap();
    same.state_at(1.5).unwrap();
    assert_eq!(same.sensitivities().unwrap(), later.sensitivities().unwrap());

    let refused = |result: Result<(), SolveError>| {
        let error = result.unwrap_err();
        assert!(matches!(error, SolveError::Input(InputError::Sensitivities { .. })), "{error}");
    };
    refused(Integration::resume(decay(), &kept, &options).map(|_| ()));
    refused(
        Integration::resume(decay(), &kept, &options)
            .and_then(|resumed| resumed.with_events_of(FnEvents::new(), &kept))
            .map(|_| ()),
    );
    let two = Sensitivities::new().by_start(0).along([1.0]);
    refused(Integration::resume_with_sensitivities(decay(), &kept, &options, &two).map(|_| ()));
    let plain = Checkpoint::start(0.0, &[2.0]);
    refused(Integration::resume_with_sensitivities(decay(), &plain, &options, &start).map(|_| ()));

    // With events, in the middle of a flight.
    let cvode =
        Integration::with_sensitivities(erased(ball(9.81)), 0.0, &[1.3, 0.0], &options, &columns()).unwrap();
    let mut hybrid = cvode.with_events(bounce(0.8)).unwrap();
    hybrid.advance_to(0.7, |_| Continue(())).unwrap();
    let kept = Checkpoint::from_bytes(&hybrid.checkpoint().to_bytes("")).unwrap().0;
    let mut later = Integration::resume_with_sensitivities(ball(9.81), &kept, &options, &columns())
        .and_then(|resumed| resumed.with_events_of(bounce(0.8), &kept))
        .unwrap();
    later.advance_to(1.2, |_| Continue(())).unwrap();
    assert_near(&later.sensitivities().unwrap(), &after_one_bounce(1.2, 1.3, 9.81, 0.8).1, 1e-8);
}

/// ẏ = −p y/P at p = P of any size: ∂y/∂p = −t e^(−t)/P, to the tolerance.
#[test]
fn parameters_of_any_size() {
    for size in [1e-20, 1.0, 1e6, 1e20, 1e100] {
        let field = || {
            from_fn(1, |_t, y: &[f64], ydot: &mut [f64]| {
                ydot[0] = -y[0];
                Ok(())
            })
            .with_parameters(1, move |_, y, by| {
                by[0] = -y[0] / size;
                Ok(())
            })
        };
        for columns in
            [Sensitivities::new().by_parameter(0), Sensitivities::new().by_parameter(0).scales([size])]
        {
            let motion = Solve::new(erased(field()), 0.0, &[1.0])
                .method(&Options::default())
                .sensitivities(&columns)
                .run(&[2.0])
                .unwrap();
            let (found, expected) = (motion.trajectory.matrix(0)[0], -2.0 * (-2.0f64).exp() / size);
            // rtol 1e-9 over some dozens of steps.
            assert!((found / expected - 1.0).abs() < 1e-7, "{size}: {found} is not {expected}");
        }
    }
    let wrong = Sensitivities::new().by_start(0).scales([0.0]);
    let one = from_fn(1, |_t, _y: &[f64], ydot: &mut [f64]| {
        ydot[0] = 0.0;
        Ok(())
    });
    assert!(
        Solve::new(erased(one), 0.0, &[1.0])
            .method(&Options::default())
            .sensitivities(&wrong)
            .run(&[1.0])
            .is_err()
    );
}

/// S as a function of time over a bounce, with the derivatives of its polynomials: as accurate as
/// at the ends of steps.
#[test]
fn derivatives_between_the_steps() {
    let (h, g, e) = (1.3, 9.81, 0.8);
    for method in [Method::Adams, Method::Bdf] {
        let cvode =
            Integration::with_sensitivities(erased(ball(g)), 0.0, &[h, 0.0], &sharp(method), &columns())
                .unwrap();
        let mut hybrid = cvode.with_events(bounce(e)).unwrap();
        let mut matrix = DenseOutput::default();
        let keep = |_: Segment, of_matrix: Segment| {
            matrix.extend([of_matrix]);
            Continue(())
        };
        hybrid.run_dense_with_sensitivities(1.2, keep, |_| Continue(())).unwrap();
        assert_eq!(matrix.span(), Some((0.0, 1.2)));
        for i in 0..=120 {
            let t = f64::from(i) / 100.0;
            let expected = if t > (2.0 * h / g).sqrt() {
                after_one_bounce(t, h, g, e).1
            } else {
                [1.0, 0.0, t, 1.0, -t * t / 2.0, -t, 0.0, 0.0]
            };
            assert_near(&matrix.evaluate(t).unwrap(), &expected, 1e-8);
        }
        // Inside the last step, with a derivative: ∂ÿ/∂h is 0 and ∂ẏ/∂h is the slope of ∂y/∂h.
        let t = hybrid.time();
        let (now, slope) = (
            hybrid.interpolate_sensitivities(t, 0).unwrap(),
            hybrid.interpolate_sensitivities(t, 1).unwrap(),
        );
        assert_near(&now, &after_one_bounce(t, h, g, e).1, 1e-8);
        assert_near(&slope[..2], &[now[1], 0.0], 1e-7);
    }
}

/// ẏ = −y²: ∂y/∂y₀ = 1/(1 + y₀ t)² at any time, as accurate as at the ends of steps.
#[test]
fn derivatives_of_a_smooth_motion_as_a_function_of_time() {
    let decay = || {
        from_fn(1, |_t, y: &[f64], ydot: &mut [f64]| {
            ydot[0] = -y[0] * y[0];
            Ok(())
        })
    };
    let exact = |t: f64| 1.0 / (1.0 + 2.0 * t).powi(2);
    let columns = Sensitivities::new().by_start(0);
    for method in [Method::Adams, Method::Bdf] {
        for rtol in [1e-6, 1e-9] {
            let options = Options::new(method).relative_tolerance(rtol).absolute_tolerance(rtol);
            let (motion, matrix) = Solve::new(erased(decay()), 0.0, &[2.0])
                .method(&options)
                .sensitivities(&columns)
                .dense(3.0)
                .unwrap();
            let error = |t: f64| (matrix.evaluate(t).unwrap()[0] - exact(t)).abs();
            let at_steps = motion.segments().iter().map(|s| error(s.span().1)).fold(0.0, f64::max);
            let between = (0..=3000).map(|i| error(f64::from(i) / 1000.0)).fold(0.0, f64::max);
            assert!(between < 2.0 * at_steps + 2.0 * rtol, "{method} {rtol}: {between:e} {at_steps:e}");
            assert!(at_steps < 300.0 * rtol, "{method} {rtol}: {at_steps:e}");
        }
    }
    let mut cvode =
        Integration::with_sensitivities(erased(decay()), 0.0, &[2.0], &sharp(Method::Adams), &columns)
            .unwrap();
    assert!(matches!(
        cvode.interpolate_sensitivities(0.0, 0).unwrap_err(),
        SolveError::Input(InputError::NoStep)
    ));
    let end = cvode.step_towards(3.0).unwrap();
    assert_near(&cvode.interpolate_sensitivities(end / 2.0, 0).unwrap(), &[exact(end / 2.0)], 1e-9);
    assert!(matches!(
        cvode.interpolate_sensitivities(2.0 * end, 0).unwrap_err(),
        SolveError::Input(InputError::OutsideStep { .. })
    ));
    let mut plain = Integration::new(erased(decay()), 0.0, &[2.0], &sharp(Method::Adams)).unwrap();
    let end = plain.step_towards(3.0).unwrap();
    assert!(matches!(
        plain.interpolate_sensitivities(end, 0).unwrap_err(),
        SolveError::Input(InputError::NoSensitivities)
    ));
}

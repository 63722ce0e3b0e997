//! DOP853: order, states inside steps, events, checkpoints, breaks, pulses, failures, limits,
//! stiffness.

use std::cell::Cell;
use std::num::NonZeroU64;
use std::ops::ControlFlow::Continue;

use crate::boxed::{erased, from_fn};
use pc_solve::{
    Checkpoint, Dop853, Event, Failure, FnEvents, Inequality, InputError, Integration, LinearSolver, Method,
    NonlinearSolver, Options, Reason, Resumable, Sensitivities, Solve, SolveError, VectorField, solve,
};

fn options(rtol: f64) -> Options {
    Options::new(Method::Dop853).relative_tolerance(rtol).absolute_tolerance(rtol * 1e-3)
}

/// y = (cos t, −sin t).
fn oscillator() -> impl VectorField {
    from_fn(2, |_t, y: &[f64], rates: &mut [f64]| {
        rates.copy_from_slice(&[y[1], -y[0]]);
        Ok(())
    })
    .autonomous()
}

/// Fixed steps: the tolerance never rejects one.
fn stepping(length: f64) -> Options {
    options(1.0).absolute_tolerance(1e3).initial_step(length).max_step(length)
}

/// A nonlinear field with the motion y = 1/√(1 + t), to which the tall trees of the order
/// conditions contribute.
fn decay() -> impl VectorField {
    from_fn(1, |_t, y: &[f64], rates: &mut [f64]| {
        rates[0] = -0.5 * y[0].powi(3);
        Ok(())
    })
    .autonomous()
}

#[test]
fn the_error_falls_with_the_eighth_power_of_the_step() {
    for end in [4.0_f64, -4.0] {
        let error = |length: f64| {
            let y = solve(erased(oscillator()), 0.0, &[1.0, 0.0], &[end], &stepping(length)).unwrap();
            (y.state(0)[0] - end.cos()).hypot(y.state(0)[1] + end.sin())
        };
        let slope = (error(0.5) / error(0.25)).log2();
        assert!((slope - 8.0).abs() < 0.3, "{end}: {slope}");
    }
    let error = |length: f64| {
        let y = solve(erased(decay()), 0.0, &[1.0], &[4.0], &stepping(length)).unwrap();
        (y.state(0)[0] - 0.2_f64.sqrt()).abs()
    };
    let slope = (error(0.4) / error(0.2)).log2();
    assert!((slope - 8.0).abs() < 0.6, "{slope} {:e}", error(0.4));
}

#[test]
fn states_inside_steps_are_of_order_seven_and_rates_of_one_less_each() {
    let worst = |length: f64, order: u32, exact: fn(f64) -> f64| {
        let dop = Dop853::new(oscillator(), 0.0, &[1.0, 0.0], &stepping(length)).unwrap();
        let mut motion = Integration::of(dop);
        let mut worst = 0.0_f64;
        // One step from an exact state, so the order is that of the local error.
        let to = motion.step_towards(5.0).unwrap();
        for part in 0..=20 {
            let t = f64::from(part) / 20.0 * to;
            worst = worst.max((motion.interpolate(t, order).unwrap()[0] - exact(t)).abs());
        }
        worst
    };
    for (order, exact) in [f64::cos, |t: f64| -t.sin(), |t: f64| -t.cos(), f64::sin].into_iter().enumerate() {
        let slope = (worst(0.8, order as u32, exact) / worst(0.4, order as u32, exact)).log2();
        let expected = 8.0 - order as f64;
        assert!((slope - expected).abs() < 0.6, "order {order}: {slope}");
    }
    let mut motion = Integration::of(Dop853::new(oscillator(), 0.0, &[1.0, 0.0], &options(1e-9)).unwrap());
    motion.step_towards(1.0).unwrap();
    let end = motion.time();
    let error = motion.interpolate(end, 8).unwrap_err();
    assert!(matches!(error, SolveError::Input(InputError::DerivativeOrder { order: 8, highest: 7 })));
}

/// Steps have h ∝ tol^(1/8), and the error at the end is of the size of the tolerance.
#[test]
fn errors_and_steps_follow_the_tolerance() {
    let mut before: Option<(f64, u64)> = None;
    for rtol in [1e-6, 1e-8, 1e-10, 1e-12] {
        let found = solve(erased(oscillator()), 0.0, &[1.0, 0.0], &[20.0], &options(rtol)).unwrap();
        let error = (found.state(0)[0] - 20.0_f64.cos()).hypot(found.state(0)[1] + 20.0_f64.sin());
        let steps = found.statistics().steps;
        assert!(error < 100.0 * rtol, "{rtol:e}: {error:e}");
        if let Some((_, fewer)) = before {
            let ratio = steps as f64 / fewer as f64;
            // 10^(2/8) = 1.78
            assert!((1.5..2.1).contains(&ratio), "{rtol:e}: {steps} after {fewer}");
        }
        before = Some((error, steps));
    }
}

/// Kepler's orbit with e = 1/2 about the origin, in its plane. Both return after one period.
#[test]
fn kepler_and_arenstorf_orbits_close() {
    let kepler = from_fn(4, |_t, y: &[f64], rates: &mut [f64]| {
        let r3 = y[0].hypot(y[1]).powi(3);
        rates.copy_from_slice(&[y[2], y[3], -y[0] / r3, -y[1] / r3]);
        Ok(())
    });
    let start = [0.5, 0.0, 0.0, 3.0_f64.sqrt()];
    let found = solve(erased(kepler), 0.0, &start, &[std::f64::consts::TAU], &options(1e-12)).unwrap();
    for (found, expected) in found.state(0).iter().zip(start) {
        assert!((found - expected).abs() < 1e-10, "{found} {expected}");
    }
    // [Hairer, Nørsett, Wanner 1993, II.0, (0.1)]; errors grow some ten thousandfold along it.
    const MU: f64 = 0.012_277_471;
    let arenstorf = from_fn(4, |_t, y: &[f64], rates: &mut [f64]| {
        let (a, b) = (y[0] + MU, y[0] - (1.0 - MU));
        let (d1, d2) = (a.hypot(y[1]).powi(3), b.hypot(y[1]).powi(3));
        rates[0] = y[2];
        rates[1] = y[3];
        rates[2] = y[0] + 2.0 * y[3] - (1.0 - MU) * a / d1 - MU * b / d2;
        rates[3] = y[1] - 2.0 * y[2] - (1.0 - MU) * y[1] / d1 - MU * y[1] / d2;
        Ok(())
    })
    .autonomous();
    let start = [0.994, 0.0, 0.0, -2.001_585_106_379_082_5];
    let found = solve(erased(arenstorf), 0.0, &start, &[17.065_216_560_157_96], &options(1e-12)).unwrap();
    for (found, expected) in found.state(0)[..2].iter().zip(start) {
        assert!((found - expected).abs() < 1e-6, "{found} {expected}");
    }
    let work = found.statistics();
    assert!(work.steps < 500, "{work:?}");
    assert!(work.error_test_failures > 0, "an orbit that needs steps of all lengths: {work:?}");
}

#[test]
fn evaluations_are_counted_and_dense_output_costs_three() {
    let calls = Cell::new(0);
    let field = from_fn(2, |_t, y: &[f64], rates: &mut [f64]| {
        calls.set(calls.get() + 1);
        rates.copy_from_slice(&[y[1], -y[0]]);
        Ok(())
    })
    .autonomous();
    let mut motion = Integration::of(Dop853::new(field, 0.0, &[1.0, 0.0], &options(1e-9)).unwrap());
    for _ in 0..20 {
        motion.step_towards(100.0).unwrap();
    }
    let work = motion.statistics();
    assert_eq!((work.rhs_evaluations, work.steps), (calls.get(), 20));
    // The first rates, one for the first length, and 12 for each step, 11 for a rejected one.
    assert_eq!(calls.get(), 2 + 12 * 20 + 11 * work.error_test_failures);
    let (from, to) = (motion.time() - 1e-3, motion.time());
    motion.interpolate(from, 0).unwrap();
    motion.interpolate(from, 1).unwrap();
    motion.interpolate(to, 0).unwrap();
    assert_eq!(motion.statistics().rhs_evaluations, work.rhs_evaluations + 3);
    assert_eq!(motion.statistics().rhs_evaluations, calls.get());
}

#[test]
fn dense_output_is_what_interpolation_gives() {
    let method = options(1e-9);
    let dense = Solve::new(erased(oscillator()), 0.0, &[1.0, 0.0]).method(&method).dense(6.0).unwrap();
    assert_eq!(dense.span(), Some((0.0, 6.0)));
    for i in 0..60 {
        let t = f64::from(i) / 10.0;
        let y = solve(erased(oscillator()), 0.0, &[1.0, 0.0], &[t, 6.0], &method).unwrap().state(0).to_vec();
        let of_polynomial = dense.evaluate(t).unwrap();
        // The same polynomials, about another point; of order 7, with the tolerance of a step of
        // order 8.
        assert!((of_polynomial[0] - y[0]).abs() < 1e-13, "{t}: {of_polynomial:?} {y:?}");
        assert!((y[0] - t.cos()).abs() < 1e-7, "{t}: {y:?}");
    }
}

const G: f64 = 9.81;

/// Height and velocity of a ball, and its bounces with a restitution of 1/2.
fn ball() -> (impl VectorField, FnEvents<'static>) {
    let fall = from_fn(2, |_t, y: &[f64], rates: &mut [f64]| {
        rates.copy_from_slice(&[y[1], -G]);
        Ok(())
    });
    let reset = |_t: f64, y: &mut [f64]| -> Result<(), Failure> {
        y[1] *= -0.5;
        Ok(())
    };
    (fall, FnEvents::new().with_reset(Event::new("bounce").falling(), |_t, y| Ok(y[0]), reset))
}

#[test]
fn a_ball_bounces_when_it_should() {
    let (fall, bounce) = ball();
    let method = options(1e-9);
    let motion =
        Solve::new(erased(fall), 0.0, &[1.0, 0.0]).method(&method).events(bounce).run(&[1.2]).unwrap();
    let fall_time = (2.0 / G).sqrt();
    let times = [1.0, 2.0, 2.5].map(|k| k * fall_time);
    assert_eq!(motion.occurrences.len(), 3);
    for (occurrence, t) in motion.occurrences.iter().zip(times) {
        // The method is exact for parabolas up to rounding.
        assert!((occurrence.time - t).abs() < 1e-13, "{} {t}", occurrence.time);
    }
}

#[test]
fn a_resumed_integration_is_the_same_to_the_last_bit() {
    for method in [Method::Dop853, Method::Auto] {
        let options = Options::new(method).max_step(0.05);
        let (times, every) = ([0.3, 0.9, 1.15], NonZeroU64::new(3).unwrap());
        let mut kept = Vec::new();
        let start = Checkpoint::start(0.0, &[1.0, 0.0]);
        let save = |checkpoint: &Checkpoint, _| kept.push(checkpoint.to_bytes("ball"));
        let whole = Resumable::new(ball, start)
            .method(&options)
            .every(every)
            .run(&times, save, |_, _| Continue(()))
            .unwrap();
        assert!(kept.len() > 5 && whole.occurrences.len() == 3, "{} {whole:?}", kept.len());
        for bytes in kept {
            let (from, _) = Checkpoint::from_bytes(&bytes).unwrap();
            let later = Resumable::new(ball, from)
                .method(&options)
                .every(every)
                .run(&times, |_, _| (), |_, _| Continue(()))
                .unwrap();
            assert_eq!(later, whole, "{method}");
        }
    }
}

#[test]
fn there_and_back_again() {
    let pendulum = || {
        from_fn(2, |_t, y: &[f64], rates: &mut [f64]| {
            rates.copy_from_slice(&[y[1], -y[0].sin()]);
            Ok(())
        })
    };
    let there = solve(erased(pendulum()), 0.0, &[1.0, 0.5], &[10.0], &options(1e-12)).unwrap();
    let back = solve(erased(pendulum()), 10.0, there.state(0), &[0.0], &options(1e-12)).unwrap();
    assert!((back.state(0)[0] - 1.0).hypot(back.state(0)[1] - 0.5) < 1e-10);
}

#[test]
fn steps_end_at_the_last_time_and_not_beyond() {
    let late = |t: f64, _y: &[f64], rates: &mut [f64]| {
        assert!(t <= 1.0, "{t}");
        rates[0] = t;
        Ok(())
    };
    let motion = solve(erased(from_fn(1, late)), 0.0, &[0.0], &[1.0], &options(1e-9)).unwrap();
    assert!((motion.state(0)[0] - 0.5).abs() < 1e-14);
}

/// ẏ = 0 before t = 1 and 1 after it.
struct Switch {
    breaks: [f64; 1],
    on: bool,
}

impl VectorField for Switch {
    fn dim(&self) -> usize {
        1
    }

    fn rhs(&mut self, t: f64, _y: &[f64], rates: &mut [f64]) -> Result<(), Failure> {
        assert!(if self.on { t >= 1.0 } else { t <= 1.0 }, "{t} {}", self.on);
        rates[0] = f64::from(u8::from(self.on));
        Ok(())
    }

    fn breaks(&self) -> &[f64] {
        &self.breaks
    }

    fn enter(&mut self, t: f64, end: f64) -> bool {
        let before = std::mem::replace(&mut self.on, if end > t { t >= 1.0 } else { t > 1.0 });
        before != self.on
    }
}

#[test]
fn steps_end_where_the_field_jumps() {
    for method in [Method::Dop853, Method::Auto] {
        for (t0, end, expected) in [(0.0, 2.5, 1.5), (2.5, 0.0, -1.5)] {
            let field = Switch { breaks: [1.0], on: false };
            // With outputs inside steps, whose states must stay on their side.
            let times: Vec<f64> = (1..=50).map(|i| t0 + (end - t0) * f64::from(i) / 50.0).collect();
            let motion = solve(erased(field), t0, &[0.0], &times, &Options::new(method)).unwrap();
            assert!((motion.state(49)[0] - expected).abs() < 1e-13, "{method} {t0} → {end}");
            let at = |t: f64| if t0 == 0.0 { (t - 1.0).max(0.0) } else { t.max(1.0) - 2.5 };
            for (t, y) in motion.iter() {
                assert!((y[0] - at(t)).abs() < 1e-13, "{method} {t}: {} {}", y[0], at(t));
            }
        }
    }
}

/// ẏ = −1 − √y reaches y = 0, beyond which f is NaN.
#[test]
fn where_the_field_fails_steps_become_shorter() {
    let root = || {
        from_fn(1, |_t, y: &[f64], rates: &mut [f64]| {
            rates[0] = -y[0].sqrt() - 1.0;
            Ok(())
        })
    };
    let method = options(1e-9);
    let failure = Solve::new(erased(root()), 0.0, &[1.0]).method(&method).run(&[0.2, 5.0]).unwrap_err();
    assert_eq!(failure.reached.trajectory.len(), 1);
    let SolveError::Integration(error) = &failure.error else { panic!("{}", failure.error) };
    // With u = √y: t = 2(1 − u) − 2 ln(2/(1 + u)) at u = 0.
    let end = 2.0 - 2.0 * 2.0_f64.ln();
    assert!(matches!(error.reason, Reason::Rates { .. }), "{error}");
    assert!((error.time - end).abs() < 1e-6, "{error}");
    assert!(error.failure.is_some());
    // A fatal failure ends the integration at once.
    let calls = Cell::new(0);
    let fatal = from_fn(1, |_t, _y: &[f64], _rates: &mut [f64]| {
        calls.set(calls.get() + 1);
        Err(Failure::fatal(std::fmt::Error))
    });
    let failure = solve(erased(fatal), 0.0, &[1.0], &[1.0], &method).unwrap_err();
    assert!(
        matches!(&failure.error, SolveError::Integration(error) if matches!(error.reason, Reason::Rates { t } if t == 0.0))
    );
    assert_eq!(calls.get(), 1);
}

/// ẏ = y² from 1 is infinite at t = 1.
#[test]
fn a_motion_that_becomes_infinite_is_an_error() {
    let field = from_fn(1, |_t, y: &[f64], rates: &mut [f64]| {
        rates[0] = y[0] * y[0];
        Ok(())
    });
    let failure = solve(erased(field), 0.0, &[1.0], &[2.0], &options(1e-9)).unwrap_err();
    let SolveError::Integration(error) = &failure.error else { panic!("{}", failure.error) };
    assert!((error.time - 1.0).abs() < 1e-6, "{error}");
}

#[test]
fn inequalities_hold_at_the_ends_of_steps() {
    // ẏ = −√|y| reaches 0 at t = 2 and stays.
    let field = || {
        from_fn(1, |_t, y: &[f64], rates: &mut [f64]| {
            rates[0] = if y[0] > 0.0 { -y[0].sqrt() } else { 0.0 };
            Ok(())
        })
    };
    let method = options(1e-6).inequalities(vec![Inequality::NotNegative]);
    let mut lowest = f64::INFINITY;
    let step = |_: f64, y: &[f64]| {
        lowest = lowest.min(y[0]);
        Continue(())
    };
    let motion = Solve::new(erased(field()), 0.0, &[1.0]).method(&method).run_observed(&[4.0], step).unwrap();
    assert!(lowest >= 0.0, "{lowest}");
    assert!(motion.trajectory.state(0)[0] < 1e-6);
    let refused = solve(erased(field()), 0.0, &[-1.0], &[1.0], &method).unwrap_err();
    assert!(matches!(refused.error, SolveError::Input(InputError::Inequality { .. })));
}

#[test]
fn states_stay_where_they_are_projected_to() {
    let circle = from_fn(2, |_t, y: &[f64], rates: &mut [f64]| {
        rates.copy_from_slice(&[y[1], -y[0]]);
        Ok(())
    })
    .with_projection(|_t, y| {
        let r = y[0].hypot(y[1]);
        y.iter_mut().for_each(|y| *y /= r);
        Ok(())
    });
    let times: Vec<f64> = (1..=200).map(f64::from).collect();
    let motion = solve(erased(circle), 0.0, &[1.0, 0.0], &times, &options(1e-6)).unwrap();
    for (t, y) in motion.iter() {
        assert!((y[0].hypot(y[1]) - 1.0).abs() < 1e-15, "{t}: {y:?}");
    }
}

#[test]
fn limits_end_an_integration() {
    let failure =
        solve(erased(oscillator()), 0.0, &[1.0, 0.0], &[1e3], &options(1e-9).max_steps(10)).unwrap_err();
    let SolveError::Integration(error) = &failure.error else { panic!("{}", failure.error) };
    assert!(matches!(error.reason, Reason::Steps { steps: 10, .. }), "{error}");
    // Steps that need to be shorter than allowed.
    let failure =
        solve(erased(oscillator()), 0.0, &[1.0, 0.0], &[1e3], &options(1e-12).min_step(3.0)).unwrap_err();
    let SolveError::Integration(error) = &failure.error else { panic!("{}", failure.error) };
    assert_eq!(error.reason, Reason::Stalled);
    let mut longest = 0.0_f64;
    let mut before = 0.0;
    let step = |t: f64, _: &[f64]| {
        longest = longest.max(t - before);
        before = t;
        Continue(())
    };
    let method = options(1e-6).max_step(0.25);
    Solve::new(erased(oscillator()), 0.0, &[1.0, 0.0]).method(&method).run_observed(&[5.0], step).unwrap();
    assert!(longest <= 0.25 * (1.0 + 1e-12), "{longest}");
}

/// A short pulse on a body at rest, with a closure that does not reveal its dependence on time.
#[test]
fn pulses_are_not_stepped_over() {
    for (at, width) in [(5.0, 0.2), (1.234, 0.2), (8.9, 0.1)] {
        let spring = from_fn(2, move |t: f64, y: &[f64], rates: &mut [f64]| {
            rates[0] = y[1];
            rates[1] = (-((t - at) / width).powi(2)).exp() - y[0];
            Ok(())
        });
        let motion = solve(erased(spring), 0.0, &[0.0, 0.0], &[10.0], &options(1e-9)).unwrap();
        let expected = width * std::f64::consts::PI.sqrt() * (-width * width / 4.0).exp() * (10.0 - at).sin();
        let found = motion.state(0)[0];
        assert!((found - expected).abs() < 1e-6 * width, "{at} {width}: {found}, not {expected}");
    }
}

/// ẏ = −λ (y − cos t)
fn relaxation(rate: f64) -> impl VectorField {
    from_fn(1, move |t: f64, y: &[f64], rates: &mut [f64]| {
        rates[0] = -rate * (y[0] - t.cos());
        Ok(())
    })
}

fn van_der_pol(mu: f64) -> impl VectorField {
    from_fn(2, move |_t, y: &[f64], rates: &mut [f64]| {
        rates.copy_from_slice(&[y[1], mu * (1.0 - y[0] * y[0]) * y[1] - y[0]]);
        Ok(())
    })
    .autonomous()
}

#[test]
fn stiffness_is_detected_where_it_is_and_only_there() {
    for (field, end) in [(relaxation(1e4), 3.0), (relaxation(1e6), 0.1)] {
        let motion = solve(erased(field), 0.0, &[0.0], &[end], &options(1e-6)).unwrap();
        let seen = motion.statistics().stiff_from.expect("stiff");
        assert!(seen < 0.1, "{seen}");
    }
    let motion = solve(erased(van_der_pol(1e3)), 0.0, &[2.0, 0.0], &[20.0], &options(1e-6)).unwrap();
    assert!(motion.statistics().stiff_from.is_some());
    for rtol in [1e-4, 1e-6, 1e-9, 1e-12] {
        let motion = solve(erased(van_der_pol(1.0)), 0.0, &[2.0, 0.0], &[50.0], &options(rtol)).unwrap();
        assert_eq!(motion.statistics().stiff_from, None, "{rtol:e}");
        let motion = solve(erased(oscillator()), 0.0, &[1.0, 0.0], &[200.0], &options(rtol)).unwrap();
        assert_eq!(motion.statistics().stiff_from, None, "{rtol:e}");
    }
}

#[test]
fn the_method_changes_to_bdf_and_back() {
    let run = |method: Method, field: &mut dyn VectorField, y: &[f64], end: f64| {
        let options = Options::new(method).relative_tolerance(1e-8).absolute_tolerance(1e-11);
        let motion = solve(erased(field), 0.0, y, &[end], &options).unwrap();
        (motion.state(0).to_vec(), *motion.statistics())
    };
    // A motion that is stiff throughout.
    let (y, work) = run(Method::Auto, &mut relaxation(1e6), &[0.0], 10.0);
    // y = (λ² cos t + λ sin t)/(1 + λ²) after the transient.
    assert!((y[0] - (10.0_f64.cos() + 1e-6 * 10.0_f64.sin())).abs() < 1e-6, "{y:?}");
    assert_eq!((work.changes, work.stiff_from.is_some()), (1, true));
    assert!(work.implicit_steps > 50 && work.steps < 2000, "{work:?}");
    // A motion that is never stiff.
    let (y, work) = run(Method::Auto, &mut oscillator(), &[1.0, 0.0], 100.0);
    let (same, alone) = run(Method::Dop853, &mut oscillator(), &[1.0, 0.0], 100.0);
    assert_eq!((y, work), (same, alone));
    assert_eq!((work.changes, work.implicit_steps), (0, 0));
    // A motion that is stiff along its slow branches and not in between: the same as by BDF alone.
    let (y, work) = run(Method::Auto, &mut van_der_pol(100.0), &[2.0, 0.0], 200.0);
    let (exact, alone) = run(Method::Bdf, &mut van_der_pol(100.0), &[2.0, 0.0], 200.0);
    assert!((y[0] - exact[0]).abs() < 1e-4, "{y:?} {exact:?}");
    assert!(work.changes >= 1 && work.steps < 3 * alone.steps, "{work:?} {alone:?}");
    // A motion that is stiff until t = 5.
    let mut calms = from_fn(2, |t: f64, y: &[f64], rates: &mut [f64]| {
        let rate = if t < 5.0 { 1e5 } else { 0.1 };
        rates.copy_from_slice(&[y[1], -y[0] - rate * y[1]]);
        Ok(())
    });
    let (_, work) = run(Method::Auto, &mut calms, &[1.0, 0.0], 100.0);
    assert_eq!(work.changes, 2, "{work:?}");
    assert!(work.implicit_steps < work.steps - 20, "{work:?}");
}

#[test]
fn the_same_input_gives_the_same_bits() {
    let run = || {
        let options = Options::new(Method::Auto).relative_tolerance(1e-6).absolute_tolerance(1e-9);
        solve(erased(van_der_pol(50.0)), 0.0, &[2.0, 0.0], &[10.0, 150.0], &options).unwrap()
    };
    assert_eq!(run(), run());
}

#[test]
fn options_that_a_method_lacks_are_refused_by_name() {
    let of = |options: Options| {
        let error = solve(erased(oscillator()), 0.0, &[1.0, 0.0], &[1.0], &options).unwrap_err();
        error.to_string()
    };
    assert_eq!(
        of(options(1e-9).max_order(5)),
        "DOP853 does not let you choose a highest order: leave the choice out"
    );
    assert_eq!(
        of(options(1e-9).nonlinear_solver(NonlinearSolver::Newton)),
        "DOP853 does not let you choose an iteration: leave the choice out"
    );
    assert_eq!(
        of(options(1e-9).linear_solver(LinearSolver::Dense)),
        "DOP853 does not let you choose a linear solver: leave the choice out"
    );
    assert_eq!(
        of(Options::new(Method::Auto).max_order(5)),
        "auto does not let you choose a highest order: leave the choice out"
    );
    for rtol in [0.0, -1.0, f64::NAN] {
        assert!(of(options(1e-9).relative_tolerance(rtol)).contains("relative tolerance"));
    }
    let sensitivities = Sensitivities::new().by_start(0);
    let with = |method: Method| {
        let options = Options::new(method);
        let (y, times) = ([1.0, 0.0], [1.0]);
        Solve::new(erased(oscillator()), 0.0, &y)
            .method(&options)
            .sensitivities(&sensitivities)
            .run(&times)
            .map(|_| ())
    };
    let refused = std::error::Error::source(&with(Method::Taylor).unwrap_err()).unwrap().to_string();
    assert!(refused.contains("needs a vector field that is a program"), "{refused}");
    with(Method::Dop853).unwrap();
    with(Method::Auto).unwrap();
}

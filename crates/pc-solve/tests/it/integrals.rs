//! Integrals along motions against closed forms.

use std::ops::ControlFlow::Continue;

use crate::boxed::{erased, from_fn};
use pc_solve::{
    Event, Failure, FnEvents, InputError, Integrals, Integration, Method, NonFinite, Options, Sensitivities,
    Solve, SolveError, VectorField, solve,
};

fn decay() -> impl VectorField {
    from_fn(1, |_t, y: &[f64], ydot: &mut [f64]| {
        ydot[0] = -y[0];
        Ok(())
    })
}

/// ∫ y dt and ∫ y² dt
fn moments() -> Integrals {
    Integrals::new(2, |_t, y, rates| {
        rates.copy_from_slice(&[y[0], y[0] * y[0]]);
        Ok(())
    })
}

/// Forwards and backwards, at the ends of steps and between them, with the errors of some dozens of
/// steps.
#[test]
fn closed_forms() {
    for method in [Method::Adams, Method::Bdf] {
        for rtol in [1e-6, 1e-9] {
            let options = Options::new(method).relative_tolerance(rtol).absolute_tolerance(rtol);
            for sign in [1.0, -1.0] {
                let times: Vec<f64> = (0..=30).map(|i| sign * f64::from(i) / 10.0).collect();
                let (motion, values) = Solve::new(erased(decay()), 0.0, &[1.0])
                    .method(&options)
                    .integrals(moments())
                    .run(&times)
                    .unwrap();
                assert!(motion.is_complete() && values.len() == 31);
                for (t, values) in times.iter().zip(&values) {
                    let exact = [1.0 - (-t).exp(), (1.0 - (-2.0 * t).exp()) / 2.0];
                    for (found, exact) in values.iter().zip(exact) {
                        let off = (found - exact).abs() / exact.abs().max(1.0);
                        assert!(off < 100.0 * rtol, "{method} {rtol} {t}: {found} is not {exact}");
                    }
                }
                assert_eq!(values[0], [0.0, 0.0]);
            }
        }
    }
}

/// Steps are adapted to integrals that vary fast; without error control the motion is as without
/// them.
#[test]
fn error_control() {
    let still = || {
        from_fn(1, |_t, _y: &[f64], ydot: &mut [f64]| {
            ydot[0] = 0.0;
            Ok(())
        })
        .autonomous()
    };
    let wave = || {
        Integrals::new(1, |t: f64, _y, rates| {
            rates[0] = (5.0 * t).cos();
            Ok(())
        })
    };
    let options = Options::new(Method::Adams).relative_tolerance(1e-8).absolute_tolerance(1e-10);
    let run = |integrals: Integrals| {
        let mut cvode =
            Integration::with_integrals(erased(still()), 0.0, &[1.0], &options, integrals).unwrap();
        cvode.state_at(2.0).unwrap();
        (cvode.integrals().unwrap()[0], cvode.statistics().steps)
    };
    let (found, steps) = run(wave());
    assert!((found - 10.0_f64.sin() / 5.0).abs() < 1e-7, "{found}");
    let plain = solve(erased(still()), 0.0, &[1.0], &[2.0], &options).unwrap().statistics().steps;
    let (_, careless) = run(wave().error_control(false));
    assert!(careless <= plain + 1 && steps > 2 * careless, "{steps} {careless} {plain}");
    let (loose, fewer) = run(wave().tolerances(1e-3, 1e-4));
    assert!(fewer < steps && (loose - 10.0_f64.sin() / 5.0).abs() < 1e-2, "{fewer} {loose}");
}

/// The path length of a ball over its bounces: from h it is h, then 2e²h, 2e⁴h, …; also with
/// sensitivities.
#[test]
fn over_events() {
    let (h, g, e) = (1.3_f64, 9.81, 0.8_f64);
    let ball = from_fn(2, move |_t, y: &[f64], ydot: &mut [f64]| {
        ydot.copy_from_slice(&[y[1], -g]);
        Ok(())
    });
    let reset = move |_: f64, y: &mut [f64]| {
        y[1] *= -e;
        Ok(())
    };
    let bounce = FnEvents::new().with_reset(Event::new("bounce").falling(), |_, y| Ok(y[0]), reset);
    let height = Integrals::new(2, |_t, y: &[f64], rates: &mut [f64]| {
        rates.copy_from_slice(&[y[0], y[1] * y[1]]);
        Ok(())
    });
    let options = Options::new(Method::Adams).relative_tolerance(1e-10).absolute_tolerance(1e-12);
    let columns = Sensitivities::new().by_start(0);
    let cvode = Integration::with_sensitivities(erased(ball), 0.0, &[h, 0.0], &options, &columns).unwrap();
    let mut hybrid = cvode.and_integrals(height, &options).unwrap().with_events(bounce).unwrap();
    let w = (2.0 * g * h).sqrt();
    let (first, second) = (w / g, 2.0 * e * w / g);
    let mut before = [0.0; 2];
    for n in 0..4 {
        // The middle of flight n: half a flight that rises to e²ⁿ h, after complete ones.
        let (rise, whole) = (e.powi(n), if n == 0 { 0.0 } else { 1.0 });
        let start = if n == 0 { 0.0 } else { first + second * (1..n).map(|k| e.powi(k - 1)).sum::<f64>() };
        let time = if n == 0 { first / 2.0 } else { rise * w / g };
        hybrid.advance_to(start + time, |_| Continue(())).unwrap();
        let (speed, s) = (rise * w * whole, time);
        let flight = [
            (if n == 0 { h * s } else { speed * s * s / 2.0 }) - g * s.powi(3) / 6.0,
            speed * speed * s - speed * g * s * s + g * g * s.powi(3) / 3.0,
        ];
        let found = hybrid.integrals().unwrap();
        for i in 0..2 {
            let expected = before[i] + flight[i];
            assert!((found[i] - expected).abs() < 1e-7, "{n} {i}: {} is not {expected}", found[i]);
        }
        let s = if n == 0 { first } else { 2.0 * time };
        before[0] += (if n == 0 { h * s } else { speed * s * s / 2.0 }) - g * s.powi(3) / 6.0;
        before[1] += speed * speed * s - speed * g * s * s + g * g * s.powi(3) / 3.0;
    }
}

/// A restart keeps the integrals up to the current time.
#[test]
fn integrals_continue_over_a_restart() {
    let options = Options::new(Method::Bdf).relative_tolerance(1e-10).absolute_tolerance(1e-12);
    let mut cvode = Integration::with_integrals(erased(decay()), 0.0, &[1.0], &options, moments()).unwrap();
    assert_eq!(cvode.integrals().unwrap(), [0.0, 0.0]);
    cvode.state_at(0.77).unwrap(); // inside a step
    let first = cvode.integrals().unwrap()[0];
    cvode.restart(0.77, &[3.0]).unwrap();
    assert_eq!(cvode.integrals().unwrap()[0], first);
    cvode.state_at(1.5).unwrap();
    let expected = 1.0 - (-0.77_f64).exp() + 3.0 * (1.0 - (-0.73_f64).exp());
    assert!((cvode.integrals().unwrap()[0] - expected).abs() < 1e-8);
}

/// On the unit circle by projection: ∫ (y₀² + y₁²) dt = t, since integrands receive projected
/// states.
#[test]
fn of_projected_states() {
    let circle = from_fn(2, |_t, y: &[f64], ydot: &mut [f64]| {
        ydot.copy_from_slice(&[y[1], -y[0]]);
        Ok(())
    })
    .with_projection(|_t, y| {
        let r = y[0].hypot(y[1]);
        y.iter_mut().for_each(|y| *y /= r);
        Ok(())
    });
    let radius = Integrals::new(1, |_t, y, rates| {
        rates[0] = y[0] * y[0] + y[1] * y[1];
        Ok(())
    });
    let mut cvode =
        Integration::with_integrals(erased(circle), 0.0, &[1.0, 0.0], &Options::default(), radius).unwrap();
    cvode.state_at(20.0).unwrap();
    assert!((cvode.integrals().unwrap()[0] - 20.0).abs() < 1e-6);
}

#[test]
fn invalid_integrals_are_refused() {
    let options = Options::default();
    let begin =
        |integrals: Integrals| Integration::with_integrals(erased(decay()), 0.0, &[1.0], &options, integrals);
    let none = Integrals::new(0, |_, _, _| Ok(()));
    assert_eq!(begin(none).unwrap_err().to_string(), "the number of integrals is 0, but must be positive");
    assert!(begin(moments().tolerances(0.0, 1.0)).is_err());
    let mut cvode = begin(moments()).unwrap();
    cvode.state_at(1.0).unwrap();
    let error = cvode.and_integrals(moments(), &options).unwrap_err();
    assert!(matches!(error, SolveError::Input(InputError::NoIntegrals)));
    let mut plain = Integration::new(erased(decay()), 0.0, &[1.0], &options).unwrap();
    assert!(matches!(plain.integrals().unwrap_err(), SolveError::Input(InputError::NoIntegrals)));

    let unwritten = Integrals::new(2, |_, _, rates| {
        rates[0] = 1.0;
        Ok(())
    });
    let error = begin(unwritten).unwrap().state_at(1.0).unwrap_err();
    let SolveError::Integration(error) = error else { panic!("it began") };
    let cause = error.failure.as_ref().map(Failure::cause).unwrap().to_string();
    assert!(cause.starts_with("the rate of integral number 1 (from 0) is NaN at t = "), "{cause}");
    assert!(error.failure.unwrap().cause().is::<NonFinite>());
}

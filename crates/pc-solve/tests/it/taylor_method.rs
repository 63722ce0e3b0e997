//! Taylor's method: motions known in closed form, order, steps and errors.

use std::num::NonZeroU64;
use std::ops::ControlFlow;

use crate::boxed::from_fn;
use crate::fields::{field, heavy_top, oscillator, top_integrals, top_start};
use pc_expr::ProgramField;
use pc_solve::{
    Checkpoint, DenseOutput, InputError, Integration, Method, NoEvents, Options, Reason, Resumable,
    SolveError, Statistics, Taylor,
};

fn options(tolerance: f64) -> Options {
    Options::new(Method::Taylor).relative_tolerance(tolerance).absolute_tolerance(tolerance)
}

fn begin(field: ProgramField, y0: &[f64], tolerance: f64) -> Integration<Taylor<ProgramField>> {
    Integration::of(Taylor::new(field, 0.0, y0, &options(tolerance)).unwrap())
}

fn reason(error: SolveError) -> Reason {
    match error {
        SolveError::Integration(error) => error.reason.clone(),
        other => panic!("{other}"),
    }
}

/// Kepler's motion of eccentricity e from the pericentre, by Newton's iteration on Kepler's
/// equation.
fn kepler(e: f64, t: f64) -> [f64; 2] {
    let mut anomaly = t;
    for _ in 0..50 {
        anomaly -= (anomaly - e * anomaly.sin() - t) / (1.0 - e * anomaly.cos());
    }
    [anomaly.cos() - e, (1.0 - e * e).sqrt() * anomaly.sin()]
}

fn kepler_field() -> ProgramField {
    field(|_, [x, y, u, v]| {
        let r3 = (x * x + y * y).pow(1.5);
        [u, v, -x / r3, -y / r3]
    })
}

const E: f64 = 0.6;

fn kepler_start() -> [f64; 4] {
    [1.0 - E, 0.0, 0.0, ((1.0 + E) / (1.0 - E)).sqrt()]
}

/// The largest error over three revolutions.
fn kepler_error(options: &Options) -> (f64, Statistics) {
    let mut motion = Integration::of(Taylor::new(kepler_field(), 0.0, &kepler_start(), options).unwrap());
    let mut worst = 0.0_f64;
    for i in 1..=60 {
        let t = 0.3 * f64::from(i);
        let (y, expected) = (motion.state_at(t).unwrap(), kepler(E, t));
        worst = worst.max((y[0] - expected[0]).abs()).max((y[1] - expected[1]).abs());
    }
    (worst, motion.statistics())
}

#[test]
fn an_oscillator_is_followed_to_rounding_there_and_back() {
    let mut motion = begin(oscillator(), &[1.0, 0.0], 1e-16);
    for t in [1.0, 10.0, 100.0, 3.0e3, 0.5] {
        if t < motion.time() {
            let (here, y) = (motion.time(), motion.state().to_vec());
            motion.restart(here, &y).unwrap();
        }
        let y = motion.state_at(t).unwrap();
        // The error of the phase is a few roundings of the longest time.
        let bound = 8.0 * f64::EPSILON * 3.0e3;
        assert!((y[0] - t.cos()).abs() < bound && (y[1] + t.sin()).abs() < bound, "{t}: {y:?}");
    }
}

#[test]
fn the_error_follows_the_tolerance_and_the_work_the_square_of_the_digits() {
    let runs: Vec<(f64, f64, Statistics)> = (3..=6)
        .map(|i| 10.0_f64.powi(-2 * i))
        .map(|tolerance| {
            let (error, statistics) = kepler_error(&options(tolerance));
            (tolerance, error, statistics)
        })
        .collect();
    for (tolerance, error, statistics) in &runs {
        // Over three revolutions the errors of some tens of steps grow with the time and with the
        // speed at the pericentre.
        assert!(*error < 3e4 * tolerance, "{tolerance:e}: {error:e}, {statistics:?}");
        assert_eq!(statistics.error_test_failures, 0, "{tolerance:e}");
    }
    let (first, last) = (&runs[0], &runs[runs.len() - 1]);
    let slope = (last.1 / first.1).log10() / (last.0 / first.0).log10();
    assert!((0.75..1.25).contains(&slope), "{slope}");
    // p² products in each step, and a number of steps that hardly depends on the tolerance if p is
    // adapted to it.
    let work = |statistics: &Statistics| statistics.steps as f64 * f64::from(statistics.last_order).powi(2);
    let (ratio, digits) = (work(&last.2) / work(&first.2), 12.0 / 6.0_f64);
    assert!(ratio < 1.5 * digits.powi(2), "{ratio}");
}

#[test]
fn a_step_of_fixed_order_errs_by_the_power_of_its_length() {
    // h ∝ tol^{1/(p+1)}, as the number of steps shows.
    for order in [8, 14] {
        let steps = |tolerance: f64| {
            let mut motion = Integration::of(
                Taylor::new(heavy_top(), 0.0, &top_start(), &options(tolerance).max_order(order)).unwrap(),
            );
            motion.state_at(50.0).unwrap();
            assert_eq!(motion.statistics().last_order, order);
            motion.statistics().steps as f64
        };
        let ratio = steps(1e-13) / steps(1e-9);
        let expected = 1e4_f64.powf(1.0 / f64::from(order + 1));
        assert!((ratio / expected - 1.0).abs() < 0.05, "order {order}: {ratio}, not {expected}");
    }
}

#[test]
fn integrals_stay_at_rounding_over_a_hundred_thousand_steps() {
    let mut motion = begin(heavy_top(), &top_start(), 1e-19);
    let start = top_integrals(&top_start());
    let mut worst = [0.0_f64; 2];
    while motion.statistics().steps < 100_000 {
        motion.step_towards(f64::MAX).unwrap();
        let now = top_integrals(motion.state());
        for i in 0..2 {
            worst[i] = worst[i].max((now[i] - start[i]).abs() / start[i]);
        }
    }
    // The increment of each step, some tenths of the state, has the rounding of f: over 10⁵ steps a
    // random walk of 300 such roundings, which affects the energy less, since this top spins fast
    // about an axis that hardly moves.
    assert!(worst[0] < 5e-15 && worst[1] < 3e-14, "{worst:?}");
}

#[test]
fn a_pole_ends_the_integration_before_it() {
    // ẏ = y²: y = 1/(1 − t)
    let mut motion = begin(field(|_, [y]| [y * y]), &[1.0], 1e-10);
    assert!((motion.state_at(0.9).unwrap()[0] - 10.0).abs() < 1e-7);
    let error = motion.state_at(2.0).unwrap_err();
    assert!(matches!(reason(error), Reason::Stalled | Reason::Rates { .. } | Reason::Overflow { .. }));
    assert!((0.999_999..1.000_001).contains(&motion.time()), "{}", motion.time());
}

#[test]
fn what_is_not_defined_at_the_start_is_named() {
    let mut motion = begin(field(|t, [y]| [y / t]), &[1.0], 1e-10);
    let error = motion.state_at(1.0).unwrap_err();
    let cause = std::error::Error::source(&error).unwrap().to_string();
    assert!(cause.contains("y0/t"), "{cause}");
}

#[test]
fn a_pulse_ahead_is_not_leapt_over() {
    // At rest until t = 5; before that the coefficients of the pulse are about 10⁻²⁷².
    for width in [0.2, 0.01, 1e-4] {
        let pulse = field(|t, [_y]| [(-((t - 5.0) / width).square()).exp()]);
        let mut motion = begin(pulse, &[0.0], 1e-12);
        let y = motion.state_at(10.0).unwrap()[0];
        let expected = width * std::f64::consts::PI.sqrt();
        assert!((y - expected).abs() < 1e-9, "width {width}: {y}, not {expected}");
    }
}

#[test]
fn a_series_with_gaps_is_not_trusted_beyond_its_reach() {
    // y = sin t⁸: most coefficients at 0 vanish, including the last two for many orders.
    for order in [11, 14, 20, 22] {
        let gaps = field(|t, [_y]| [t.powi(7) * 8.0 * t.powi(8).cos()]);
        let mut motion =
            Integration::of(Taylor::new(gaps, 0.0, &[0.0], &options(1e-10).max_order(order)).unwrap());
        let y = motion.state_at(1.5).unwrap()[0];
        let expected = 1.5_f64.powi(8).sin();
        assert!((y - expected).abs() < 1e-7, "order {order}: {y}, not {expected}");
    }
}

#[test]
fn steps_end_at_corners_and_jumps() {
    // ẍ = −sign x from x = 1/2: parabolas, x = 1/2 − t²/2 up to t = 1, with a period of 4.
    let mut motion = begin(field(|_, [x, v]| [v, -x.sign()]), &[0.5, 0.0], 1e-12);
    for (t, expected) in [(0.5, 0.375), (1.5, -0.375), (2.0, -0.5), (3.0, 0.0), (4.0, 0.5), (41.5, -0.375)] {
        let x = motion.state_at(t).unwrap()[0];
        assert!((x - expected).abs() < 1e-12, "{t}: {x}, not {expected}");
    }
    // v̇ = 1 − |v| v from −1 passes through v = 0 at t = π/4: v = tan (t − π/4) before, tanh
    // (t − π/4) after.
    let mut motion = begin(field(|_, [v]| [1.0 - v * v.abs()]), &[-1.0], 1e-13);
    let quarter = std::f64::consts::FRAC_PI_4;
    for (t, expected) in [(0.5, (0.5 - quarter).tan()), (2.0, (2.0 - quarter).tanh())] {
        let v = motion.state_at(t).unwrap()[0];
        assert!((v - expected).abs() < 1e-12, "{t}: {v}, not {expected}");
    }
    motion.restart(2.0, &[(2.0 - quarter).tanh()]).unwrap();
    assert!((motion.state_at(0.0).unwrap()[0] + 1.0).abs() < 1e-11);
    // max(t − 1, 0) and a jump in time, forwards and backwards.
    let ramp = || field(|t, [_x, _y]| [(t - 1.0).max(0.0), (t - 2.0).step(3.0, 1.0)]);
    let mut motion = begin(ramp(), &[0.0, 0.0], 1e-12);
    let y = motion.state_at(3.0).unwrap();
    assert!((y[0] - 2.0).abs() < 1e-12 && (y[1] - 5.0).abs() < 1e-12, "{y:?}");
    let y = y.to_vec();
    motion.restart(3.0, &y).unwrap();
    let y = motion.state_at(0.0).unwrap();
    assert!(y[0].abs() < 1e-12 && y[1].abs() < 1e-12, "{y:?}");
}

#[test]
fn friction_that_holds_is_refused_by_name() {
    let mut motion = begin(field(|_, [v]| [-v.sign()]), &[1.0], 1e-10);
    let error = motion.state_at(2.0).unwrap_err();
    match reason(error) {
        Reason::Sliding { branch, t } => {
            assert!(branch.contains("sign(y0)"), "{branch}");
            assert!((t - 1.0).abs() < 1e-12, "{t}");
        }
        other => panic!("{other:?}"),
    }
    assert!((motion.time() - 1.0).abs() < 1e-9 || motion.time() == 0.0, "{}", motion.time());
}

#[test]
fn fields_that_are_functions_are_refused() {
    let decay = from_fn(1, |_t, y, ydot| {
        ydot[0] = -y[0];
        Ok(())
    });
    let error = Taylor::new(decay, 0.0, &[1.0], &options(1e-9)).err().unwrap();
    let cause = std::error::Error::source(&error).unwrap().to_string();
    assert!(cause.contains("not a function that is called"), "{cause}");
    for (wrong, name) in [
        (options(-1.0), "tolerance"),
        (options(1e-9).max_order(100), "order"),
        (options(1e-9).max_step(0.0), "step"),
    ] {
        let error = Taylor::new(oscillator(), 0.0, &[1.0, 0.0], &wrong).unwrap_err();
        assert!(matches!(error, SolveError::Input(_)) && error.to_string().contains(name), "{error}");
    }
    let error = Taylor::new(oscillator(), 0.0, &[1.0], &options(1e-9)).unwrap_err();
    assert!(matches!(error, SolveError::Input(InputError::Length { .. })), "{error}");
}

#[test]
fn the_longest_step_and_the_stop_time_are_kept() {
    let mut motion = Integration::of(
        Taylor::new(oscillator(), 0.0, &[1.0, 0.0], &options(1e-12).max_step(0.125)).unwrap(),
    );
    motion.set_stop_time(Some(1.0)).unwrap();
    while motion.time() < 1.0 {
        let before = motion.time();
        let after = motion.step_towards(1.0).unwrap();
        assert!(after - before <= 0.125 + 1e-9 && after <= 1.0, "{before} to {after}");
    }
    assert_eq!(motion.time(), 1.0);
    assert!((motion.state()[0] - 1.0_f64.cos()).abs() < 1e-12);
}

#[test]
fn the_polynomials_are_the_motion_between_the_ends() {
    let mut motion = begin(oscillator(), &[1.0, 0.0], 1e-14);
    let mut dense = DenseOutput::default();
    let go_on = |_: &_| ControlFlow::Continue(());
    motion
        .run_dense(
            20.0,
            |segment| {
                dense.extend([segment]);
                ControlFlow::Continue(())
            },
            go_on,
        )
        .unwrap();
    for i in 0..=200 {
        let t = 0.1 * f64::from(i);
        let (state, rate) = (dense.evaluate(t).unwrap(), dense.derivative(t).unwrap());
        assert!((state[0] - t.cos()).abs() < 1e-12, "{t}: {state:?}");
        assert!((rate[0] + t.sin()).abs() < 1e-11, "{t}: {rate:?}");
    }
}

#[test]
fn a_resumed_motion_has_the_same_bits() {
    let times = [3.0, 7.0, 20.0, 33.3];
    let parts = || (heavy_top(), NoEvents);
    let mut kept = Vec::new();
    let start = Checkpoint::start(0.0, &top_start());
    let every = NonZeroU64::new(7).unwrap();
    let go_on = |_: f64, _: &[f64]| ControlFlow::Continue(());
    let save = |checkpoint: &Checkpoint, _| kept.push(checkpoint.clone());
    let whole =
        Resumable::new(parts, start).method(&options(1e-12)).every(every).run(&times, save, go_on).unwrap();
    assert!(kept.len() > 10);
    for checkpoint in kept {
        let (checkpoint, _) = Checkpoint::from_bytes(&checkpoint.to_bytes("top")).unwrap();
        let part = Resumable::new(parts, checkpoint)
            .method(&options(1e-12))
            .every(every)
            .run(&times, |_, _| (), go_on)
            .unwrap();
        assert_eq!(part, whole);
    }
    let mut plain = begin(heavy_top(), &top_start(), 1e-12);
    let end = plain.state_at(33.3).unwrap();
    let (_, last) = whole.trajectory.last().unwrap();
    // The top magnifies errors some thousand times.
    assert!(end.iter().zip(last).all(|(a, b)| (a - b).abs() < 1e-8), "{end:?} {last:?}");
}

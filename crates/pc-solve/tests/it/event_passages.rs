//! Which zeros of a function are passages, and when they accumulate.

use std::ops::ControlFlow::Continue;

use crate::boxed::erased;
use crate::fields::field;
use pc_expr::ProgramField;
use pc_solve::{Accumulation, Event, FnEvents, Method, Options, Reason, Solve, SolveError};
use proptest::prelude::*;

fn clock() -> ProgramField {
    field(|_, [_y]| [1.0.into()])
}

/// The zeros found of a function of the clock y = t, from `start` to `end`.
fn passages(function: impl Fn(f64) -> f64, start: f64, end: f64, options: &Options) -> Vec<f64> {
    let events = FnEvents::new().with(Event::new("zero"), move |_, y| Ok(function(y[0])));
    let motion =
        Solve::new(erased(clock()), start, &[start]).method(options).events(events).run(&[end]).unwrap();
    motion.occurrences.iter().map(|occurrence| occurrence.time).collect()
}

fn is_near(found: &[f64], expected: &[f64], tolerance: f64) -> bool {
    found.len() == expected.len() && found.iter().zip(expected).all(|(a, b)| (a - b).abs() <= tolerance)
}

/// For several forms of the function, and whether or not a step hits the first zero exactly.
#[test]
fn a_zero_after_one_that_is_hit_exactly_is_found() {
    for method in Method::ALL {
        let options = Options::new(method);
        let found = passages(|y| (y - 5.0) * (5.01 - y), 0.0, 10.0, &options);
        assert!(is_near(&found, &[5.0, 5.01], 1e-13), "{method}: {found:?}");
        let found = passages(|y| 0.005f64.powi(2) - (y - 5.005).powi(2), 0.0, 10.0, &options);
        // The square is that of 5e-3: its rounding moves the zero by 1e-14 · 5e-3, and y has
        // rounding.
        assert!(is_near(&found, &[5.0, 5.01], 1e-13), "{method}: {found:?}");
    }
}

/// Second passages from 1e-3 to 1e-5 after first ones throughout the interval.
#[test]
fn passages_close_to_each_other_are_both_found() {
    for method in Method::ALL {
        let mut lost = 0;
        for k in 0..600 {
            let first = 10.0 * (0.618_033_988_749_894_8 * f64::from(k + 1)).fract();
            let apart = 10.0f64.powf(-3.0 - 2.0 * (0.414_213_562_373_095 * f64::from(k)).fract());
            // Every third one at a time that steps hit.
            let first = if k % 3 == 0 { (8.0 * first).round() / 8.0 + 0.125 } else { first };
            let found = passages(|y| (y - first) * (first + apart - y), 0.0, 12.0, &Options::new(method));
            lost += usize::from(!is_near(&found, &[first, first + apart], 1e-12));
        }
        assert_eq!(lost, 0, "{method}");
    }
}

/// A function that reaches zero and returns does not pass; one that stays there passes on arrival.
#[test]
fn touches_are_not_passages() {
    for (method, at) in Method::ALL.into_iter().flat_map(|m| [0.3, 1.0, 2.5, 5.0].map(|at| (m, at))) {
        // Exact at the zero, and nowhere below it. Taylor's step covers the whole motion, and a
        // closure is only sampled.
        let free = (method != Method::Taylor).then(|| Options::new(method));
        for options in free.into_iter().chain([Options::new(method).max_step(at / 8.0)]) {
            let none = [0.0; 0];
            assert_eq!(passages(|y| (y - at).abs(), 0.0, 10.0, &options), none, "{method}, {at}");
            assert_eq!(passages(|y| (y - at).powi(2), 0.0, 10.0, &options), none, "{method}, {at}");
            assert_eq!(passages(|y| -(y - at).powi(4), 0.0, 10.0, &options), none, "{method}, {at}");
            let stays = passages(|y| (at - y).max(0.0), 0.0, 10.0, &options);
            assert!(is_near(&stays, &[at], 1e-14), "{method}, {at}: {stays:?}");
            // It stays at zero for a while, then continues to the other side, or returns and passes
            // later.
            let through = |y: f64| (at - y).max(0.0) + (at + 1.0 - y).min(0.0);
            let found = passages(through, 0.0, 10.0, &options);
            assert!(is_near(&found, &[at], 1e-14), "{method}, {at}: {found:?}");
            let back = |y: f64| (at - y).max(0.0) + (y - at - 1.0).max(0.0) - 2.0 * (y - at - 2.0).max(0.0);
            let found = passages(back, 0.0, 10.0, &options);
            assert!(is_near(&found, &[at, at + 3.0], 1e-13), "{method}, {at}: {found:?}");
        }
    }
}

/// A function that touches zero where another one passes does not hide the passage.
#[test]
fn a_touch_hides_no_passage() {
    for method in Method::ALL {
        let events = FnEvents::new()
            .with(Event::new("touch"), |_, y| Ok((y[0] - 5.0).abs()))
            .with(Event::new("pass"), |_, y| Ok(y[0] - 5.0))
            .with(Event::new("later"), |_, y| Ok(5.001 - y[0]));
        let options = Options::new(method);
        let motion =
            Solve::new(erased(clock()), 0.0, &[0.0]).method(options).events(events).run(&[10.0]).unwrap();
        let found: Vec<usize> = motion.occurrences.iter().map(|occurrence| occurrence.event).collect();
        assert_eq!(found, [1, 2], "{method}");
    }
}

/// Sampling finds pairs of zeros farther apart than two parts of a step.
#[test]
fn a_step_is_sampled_as_densely_as_requested() {
    let wave = |y: f64| (40.0 * y + 0.1).sin();
    let expected: Vec<f64> = (1..127).map(|n| (f64::from(n) * std::f64::consts::PI - 0.1) / 40.0).collect();
    let expected: Vec<f64> = expected.into_iter().filter(|t| *t < 9.9).collect();
    for method in Method::ALL {
        let options = |samples| Options::new(method).initial_step(1.0).samples_per_step(samples);
        let found = passages(wave, 0.0, 9.9, &options(1000));
        assert!(is_near(&found, &expected, 1e-12), "{method}: {}", found.len());
        let few = passages(wave, 0.0, 9.9, &options(1));
        let lost = expected.len() - few.len();
        assert!(lost > 0 && lost.is_multiple_of(2), "{method}: {}", few.len());
        let none =
            Solve::new(erased(clock()), 0.0, &[0.0]).method(&options(0)).events(FnEvents::new()).run(&[1.0]);
        assert!(none.is_err(), "{method}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 256, rng_seed: proptest::test_runner::RngSeed::Fixed(16), ..ProptestConfig::default() })]

    /// A piecewise polynomial with these zeros, scaled by a positive number in each piece between
    /// breaks. In steps shorter than the distance of two zeros all are found, and nothing else.
    #[test]
    fn zeros_of_piecewise_polynomials_are_found(
        gaps in prop::collection::vec(0.05..1.0_f64, 1..12),
        exact in prop::collection::vec(any::<bool>(), 12),
        scales in prop::collection::vec(-3.0..3.0_f64, 13),
        samples in 1_u32..8,
    ) {
        let mut zeros = Vec::new();
        let mut t = 0.0;
        for (gap, exact) in gaps.iter().zip(&exact) {
            t += gap;
            // Some lie at the ends of steps.
            t = if *exact { (t * 64.0).ceil() / 64.0 } else { t };
            zeros.push(t);
        }
        let function = |y: f64| {
            let piece = zeros.iter().filter(|&&zero| zero + 0.02 < y).count();
            10.0_f64.powf(scales[piece]) * zeros.iter().map(|zero| y - zero).product::<f64>()
        };
        for method in Method::ALL {
            let options = Options::new(method).max_step(1.0 / 64.0).samples_per_step(samples);
            let found = passages(function, 0.0, t + 0.5, &options);
            prop_assert!(is_near(&found, &zeros, 1e-13), "{}: {:?} {:?}", method, found, zeros);
        }
    }
}

/// Located to 1e-15 of the time if the function is exact.
#[test]
fn passages_are_located_to_rounding() {
    for scale in [1e-6, 1.0, 1e6] {
        for k in 0..50 {
            let at = scale * (0.1 + (0.618_033_988_749_894_8 * f64::from(k)).fract());
            for method in Method::ALL {
                let events = FnEvents::new().with(Event::new("then"), move |t, _| Ok(t - at));
                let motion = Solve::new(erased(clock()), 0.0, &[0.0])
                    .method(Options::new(method))
                    .events(events)
                    .run(&[2.0 * scale]);
                let found = motion.unwrap().occurrences[0].time;
                assert!((found - at).abs() <= 1e-15 * at, "{method}: {found} for {at}");
            }
        }
    }
}

/// A ball that bounces with e = ½ and is kicked up again when it is slow, so that no bounce is the
/// last.
fn kicked(below: f64) -> FnEvents<'static> {
    FnEvents::new().with_reset(
        Event::new("bounce").falling(),
        |_, y| Ok(y[0]),
        move |_, y| {
            y[1] = if y[1] > -below { 1.0 } else { -0.5 * y[1] };
            Ok(())
        },
    )
}

fn ball() -> ProgramField {
    field(|_, [_y, v]| [v, (-1.0).into()])
}

/// Whether bounces accumulate does not depend on the duration of the motion.
#[test]
fn bounces_with_a_kick_do_not_accumulate() {
    let start = 2e4;
    for (method, t0) in Method::ALL.into_iter().flat_map(|method| [(method, 0.0), (method, -start)]) {
        let options = Options::new(method).max_steps(u64::MAX);
        let kicked = Solve::new(erased(ball()), t0, &[1.0, 0.0]).method(options).events(kicked(0.01));
        let mut bounces = 0_u32;
        kicked
            .start()
            .unwrap()
            .advance_to(t0 + start, |_| {
                bounces += 1;
                Continue(())
            })
            .unwrap();
        assert!(bounces > 10_000, "{method}");
    }
    // A ball that comes to rest is recognised after any time.
    for (method, flights) in Method::ALL.into_iter().flat_map(|method| [(method, 0), (method, 2000)]) {
        let mut left = flights;
        let events = FnEvents::new().with_reset(
            Event::new("bounce").falling(),
            |_, y| Ok(y[0]),
            move |_, y| {
                y[1] *= if left > 0 { -1.0 } else { -0.5 };
                left -= i32::from(left > 0);
                Ok(())
            },
        );
        let options = Options::new(method).relative_tolerance(1e-13).absolute_tolerance(1e-15);
        let failure = Solve::new(erased(ball()), 0.0, &[1.0, 0.0])
            .method(&options)
            .events(events)
            .run(&[1e6])
            .unwrap_err();
        let SolveError::Integration(error) = failure.error else { panic!("{}", failure.error) };
        let Reason::Accumulation { t, .. } = error.reason else { panic!("{method}: {error}") };
        let limit = 2.0_f64.sqrt() * (3.0 + 2.0 * f64::from(flights));
        // The extrapolated remainder of 1e-5 flights, and the errors of so many bounces.
        assert!((t - limit).abs() < 1e-8 * limit, "{method}: {t} is not {limit}");
    }
}

/// The rule is set in the options, for all ways of running.
#[test]
fn the_accumulation_fraction_can_be_chosen() {
    for method in Method::ALL {
        let run = |within| {
            let accumulation = Accumulation { within, ..Accumulation::default() };
            let options = Options::new(method).accumulation(accumulation);
            Solve::new(erased(ball()), 0.0, &[1.0, 0.0]).method(&options).events(kicked(1e-4)).run(&[30.0])
        };
        assert!(run(0.1).is_err() && run(1e-5).is_ok() && run(0.0).is_ok(), "{method}");
        assert!(run(1.0).is_err() && run(-1.0).is_err() && run(f64::NAN).is_err(), "{method}");
    }
}

/// A reset that leaves the function within the tolerances of zero, even on the wrong side, does not
/// repeat the event.
#[test]
fn an_event_does_not_occur_again_before_it_has_left() {
    for off in [0.0, 1e-15, -1e-15, 1e-12, -1e-12, 3e-12, -3e-12] {
        let cases = Method::ALL.into_iter().flat_map(|method| [(method, -0.5), (method, 0.5)]);
        for (method, restitution) in cases {
            // Falling through a curtain, or bouncing off it, each with a small displacement.
            let events = FnEvents::new().with_reset(
                Event::new("curtain").falling(),
                |_, y| Ok(y[0]),
                move |_, y| {
                    y[0] += off;
                    y[1] *= restitution;
                    Ok(())
                },
            );
            let motion = Solve::new(erased(ball()), 0.0, &[1.0, 0.0])
                .method(Options::new(method))
                .events(events)
                .run(&[2.0])
                .unwrap();
            assert_eq!(motion.occurrences.len(), 1, "{method}: {off} {restitution}");
        }
    }
}

//! Events: times against closed forms, order, resets, directions.

use std::cell::RefCell;
use std::ops::ControlFlow::{Break, Continue};

use crate::boxed::{erased, from_fn};
use crate::fields;
use pc_expr::ProgramField;
use pc_solve::{
    Accumulation, Code, Cvode, Ending, Event, Events, Failure, FnEvents, Integration, Method, Observed,
    Occurrence, Options, Reason, Solve, SolveError, VectorField,
};

/// Tolerances at which the error of the integration is below that required of the times.
fn sharp(method: Method) -> Options {
    Options::new(method).relative_tolerance(1e-13).absolute_tolerance(1e-15)
}

fn field(rates: fn(f64, &[f64]) -> Vec<f64>, dim: usize) -> impl VectorField + Clone {
    pc_solve::from_fn(dim, move |t, y: &[f64], ydot: &mut [f64]| {
        ydot.copy_from_slice(&rates(t, y));
        Ok(())
    })
}

fn falling() -> ProgramField {
    fields::field(|_, [_y, v]| [v, (-1.0).into()])
}

fn oscillator() -> ProgramField {
    fields::oscillator()
}

/// The methods for fields that are closures.
const FOR_CLOSURES: [Method; 4] = [Method::Adams, Method::Bdf, Method::Dop853, Method::Auto];

fn bounce(restitution: f64) -> FnEvents<'static> {
    FnEvents::new().with_reset(
        Event::new("bounce").falling(),
        |_, y| Ok(y[0]),
        move |_, y| {
            y[1] *= -restitution;
            Ok(())
        },
    )
}

fn times(occurrences: &[Occurrence]) -> Vec<f64> {
    occurrences.iter().map(|occurrence| occurrence.time).collect()
}

fn integration(error: SolveError) -> pc_solve::IntegrationError {
    match error {
        SolveError::Integration(error) => *error,
        other => panic!("{other}"),
    }
}

/// From height 1 under gravity 1 a ball first lands at √2, and flight n takes 2√2 eⁿ. The motion is
/// a polynomial of degree 2, for which the methods are exact up to rounding of the location, 1e-15
/// of the time, and of the speeds.
#[test]
fn a_ball_bounces_when_it_should() {
    for method in Method::ALL {
        for restitution in [0.5_f64, 0.9] {
            let outputs: Vec<f64> = (1..=40).map(|i| f64::from(i) * 0.1).collect();
            let motion = Solve::new(erased(falling()), 0.0, &[1.0, 0.0])
                .method(&sharp(method))
                .events(bounce(restitution))
                .run(&outputs)
                .unwrap();
            assert_eq!(motion.ending, Some(Ending::Completed));
            let mut landing = 2.0_f64.sqrt();
            let mut flight = 2.0 * landing * restitution;
            let mut expected = Vec::new();
            while landing < 4.0 {
                expected.push(landing);
                landing += flight;
                flight *= restitution;
            }
            assert_eq!(motion.occurrences.len(), expected.len());
            for (occurrence, expected) in motion.occurrences.iter().zip(&expected) {
                assert!((occurrence.time - expected).abs() < 1e-11 * expected, "{method}: {expected}");
                assert!(occurrence.state_before[1] < 0.0);
                assert_eq!(occurrence.state_after[1], -restitution * occurrence.state_before[1]);
            }
            // Outputs lie on the parabolas in between.
            for (t, y) in motion.trajectory.iter() {
                let n = expected.iter().take_while(|&&landing| landing <= t).count();
                let height = match n {
                    0 => 1.0 - t * t / 2.0,
                    n => {
                        let since = t - expected[n - 1];
                        let up = 2.0_f64.sqrt() * restitution.powi(i32::try_from(n).unwrap());
                        up * since - since * since / 2.0
                    }
                };
                assert!((y[0] - height).abs() < 1e-10, "{method}: {} at {t}, not {height}", y[0]);
            }
        }
    }
}

/// The bounces accumulate at √2 (1 + 2e/(1 − e)).
#[test]
fn bounces_that_accumulate_are_an_error_with_their_limit() {
    // Without BDF, whose speeds have errors of 1e-8 after so many starts at order 1.
    let methods = [Method::Adams, Method::Dop853, Method::Taylor, Method::Auto];
    for (method, restitution) in methods.into_iter().flat_map(|m| [0.1, 0.5, 0.9].map(|e| (m, e))) {
        let failure = Solve::new(erased(falling()), 0.0, &[1.0, 0.0])
            .method(&sharp(method))
            .events(bounce(restitution))
            .run(&[1.0, 100.0])
            .unwrap_err();
        let limit = 2.0_f64.sqrt() * (1.0 + 2.0 * restitution / (1.0 - restitution));
        assert_eq!(failure.reached.trajectory.times(), [1.0]);
        assert!(failure.reached.occurrences.len() > 5);
        assert!(failure.reached.ending.is_none());
        let error = integration(failure.error);
        let text = error.to_string();
        let Reason::Accumulation { event, occurrences, t } = error.reason else { panic!("{method}: {text}") };
        assert_eq!((event.as_str(), occurrences), ("bounce", failure.reached.occurrences.len() as u64));
        // The remainder, at most 1e-5 of the first flight, is extrapolated from flights whose
        // heights the tolerances hardly resolve.
        assert!((t - limit).abs() < 1e-8 * limit, "{method}, {restitution}: {t} is not {limit}");
        assert!(error.time <= t && t - error.time <= 1e-5 * 2.0 * 2.0_f64.sqrt() * restitution);
        assert!(text.starts_with("the event bounce occurs at ever shorter intervals near t = "), "{text}");
    }
    // A user-defined limit.
    let hybrid = Integration::new(erased(falling()), 0.0, &[1.0, 0.0], &Options::default()).unwrap();
    let mut hybrid =
        hybrid.with_events(bounce(0.5)).unwrap().accumulation(Accumulation { occurrences: 4, within: 0.25 });
    let error = hybrid.advance_to(5.0, |_| Continue(())).unwrap_err();
    assert!(matches!(integration(error).reason, Reason::Accumulation { occurrences: 4, .. }));
}

/// cos t vanishes at (n + 1/2)π: all zeros, falling ones and rising ones, forwards and backwards,
/// without a change of state.
#[test]
fn zeros_are_found_once_in_their_direction() {
    let half = std::f64::consts::FRAC_PI_2;
    for method in Method::ALL {
        for end in [30.0, -30.0] {
            let events = FnEvents::new()
                .with(Event::new("both"), |_, y| Ok(y[0]))
                .with(Event::new("rising").rising(), |_, y| Ok(y[0]))
                .with(Event::new("falling").falling(), |_, y| Ok(y[0]));
            let motion = Solve::new(erased(oscillator()), 0.0, &[1.0, 0.0])
                .method(&sharp(method))
                .events(events)
                .run(&[end])
                .unwrap();
            let of = |event| motion.occurrences.iter().filter(move |o| o.event == event).collect::<Vec<_>>();
            let expected: Vec<f64> = (0..10).map(|n| (f64::from(2 * n + 1) * half).copysign(end)).collect();
            for (event, from, by) in [(0, 0, 1), (1, 1, 2), (2, 0, 2)] {
                let found = of(event);
                let expected: Vec<f64> =
                    expected.iter().copied().skip(from).step_by(by).filter(|t| t.abs() < 30.0).collect();
                assert_eq!(found.len(), expected.len(), "{method}: {found:?}");
                for (found, expected) in found.iter().zip(&expected) {
                    // The error of the integration at rtol 1e-13, over some hundreds of steps.
                    assert!((found.time - expected).abs() < 1e-10, "{method}: {} {expected}", found.time);
                    assert_eq!(found.state_before, found.state_after);
                }
            }
        }
    }
}

/// Functions of time alone, so that only the location has an error, at most 1e-12 of the time.
#[test]
fn a_time_is_located_to_rounding() {
    for (method, end) in FOR_CLOSURES.into_iter().flat_map(|m| [1.0, 1e6, 1e-6].map(|end| (m, end))) {
        for part in [0.1234567, 0.5, 0.999] {
            let at = part * end;
            for function in [
                Box::new(move |t: f64| t - at) as Box<dyn Fn(f64) -> f64>,
                Box::new(move |t: f64| ((t - at) / at).powi(3)),
                Box::new(move |t: f64| (50.0 * (t - at) / at).exp_m1()),
                Box::new(move |t: f64| if t < at { -1e-30 } else { 1e30 }),
            ] {
                let events = FnEvents::new().with(Event::new("then"), move |t, _| Ok(function(t)));
                let still = field(|_, _| vec![0.0], 1);
                let motion = Solve::new(erased(still), 0.0, &[1.0])
                    .method(Options::new(method))
                    .events(events)
                    .run(&[end])
                    .unwrap();
                let found = times(&motion.occurrences);
                assert_eq!(found.len(), 1, "{method}: {end} {part}");
                assert!((found[0] - at).abs() <= 1e-12 * at, "{method}: {} is not {at}", found[0]);
            }
        }
    }
}

#[test]
fn a_function_that_is_zero_at_the_start_has_to_leave_first() {
    for method in Method::ALL {
        // sin t leaves zero at once and returns at π.
        let events = FnEvents::new().with(Event::new("zero"), |_, y| Ok(y[0]));
        let motion = Solve::new(erased(oscillator()), 0.0, &[0.0, 1.0])
            .method(&sharp(method))
            .events(events)
            .run(&[4.0])
            .unwrap();
        let found = times(&motion.occurrences);
        let is_found = found.len() == 1 && (found[0] - std::f64::consts::PI).abs() < 1e-11;
        assert!(is_found, "{method}: {found:?}");
        // A function that is always zero has no event.
        let events = FnEvents::new().with(Event::new("nothing"), |_, _| Ok(0.0));
        let motion = Solve::new(erased(oscillator()), 0.0, &[0.0, 1.0])
            .method(Options::new(method))
            .events(events)
            .run(&[4.0])
            .unwrap();
        assert!(motion.occurrences.is_empty());
    }
}

/// y = (t − 1)² − depth: no event above zero, two close ones below, found within steps that begin
/// and end above.
#[test]
fn grazing_functions_cause_no_event() {
    for method in FOR_CLOSURES {
        for (depth, expected) in [(-1e-6, 0), (1e-4, 2), (1e-8, 2), (1e-12, 2)] {
            let f: f64 = depth;
            let events = FnEvents::new().with(Event::new("graze"), move |_, y| Ok(y[0] - f));
            let parabola = field(|t, _| vec![2.0 * (t - 1.0)], 1);
            let motion = Solve::new(erased(parabola), 0.0, &[1.0])
                .method(&sharp(method))
                .events(events)
                .run(&[3.0])
                .unwrap();
            let found = times(&motion.occurrences);
            assert_eq!(found.len(), expected, "{method}: {depth} {found:?}");
            for (found, expected) in found.iter().zip([1.0 - depth.abs().sqrt(), 1.0 + depth.abs().sqrt()]) {
                // The error of y is a few rtol = 1e-13, that of t the same over ẏ = 2√depth.
                assert!((found - expected).abs() < 4e-13 / depth.abs().sqrt(), "{found} {expected}");
            }
        }
    }
}

/// Three functions that vanish together, with different rounding, and one a little later.
#[test]
fn simultaneous_events_are_handled_in_order() {
    let seen = RefCell::new(Vec::new());
    let add = |amount: f64| {
        let seen = &seen;
        move |_: f64, y: &mut [f64]| {
            seen.borrow_mut().push(y[1]);
            y[1] = 10.0 * y[1] + amount;
            Ok(())
        }
    };
    let events = FnEvents::new()
        .with_reset(Event::new("a"), |_, y| Ok(y[0] / 3.0 - 0.1), add(1.0))
        .with_reset(Event::new("late"), |_, y| Ok(y[0] - 0.300_001), add(4.0))
        .with_reset(Event::new("b"), |_, y| Ok((0.3 - y[0]) * 1e9), add(2.0))
        .with_reset(Event::new("c").rising(), |_, y| Ok((y[0] - 0.3).powi(3)), add(3.0))
        .with_reset(Event::new("not").falling(), |_, y| Ok(y[0] - 0.3), add(5.0));
    let clock = field(|_, _| vec![1.0, 0.0], 2);
    let motion = Solve::new(erased(clock), 0.0, &[0.0, 0.0])
        .method(&Options::default())
        .events(events)
        .run(&[0.3, 1.0])
        .unwrap();
    let order: Vec<usize> = motion.occurrences.iter().map(|occurrence| occurrence.event).collect();
    assert_eq!(order, [0, 2, 3, 1]);
    assert_eq!(*seen.borrow(), [0.0, 1.0, 12.0, 123.0]);
    let states: Vec<(f64, f64)> =
        motion.occurrences.iter().map(|o| (o.state_before[1], o.state_after[1])).collect();
    assert_eq!(states, [(0.0, 1.0), (1.0, 12.0), (12.0, 123.0), (123.0, 1234.0)]);
    assert_eq!(motion.occurrences[0].time, motion.occurrences[2].time);
}

/// Outputs before, at and after a jump; the output at its time is y⁺.
#[test]
fn outputs_at_events() {
    let jump = || {
        FnEvents::new().with_reset(
            Event::new("jump"),
            |t, _| Ok(t - 0.5),
            |_, y| {
                y[0] += 10.0;
                Ok(())
            },
        )
    };
    for (end, direction) in [(1.0, 1.0), (0.0, -1.0)] {
        let outputs = [0.5 - 1e-9 * direction, 0.5, 0.5 + 1e-9 * direction, end];
        let clock = field(|_, _| vec![1.0], 1);
        let start = 1.0 - end;
        let motion = Solve::new(erased(clock), start, &[start])
            .method(&Options::default())
            .events(jump())
            .run(&outputs)
            .unwrap();
        let at = motion.occurrences[0].time;
        assert!((at - 0.5).abs() < 1e-15, "{at}");
        let shift: Vec<f64> = motion.trajectory.iter().map(|(t, y)| y[0] - t).collect();
        let after = if (at - 0.5) * direction <= 0.0 { 10.0 } else { 0.0 };
        for (shift, expected) in shift.iter().zip([0.0, after, 10.0, 10.0]) {
            assert!((shift - expected).abs() < 1e-13, "{shift} {expected}");
        }
    }
    // A jump at the end is part of the motion.
    let clock = field(|_, _| vec![1.0], 1);
    let motion = Solve::new(erased(clock), 0.0, &[0.0])
        .method(&Options::default())
        .events(jump())
        .run(&[0.25, 0.5])
        .unwrap();
    assert_eq!((motion.occurrences.len(), motion.trajectory.state(1)[0]), (1, 10.5));
}

#[test]
fn a_terminal_event_is_the_last_output() {
    for method in Method::ALL {
        let events = FnEvents::new()
            .with(Event::new("other"), |t, _| Ok(t - 0.5))
            .with(Event::new("floor").falling().terminal(true), |_, y| Ok(y[0]));
        let motion = Solve::new(erased(falling()), 0.0, &[1.0, 0.0])
            .method(&sharp(method))
            .events(events)
            .run(&[0.0, 1.0, 2.0, 3.0])
            .unwrap();
        assert_eq!(motion.ending, Some(Ending::Event { event: 1 }));
        assert!(!motion.trajectory.is_complete());
        let landing = 2.0_f64.sqrt();
        let found = motion.trajectory.times();
        assert_eq!(found[..2], [0.0, 1.0]);
        assert!(found.len() == 3 && (found[2] - landing).abs() < 1e-13, "{method}: {found:?}");

        // It can continue from there, and does not meet the event again.
        let events = FnEvents::new().with(Event::new("floor").terminal(true), |_, y| Ok(y[0]));
        let start = Solve::new(erased(falling()), 0.0, &[1.0, 0.0]).method(sharp(method)).events(events);
        let mut hybrid = start.start().unwrap();
        assert_eq!(hybrid.advance_to(3.0, |_| Continue(())).unwrap(), Ending::Event { event: 0 });
        assert!((hybrid.time() - landing).abs() < 1e-12, "{method}");
        assert_eq!(hybrid.advance_to(3.0, |_| Continue(())).unwrap(), Ending::Completed);
        assert!((hybrid.state()[0] + 3.5).abs() < 1e-11, "{method}");
    }
}

#[test]
fn observers_may_stop() {
    let mut hybrid = Integration::new(erased(falling()), 0.0, &[1.0, 0.0], &Options::default())
        .unwrap()
        .with_events(bounce(0.9))
        .unwrap();
    assert_eq!(hybrid.advance_to(9.0, |_| Break(())).unwrap(), Ending::Stopped);
    assert!((hybrid.time() - 2.0_f64.sqrt()).abs() < 1e-9 && hybrid.state()[1] > 0.0);
    let mut steps = 0;
    let ending = hybrid.run_observed(
        &[3.0],
        Observed::new(|_, _| Continue(())).occurrences(|_| Continue(())).steps(|t, _| {
            steps += 1;
            if t > 2.0 { Break(()) } else { Continue(()) }
        }),
    );
    assert_eq!(ending.unwrap(), Ending::Stopped);
    assert!(steps > 1 && hybrid.time() > 2.0);
    let since = hybrid.time() - 2.0_f64.sqrt();
    let height = 0.9 * 2.0_f64.sqrt() * since - since * since / 2.0;
    assert!((hybrid.state()[0] - height).abs() < 1e-7);
}

/// The work before restarts is counted, and each evaluation of the field.
#[test]
fn statistics_continue_over_restarts() {
    for method in FOR_CLOSURES {
        let calls = std::cell::Cell::new(0);
        let counted = from_fn(2, |_, y: &[f64], ydot: &mut [f64]| {
            calls.set(calls.get() + 1);
            ydot.copy_from_slice(&[y[1], -1.0]);
            Ok(())
        });
        let motion = Solve::new(erased(counted), 0.0, &[1.0, 0.0])
            .method(&Options::new(method))
            .events(bounce(0.5))
            .run(&[4.0])
            .unwrap();
        assert_eq!(motion.trajectory.statistics().rhs_evaluations, calls.get());
    }
}

/// Options persist over a restart: initial step, maximum step, and no evaluation beyond the end.
#[test]
fn options_stay_over_restarts() {
    for method in FOR_CLOSURES {
        let farthest = std::cell::Cell::new(0.0_f64);
        let fall = from_fn(2, |t: f64, y: &[f64], ydot: &mut [f64]| {
            farthest.set(farthest.get().max(t));
            ydot.copy_from_slice(&[y[1], -1.0]);
            Ok(())
        });
        let options = Options::new(method).initial_step(1e-6).max_step(0.01).stop_time(3.0);
        let start = Solve::new(erased(fall), 0.0, &[1.0, 0.0]).method(options).events(bounce(0.5));
        let mut hybrid = start.start().unwrap();
        let mut ends = vec![0.0];
        let landing = 2.0_f64.sqrt();
        hybrid
            .run_observed(
                &[3.0],
                Observed::new(|_, _| Continue(())).occurrences(|_| Continue(())).steps(|t, _| {
                    ends.push(t);
                    Continue(())
                }),
            )
            .unwrap();
        let lengths: Vec<f64> = ends.windows(2).map(|pair| pair[1] - pair[0]).collect();
        assert!(lengths.iter().all(|&length| length <= 0.01 * (1.0 + 1e-12)), "{method}");
        // The default tolerances leave BDF an error of some 1e-9 there, much less than the step.
        let after = ends.iter().position(|&t| (t - landing).abs() < 1e-7).unwrap();
        assert!((lengths[after] - 1e-6).abs() < 1e-12, "{method}: {}", lengths[after]);
        assert_eq!(farthest.get(), 3.0);
    }
}

/// A plane pendulum, projected to its circle, bounces off the vertical: functions and resets
/// receive states on the circle, and the motion continues on it.
#[test]
fn projected_states() {
    #[derive(Clone)]
    struct Circle;
    impl VectorField for Circle {
        fn dim(&self) -> usize {
            4
        }
        fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
            let pull = (y[2] * y[2] + y[3] * y[3] - y[1]) / (y[0] * y[0] + y[1] * y[1]);
            ydot.copy_from_slice(&[y[2], y[3], -pull * y[0], -1.0 - pull * y[1]]);
            Ok(())
        }
        fn has_projection(&self) -> bool {
            true
        }
        fn project(&mut self, _t: f64, y: &mut [f64]) -> Result<(), Failure> {
            let length = y[0].hypot(y[1]);
            let (x, z) = (y[0] / length, y[1] / length);
            let along = x * y[3] - z * y[2];
            y.copy_from_slice(&[x, z, -along * z, along * x]);
            Ok(())
        }
    }
    for method in FOR_CLOSURES {
        let off = |y: &[f64]| (y[0].hypot(y[1]) - 1.0).abs().max((y[0] * y[2] + y[1] * y[3]).abs());
        let worst = std::cell::Cell::new(0.0_f64);
        let wall = FnEvents::new().with_reset(
            Event::new("wall").falling(),
            |_, y| {
                worst.set(worst.get().max(off(y)));
                Ok(y[0])
            },
            |_, y| {
                y[2] *= -1.0;
                y[3] = 7.0; // off the circle: to be projected
                Ok(())
            },
        );
        let options = Options::new(method);
        let motion = Solve::new(erased(Circle), 0.0, &[1.0, 0.0, 0.0, 0.0])
            .method(&options)
            .events(wall)
            .run(&[10.0, 20.0, 30.0])
            .unwrap();
        assert!(worst.get() < 1e-15);
        assert!(motion.occurrences.len() > 5);
        assert!(motion.occurrences.iter().all(|o| off(&o.state_after) < 1e-15 && o.state_after[2] > 0.0));
        // A half swing from rest at the horizontal to the wall and back always takes twice
        // K(1/2) = 1.854….
        let quarter = 1.854_074_677_301_371_9;
        for (n, time) in times(&motion.occurrences).into_iter().enumerate() {
            let expected = quarter * (2 * n + 1) as f64;
            assert!((time - expected).abs() < 1e-6, "{method}, {n}: {time} is not {expected}"); // 1000 rtol
        }
        assert!(motion.trajectory.iter().all(|(_, y)| off(y) < 1e-15));
    }
}

/// A borrowed implementation of `Events`.
#[test]
fn events_are_returned() {
    struct Count(Vec<Event>, u32);
    impl Events for Count {
        fn events(&self) -> &[Event] {
            &self.0
        }
        fn evaluate(&mut self, t: f64, _y: &[f64], values: &mut [f64]) -> Result<(), Failure> {
            self.1 += 1;
            values.copy_from_slice(&[t - 0.5, t - 0.75]);
            Ok(())
        }
    }
    let mut count = Count(vec![Event::new("one"), Event::new("two").resetting(true)], 0);
    let clock = field(|_, _| vec![1.0], 1);
    let motion = Solve::new(erased(clock), 0.0, &[0.0])
        .method(&Options::default())
        .events(&mut count)
        .run(&[1.0])
        .unwrap();
    assert_eq!(motion.occurrences.len(), 2);
    assert!(count.1 > 10);
    let hybrid = |events| {
        Integration::new(erased(oscillator()), 0.0, &[1.0, 0.0], &Options::default())?.with_events(events)
    };
    let hybrid: Integration<Cvode<_>, FnEvents<'_>> = hybrid(bounce(0.5)).unwrap();
    assert!(format!("{hybrid:?}").contains("bounce"));
    assert_eq!(hybrid.events().events().len(), 1);
    let (_, events) = hybrid.into_parts();
    assert_eq!(events.events()[0].name(), "bounce");
}

/// A saw tooth: none of many events is missed or found twice, and each resets exactly at its time.
#[test]
fn many_events() {
    for method in FOR_CLOSURES {
        let clock = field(|_, _| vec![1.0], 1);
        let tooth = FnEvents::new().with_reset(
            Event::new("tooth").rising(),
            |_, y| Ok(y[0] - 1.0),
            |_, y| {
                y[0] = 0.0;
                Ok(())
            },
        );
        let start = Solve::new(erased(clock), 0.0, &[0.0]).method(Options::new(method)).events(tooth);
        let mut saw = start.start().unwrap();
        let mut count = 0;
        let check = |occurrence: &Occurrence| {
            count += 1;
            // Each event is located to 1e-15 of its time, and the errors add up.
            let error = (occurrence.time - f64::from(count)).abs();
            assert!(error < 1e-15 * f64::from(count * count + 10), "{method}: {count}");
            Continue(())
        };
        assert_eq!(saw.advance_to(20_000.5, check).unwrap(), Ending::Completed);
        assert_eq!(count, 20_000, "{method}");
    }
}

/// A call that would pass events without end is limited.
#[test]
fn events_do_not_lift_the_limit_of_steps() {
    for method in Method::ALL {
        let zeros = FnEvents::new().with(Event::new("zero"), |_, y| Ok(y[0]));
        let options = Options::new(method).max_steps(200);
        let start = Solve::new(erased(oscillator()), 0.0, &[1.0, 0.0]).method(options).events(zeros);
        let mut motion = start.start().unwrap();
        let error = motion.advance_to(1e12, |_| Continue(())).unwrap_err();
        assert_eq!(error.code(), Some(Code::TooMuchWork), "{method}");
        let reached = motion.time();
        assert!((2.0..1e3).contains(&reached), "{method}: {reached}");
        // The next call has the same limit.
        assert_eq!(motion.advance_to(reached + 1.0, |_| Continue(())).unwrap(), Ending::Completed);
    }
}

/// Steps that end at t = 0, where the magnitude of the time gives no scale.
#[test]
fn passages_before_time_zero_are_located() {
    let cases = [(-1.0, -0.1, 1), (1.0, 0.1, 1), (10.0, 0.03, 4)];
    for (method, (start, at, passages)) in FOR_CLOSURES.into_iter().flat_map(|m| cases.map(|case| (m, case)))
    {
        let clock = from_fn(1, |_t, _y, rate| {
            rate[0] = 1.0;
            Ok(())
        });
        let events =
            FnEvents::default().with(Event::new("noon"), move |t: f64, _y: &[f64]| Ok((t - at).sin()));
        let found = Solve::new(erased(clock), start, &[start])
            .method(Options::new(method))
            .events(events)
            .run(&[0.0])
            .unwrap();
        assert_eq!(found.occurrences.len(), passages, "{method}: {start}");
        let last = found.occurrences.last().unwrap().time;
        assert!((last - at).abs() < 1e-12 * start.abs().max(1.0), "{last} for {at}");
    }
}

/// An event is found at the same time as without the others.
#[test]
fn another_event_hides_no_passages() {
    let times = |method: Method, second: bool| {
        let clock = from_fn(1, |_t, _y, rate| {
            rate[0] = 1.0;
            Ok(())
        });
        let mut events = FnEvents::default()
            .with(Event::new("twice"), |_t: f64, y: &[f64]| Ok((y[0] - 30.0).powi(2) - 4.0));
        if second {
            events = events.with(Event::new("once"), |_t: f64, y: &[f64]| Ok(y[0] - 40.0));
        }
        let options = Options::new(method).initial_step(1.0);
        let found =
            Solve::new(erased(clock), 0.0, &[0.0]).method(&options).events(events).run(&[100.0]).unwrap();
        found.occurrences.iter().map(|o| (o.time * 1e6).round() / 1e6).collect::<Vec<_>>()
    };
    for method in FOR_CLOSURES {
        assert_eq!(times(method, false), [28.0, 32.0], "{method}");
        assert_eq!(times(method, true), [28.0, 32.0, 40.0], "{method}");
    }
}

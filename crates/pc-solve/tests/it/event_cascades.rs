//! Events that resets of other events set off, at the same time.

use std::ops::ControlFlow::Continue;

use crate::boxed::{erased, from_fn};
use crate::fields::field;
use pc_expr::{Failure, ProgramField};
use pc_solve::{
    Ending, Event, FnEvents, Integration, Method, Occurrence, Options, Reason, Sensitivities, Solution,
    Solve, SolveError,
};

/// A point at speed 1 with a register: y = (x, n).
fn point() -> ProgramField {
    field(|_, [_x, _n]| [1.0.into(), 0.0.into()])
}

fn set(to: f64) -> impl FnMut(f64, &mut [f64]) -> Result<(), Failure> {
    move |_, y| {
        y[1] = to;
        Ok(())
    }
}

fn run(events: FnEvents<'_>, method: Method) -> Solution {
    Solve::new(erased(point()), 0.0, &[0.0, 0.0])
        .method(Options::new(method))
        .events(events)
        .run(&[2.0])
        .unwrap()
}

fn found(motion: &Solution) -> Vec<(usize, f64)> {
    motion.occurrences.iter().map(|occurrence| (occurrence.event, occurrence.time)).collect()
}

#[track_caller]
fn assert_found(motion: &Solution, expected: &[(usize, f64)], method: Method) {
    let found = found(motion);
    assert_eq!(found.len(), expected.len(), "{method}: {found:?}");
    for (found, expected) in found.iter().zip(expected) {
        assert_eq!(found.0, expected.0, "{method}");
        assert!((found.1 - expected.1).abs() < 1e-9, "{method}: {found:?} is not {expected:?}");
    }
}

/// A ball that keeps 0.8 of its speed, from height 1 at g = 9.81: its third bounce is at
/// t₀ (1 + 2·0.8 + 2·0.64), t₀ = √(2/g). The count reaches 3 from 2 there, beyond 2.5.
#[test]
fn the_third_bounce_ends_the_motion() {
    let third = (2.0_f64 / 9.81).sqrt() * (1.0 + 1.6 + 1.28);
    for (method, limit) in Method::ALL.into_iter().flat_map(|method| [(method, 2.5), (method, 3.0)]) {
        let ball = field(|_, [_y, v, _n]| [v, (-9.81).into(), 0.0.into()]);
        let events = FnEvents::new()
            .with(Event::new("enough").terminal(true), move |_, y| Ok(y[2] - limit))
            .with_reset(
                Event::new("bounce").falling(),
                |_, y| Ok(y[0]),
                |_, y| {
                    (y[1], y[2]) = (-0.8 * y[1], y[2] + 1.0);
                    Ok(())
                },
            );
        let options = Options::new(method).relative_tolerance(1e-12).absolute_tolerance(1e-13);
        let motion = Solve::new(erased(ball), 0.0, &[1.0, 0.0, 0.0])
            .method(options)
            .events(events)
            .run(&[3.0])
            .unwrap();
        assert_eq!(motion.ending, Some(Ending::Event { event: 0 }), "{method}");
        let names: Vec<usize> = motion.occurrences.iter().map(|occurrence| occurrence.event).collect();
        assert_eq!(names, [1, 1, 1, 0], "{method}");
        let [.., bounce, enough] = &motion.occurrences[..] else { panic!("{method}") };
        assert!((enough.time - third).abs() < 1e-10, "{method}: {}", enough.time);
        assert_eq!((bounce.time, &bounce.state_after), (enough.time, &enough.state_before), "{method}");
    }
}

/// A threshold that resets move through x: x − n changes its sign at 0.3 and 0.8, and with the
/// motion at 1.3. From checkpoints, too.
#[test]
fn a_threshold_moved_through_the_motion_is_passed() {
    let events = || {
        FnEvents::new()
            .with(Event::new("hit"), |_, y| Ok(y[0] - y[1]))
            .with_reset(Event::new("first"), |_, y| Ok(y[0] - 0.3), set(-1.0))
            .with_reset(Event::new("second"), |_, y| Ok(y[0] - 0.8), set(1.3))
    };
    let expected = [(1, 0.3), (0, 0.3), (2, 0.8), (0, 0.8), (0, 1.3)];
    for method in Method::ALL {
        let begin = || Solve::new(erased(point()), 0.0, &[0.0, 0.5]).method(Options::new(method));
        let motion = begin().events(events()).run(&[2.0]).unwrap();
        assert_found(&motion, &expected, method);
        // Continued from a checkpoint between the resets.
        let mut whole = begin().events(events()).start().unwrap();
        let mut times = Vec::new();
        let mut keep = |occurrence: &Occurrence| {
            times.push((occurrence.event, occurrence.time));
            Continue(())
        };
        whole.advance_to(0.5, &mut keep).unwrap();
        let checkpoint = whole.checkpoint();
        Integration::begin(point(), &checkpoint, &Options::new(method), &Sensitivities::new())
            .and_then(|begun| begun.with_events_of(events(), &checkpoint))
            .and_then(|mut rest| rest.advance_to(2.0, &mut keep))
            .unwrap();
        let near = times.iter().zip(&expected).all(|(a, b)| a.0 == b.0 && (a.1 - b.1).abs() < 1e-9);
        assert!(times.len() == 5 && near, "{method}: {times:?}");
    }
}

/// Its own reset makes no event occur again, whatever the direction; a reset to zero is an arrival
/// where the function stays there or goes on, not where it returns.
#[test]
fn which_resets_set_events_off() {
    for method in Method::ALL {
        let own = FnEvents::new().with_reset(
            Event::new("back"),
            |_, y| Ok(y[0] - 0.75),
            |_, y| {
                y[0] -= 1.0;
                Ok(())
            },
        );
        assert_found(&run(own, method), &[(0, 0.75), (0, 1.75)], method);
        let falls = |event: Event| {
            FnEvents::new()
                .with_reset(Event::new("set"), |t, _| Ok(t - 0.5), set(1.0))
                .with(event, |_, y| Ok(y[1] - 0.5))
        };
        assert_found(&run(falls(Event::new("n").falling()), method), &[(0, 0.5)], method);
        assert_found(&run(falls(Event::new("n").rising()), method), &[(0, 0.5), (1, 0.5)], method);
        // x is put on zero from above, and moves back up; from below it goes on.
        let zero = |start: f64| {
            let events = FnEvents::new()
                .with_reset(
                    Event::new("set"),
                    |t, _| Ok(t - 0.5),
                    |_, y| {
                        y[0] = 0.0;
                        Ok(())
                    },
                )
                .with(Event::new("x"), |_, y| Ok(y[0]));
            Solve::new(erased(point()), 0.0, &[start, 0.0])
                .method(Options::new(method))
                .events(events)
                .run(&[1.0])
                .unwrap()
        };
        assert_found(&zero(1.0), &[(0, 0.5)], method);
        assert_found(&zero(-1.0), &[(0, 0.5), (1, 0.5)], method);
    }
}

#[test]
fn events_that_set_each_other_off_without_end_are_an_error() {
    for method in Method::ALL {
        let events = FnEvents::new()
            .with_reset(Event::new("start"), |t, _| Ok(t - 0.5), set(2.0))
            .with_reset(Event::new("up").rising(), |_, y| Ok(y[1] - 1.0), set(-2.0))
            .with_reset(Event::new("down").falling(), |_, y| Ok(y[1] + 1.0), set(2.0));
        let motion =
            Solve::new(erased(point()), 0.0, &[0.0, 0.0]).method(Options::new(method)).events(events);
        let SolveError::Integration(error) = motion.run(&[2.0]).unwrap_err().error else {
            panic!("{method}")
        };
        let Reason::Cascade { event, occurrences, t } = &error.reason else { panic!("{method}: {error}") };
        assert_eq!((event.as_str(), *occurrences), ("up", 100), "{method}");
        assert!((t - 0.5).abs() < 1e-12 && error.to_string().contains("without end"), "{method}: {error}");
    }
}

/// x = t, and at x = p the speed n, so far 0, becomes 3, by which another event doubles it and adds
/// x: with ẏ = (1, 0, n), z(2) = (2 − p)(6 + p), so that dz/dp = −(6 + p) + (2 − p).
#[test]
fn sensitivities_over_events_that_are_set_off() {
    let p = 0.5;
    let speed = from_fn(3, |_t, y: &[f64], ydot: &mut [f64]| {
        (ydot[0], ydot[1], ydot[2]) = (1.0, 0.0, y[1]);
        Ok(())
    })
    .with_parameters(1, |_, _, by| {
        by.fill(0.0);
        Ok(())
    });
    let events = FnEvents::new()
        .with_reset(
            Event::new("double"),
            |_, y| Ok(y[1] - 2.0),
            |_, y| {
                y[1] = 2.0 * y[1] + y[0];
                Ok(())
            },
        )
        .with_reset(Event::new("at"), move |_, y| Ok(y[0] - p), set(3.0))
        .with_parameter_derivatives(|event, _p, _t, _y, reset| {
            reset.fill(0.0);
            Ok(if event == 1 { -1.0 } else { 0.0 })
        });
    let options = Options::new(Method::Adams).relative_tolerance(1e-12).absolute_tolerance(1e-13);
    let columns = Sensitivities::new().by_parameters([0]);
    let begun = Integration::with_sensitivities(erased(speed), 0.0, &[0.0; 3], &options, &columns).unwrap();
    let mut found = Vec::new();
    let keep = |_: f64, y: &[f64], matrix: &[f64]| {
        found.push((y[2], matrix[2]));
        Continue(())
    };
    begun.with_events(events).unwrap().run_with_sensitivities(&[2.0], keep, |_| Continue(())).unwrap();
    let (z, by_p) = found[0];
    assert!((z - 1.5 * 6.5).abs() < 1e-9, "{z}");
    assert!((by_p - (-6.5 + 1.5)).abs() < 1e-7, "{by_p}");
}

/// A function that jumps through zero at 0.3, and has a zero at 1.5; square waves; the zeros of a
/// tangent, whose poles are none; a jump with a reset.
#[test]
fn jumps_are_passed_once_and_poles_are_none() {
    let sign = |x: f64| if x < 0.0 { -1.0 } else { 1.0 };
    for method in Method::ALL {
        let events = || FnEvents::new();
        let options = || Options::new(method).max_step(0.05);
        let run = |events: FnEvents<'_>| {
            Solve::new(erased(point()), 0.0, &[0.0, 0.0])
                .method(options())
                .events(events)
                .run(&[2.0])
                .unwrap()
        };
        let jump = events().with(Event::new("a"), |_, y| Ok(sign(y[0] - 0.3) * (y[0] - 1.5)));
        assert_found(&run(jump), &[(0, 0.3), (0, 1.5)], method);
        let square = events().with(Event::new("a"), |_, y| Ok(sign((10.0 * y[0] + 0.5).sin())));
        let expected: Vec<(usize, f64)> =
            (1..=6).map(|k| (0, (f64::from(k) * std::f64::consts::PI - 0.5) / 10.0)).collect();
        assert_found(&run(square), &expected, method);
        let tangent = events().with(Event::new("a"), |_, y| Ok((3.0 * y[0]).tan()));
        assert_found(&run(tangent), &[(0, std::f64::consts::PI / 3.0)], method);
        let reset =
            events().with_reset(Event::new("a"), |_, y| Ok(sign(y[0] - 0.3) * (y[0] - 1.5)), set(1.0));
        assert_found(&run(reset), &[(0, 0.3), (0, 1.5)], method);
    }
}

/// x = cos t falls through zero, where the function jumps and a reset leaves x as it is, and rises through it again.
#[test]
fn a_jump_with_a_reset_is_passed_again_from_the_other_side() {
    let sign = |x: f64| if x < 0.0 { -1.0 } else { 1.0 };
    let circle = from_fn(3, |_t, y: &[f64], ydot: &mut [f64]| {
        (ydot[0], ydot[1], ydot[2]) = (-y[1], y[0], 0.0);
        Ok(())
    });
    let count = |_: f64, y: &mut [f64]| {
        y[2] += 1.0;
        Ok(())
    };
    let events = FnEvents::new().with_reset(Event::new("a"), move |_, y| Ok(sign(y[0])), count);
    let options = Options::new(Method::Adams).max_step(0.1);
    let motion = Solve::new(erased(circle), 0.0, &[1.0, 0.0, 0.0]).method(options).events(events);
    let expected: Vec<(usize, f64)> =
        (0..3).map(|k| (0, (f64::from(k) + 0.5) * std::f64::consts::PI)).collect();
    let found = motion.run(&[9.0]).unwrap().occurrences;
    assert_eq!(found.len(), expected.len(), "{found:?}");
    // x passes zero with speed 1: its error at the default tolerances is that of the times.
    assert!(found.iter().zip(&expected).all(|(found, (_, t))| (found.time - t).abs() < 1e-6), "{found:?}");
}

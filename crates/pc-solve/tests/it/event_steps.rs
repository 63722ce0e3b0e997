//! Steps from event to event, states inside them, and ends before an event.

use std::ops::ControlFlow::{Break, Continue};

use crate::boxed::{erased, from_fn};
use pc_solve::{
    Cvode, DenseOutput, Ending, Event, FnEvents, InputError, Integration, Observed, Occurrence, Options,
    Segment, SolveError, VectorField,
};

/// A ball that falls from height 1 with acceleration 1 and bounces without loss: at √2, 3√2, …
fn ball() -> Integration<Cvode<impl VectorField>, FnEvents<'static>> {
    let rates = |_: f64, y: &[f64], ydot: &mut [f64]| {
        ydot.copy_from_slice(&[y[1], -1.0]);
        Ok(())
    };
    let turn = |_: f64, y: &mut [f64]| {
        y[1] = -y[1];
        Ok(())
    };
    let events = FnEvents::new()
        .with_reset(Event::new("bounce").falling(), |_, y| Ok(y[0]), turn)
        .with(Event::new("top").falling(), |_, y| Ok(y[1]));
    let sharp = Options::default().relative_tolerance(1e-13).absolute_tolerance(1e-15);
    let cvode = Integration::new(erased(from_fn(2, rates)), 0.0, &[1.0, 0.0], &sharp).expect("a start");
    cvode.with_events(events).expect("events")
}

/// The part of the last step beyond the end is left to the next call.
#[test]
fn dense_output_may_end_in_the_step_before_an_event() {
    let landing = 2.0_f64.sqrt();
    let (mut hybrid, mut motion, mut times) = (ball(), DenseOutput::default(), Vec::new());
    for end in [landing - 1e-3, landing - 1e-4, landing + 1e-3, 3.0 * landing - 1e-3] {
        let keep = |segment: Segment| {
            motion.extend([segment]);
            Continue(())
        };
        let note = |occurrence: &Occurrence| {
            if occurrence.event == 0 {
                times.push(occurrence.time);
            }
            Continue(())
        };
        assert_eq!(hybrid.run_dense(end, keep, note).expect("a fall"), Ending::Completed);
        assert_eq!((hybrid.time(), motion.span()), (end, Some((0.0, end))));
        assert_eq!(times.len(), usize::from(end > landing));
        let since = end - landing;
        let height = if since < 0.0 { 1.0 - end * end / 2.0 } else { landing * since - since * since / 2.0 };
        assert!((hybrid.state()[0] - height).abs() < 1e-11, "{} is not {height}", hybrid.state()[0]);
    }
    assert!((times[0] - landing).abs() < 1e-12);
}

#[test]
fn steps_end_at_events_and_can_be_interpolated() {
    let (mut hybrid, mut told, mut t) = (ball(), Vec::new(), 0.0);
    assert!(matches!(hybrid.interpolate(0.0, 0), Err(SolveError::Input(InputError::NoStep))));
    while t < 3.0 {
        let before = told.len();
        let note = |occurrence: &Occurrence| {
            told.push((occurrence.event, occurrence.time));
            Continue(())
        };
        assert_eq!(hybrid.step(10.0, note).expect("a step"), Ending::Completed);
        let end = hybrid.time();
        assert!(end > t);
        assert!(told[before..].iter().all(|&(_, time)| time == end));
        let middle = 0.5 * (t + end);
        if told[before..].iter().any(|&(event, _)| event == 0) {
            // After the reset there is no step to interpolate in.
            assert!(matches!(hybrid.interpolate(middle, 0), Err(SolveError::Input(InputError::NoStep))));
        } else {
            let since = middle - 2.0_f64.sqrt();
            let exact = if since < 0.0 {
                [1.0 - middle * middle / 2.0, -middle]
            } else {
                [2.0_f64.sqrt() * since - since * since / 2.0, 2.0_f64.sqrt() - since]
            };
            for order in [0, 1] {
                let found = hybrid.interpolate(middle, order).expect("inside")[0];
                assert!((found - exact[order as usize]).abs() < 1e-9, "{found} {exact:?}");
            }
            for (t, order) in [(end + 1e-9, 0), (-1.0, 1)] {
                let Err(SolveError::Input(InputError::OutsideStep { requested, start, end: known })) =
                    hybrid.interpolate(t, order)
                else {
                    panic!("{t} lies beyond what is known")
                };
                assert!(requested == t && start < end && known == end);
            }
            assert!(matches!(
                hybrid.interpolate(end, 13),
                Err(SolveError::Input(InputError::DerivativeOrder { order: 13, highest: 1..=12 }))
            ));
            assert_eq!(hybrid.time(), end);
        }
        t = end;
    }
    assert_eq!(told.iter().map(|&(event, _)| event).collect::<Vec<_>>(), [0, 1]);
    assert!((told[1].1 - 2.0 * 2.0_f64.sqrt()).abs() < 1e-11);
    assert!(matches!(
        hybrid.step(t, |_| Continue(())),
        Err(SolveError::Input(InputError::EndIsStart { .. }))
    ));
    assert!(matches!(
        hybrid.step(t - 1.0, |_| Continue(())),
        Err(SolveError::Input(InputError::Behind { .. }))
    ));
}

#[test]
fn an_observer_stops_a_step_and_the_next_continues() {
    let mut hybrid = ball();
    let mut ending = Ending::Completed;
    while ending == Ending::Completed {
        ending = hybrid.step(10.0, |_| Break(())).expect("a step");
    }
    assert_eq!(ending, Ending::Stopped);
    assert!((hybrid.time() - 2.0_f64.sqrt()).abs() < 1e-12 && hybrid.state()[1] > 1.0);
    // As without an observer.
    assert_eq!(hybrid.step(10.0, |_| Continue(())).expect("a step"), Ending::Completed);
    let end = hybrid.time();
    let mut other = ball();
    while other.time() < end {
        other.step(10.0, |_| Continue(())).expect("a step");
    }
    assert_eq!((other.time(), other.state()), (end, hybrid.state()));
}

/// Of simultaneous events the observer stops at one, and another is terminal.
#[test]
fn a_terminal_event_ends_an_integration_also_where_an_observer_stops_it() {
    let clock = || {
        from_fn(1, |_, _: &[f64], ydot: &mut [f64]| {
            ydot[0] = 1.0;
            Ok(())
        })
    };
    let names = ["first", "end", "last", "other end"];
    for stopping in 0..names.len() {
        let start = || {
            let events = names.into_iter().fold(FnEvents::new(), |events, name| {
                events.with(Event::new(name).terminal(name.ends_with("end")), |_, y| Ok(y[0] - 0.5))
            });
            let cvode = Integration::new(erased(clock()), 0.0, &[0.0], &Options::default()).expect("a start");
            cvode.with_events(events).expect("events")
        };
        let told = std::cell::RefCell::new(Vec::new());
        let stop = |occurrence: &Occurrence| {
            told.borrow_mut().push(occurrence.event);
            if occurrence.event == stopping { Break(()) } else { Continue(()) }
        };
        let ended = |ending: Result<Ending, SolveError>| {
            assert_eq!(ending.expect("an ending"), Ending::Event { event: 1 }, "stopped at {stopping}");
            assert_eq!(told.take(), [0, 1, 2, 3], "all is told");
        };
        ended(start().advance_to(1.0, stop));
        let mut outputs = Vec::new();
        let output = |t: f64, _: &[f64]| {
            outputs.push(t);
            Continue(())
        };
        ended(start().run_observed(&[0.25, 1.0], Observed::new(output).occurrences(stop)));
        assert!(outputs.len() == 2 && (outputs[1] - 0.5).abs() < 1e-15, "it is the last output: {outputs:?}");
        let mut segments = 0;
        let segment = |_| {
            segments += 1;
            Continue(())
        };
        ended(start().run_dense(1.0, segment, stop));
        assert!(segments > 0);
        let mut hybrid = start();
        loop {
            match hybrid.step(1.0, stop) {
                Ok(Ending::Completed) => assert!(hybrid.time() < 0.5),
                ending => break ended(ending),
            }
        }
    }
}

/// The function that failed is named among several.
#[test]
fn the_event_that_fails_is_named() {
    let still = from_fn(1, |_, _: &[f64], ydot: &mut [f64]| {
        ydot[0] = 1.0;
        Ok(())
    });
    let events = FnEvents::new().with(Event::new("first"), |_, y| Ok(y[0] + 1.0)).with(
        Event::new("second"),
        |t, y| {
            let late = InputError::EndIsStart { t };
            if t > 0.5 { Err(pc_solve::Failure::fatal(late)) } else { Ok(y[0] + 1.0) }
        },
    );
    let cvode = Integration::new(erased(still), 0.0, &[0.0], &Options::default()).expect("a start");
    let mut hybrid = cvode.with_events(events).expect("events");
    let error = hybrid.advance_to(1.0, |_| Continue(())).expect_err("late");
    assert!(error.to_string().starts_with("the event second cannot be evaluated"), "{error}");
}

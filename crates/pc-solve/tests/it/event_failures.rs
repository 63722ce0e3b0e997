//! Failures, panics and non-finite numbers in event functions and resets.

use std::cell::Cell;
use std::ops::ControlFlow::Continue;
use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::boxed::{erased, from_fn};
use pc_solve::{
    Cvode, Event, Failure, FnEvents, Integration, IntegrationError, Method, Options, Reason, Solve,
    SolveError, VectorField,
};

#[derive(Debug, thiserror::Error)]
#[error("no further")]
struct NoFurther;

/// ẏ = (1, 0), from 0.
fn clock() -> impl VectorField {
    from_fn(2, |_, _: &[f64], ydot: &mut [f64]| {
        ydot.copy_from_slice(&[1.0, 0.0]);
        Ok(())
    })
    .with_names(["clock", "spare"])
}

fn hybrid(events: FnEvents<'_>) -> Result<Integration<Cvode<impl VectorField>, FnEvents<'_>>, SolveError> {
    Integration::new(erased(clock()), 0.0, &[0.0, 0.0], &Options::new(Method::Adams).max_step(0.1))
        .unwrap()
        .with_events(events)
}

/// The error of an integration towards 3, after which it is at the time and state of the error.
fn error_of(events: FnEvents<'_>) -> IntegrationError {
    let mut hybrid = hybrid(events).unwrap();
    let error = hybrid.advance_to(3.0, |_| Continue(())).unwrap_err();
    let (time, state) = error.reached().unwrap();
    assert_eq!((hybrid.time(), hybrid.state()), (time, state));
    assert!((state[0] - time).abs() < 1e-14);
    match error {
        SolveError::Integration(error) => *error,
        other => panic!("{other}"),
    }
}

fn source(error: &IntegrationError) -> String {
    std::error::Error::source(error).map(ToString::to_string).unwrap_or_default()
}

#[test]
fn a_function_that_fails() {
    let fails = |t: f64, _: &[f64]| if t > 1.0 { Err(Failure::fatal(NoFurther)) } else { Ok(1.0) };
    let error = error_of(FnEvents::new().with(Event::new("edge"), fails));
    assert!(matches!(&error.reason, Reason::Event { event, t } if event == "edge" && *t > 1.0));
    assert!(error.time <= 1.0 && error.time > 0.89, "{}", error.time);
    assert_eq!(source(&error), "no further");
    let text = error.to_string();
    assert!(text.starts_with("the event edge cannot be evaluated at t = 1.0"), "{text}");

    // NaN and infinities are failures of their event.
    let other = |_: f64, _: &[f64]| Ok(1.0);
    let nan = |t: f64, _: &[f64]| Ok((1.0 - t).sqrt() + 1.0);
    let error = error_of(FnEvents::new().with(Event::new("fine"), other).with(Event::new("root"), nan));
    assert!(matches!(&error.reason, Reason::Event { event, .. } if event == "root"));
    assert!(source(&error).starts_with("the function of the event root is NaN at t = 1.0"), "{error}");
}

#[test]
fn a_function_that_fails_at_the_start() {
    let error = hybrid(FnEvents::new().with(Event::new("log"), |t, _| Ok(t.ln()))).unwrap_err();
    assert_eq!(error.reached(), Some((0.0, &[0.0, 0.0][..])));
    assert_eq!(error.to_string(), "the event log cannot be evaluated at t = 0, after reaching t = 0");
}

#[test]
fn a_reset_that_fails() {
    let at_one = |t: f64, _: &[f64]| Ok(t - 1.0);
    let error = error_of(
        FnEvents::new().with_reset(Event::new("jump"), at_one, |_, _| Err(Failure::fatal(NoFurther))),
    );
    assert!(matches!(&error.reason, Reason::Reset { event, .. } if event == "jump"));
    assert!((error.time - 1.0).abs() < 1e-15);
    assert_eq!(source(&error), "no further");

    let nan = |_: f64, y: &mut [f64]| {
        y[1] = f64::NAN;
        Ok(())
    };
    let error = error_of(FnEvents::new().with_reset(Event::new("jump"), at_one, nan));
    assert!(matches!(&error.reason, Reason::Reset { .. }));
    assert!(source(&error).starts_with("the event jump sets spare to NaN at t = "), "{}", source(&error));
    assert!(error.state[1] == 0.0);

    // A reset to a state where a function fails.
    let far = |_: f64, y: &mut [f64]| {
        y[1] = -1.0;
        Ok(())
    };
    let events = FnEvents::new().with(Event::new("root"), |_, y| Ok(1.0 + y[1].sqrt())).with_reset(
        Event::new("jump"),
        at_one,
        far,
    );
    let error = error_of(events);
    assert!(matches!(&error.reason, Reason::Event { event, .. } if event == "root"));
    assert!((error.time - 1.0).abs() < 1e-15);
}

/// A panic reaches the caller and leaves the last state; it recurs when the integration continues,
/// and if it does not the integration is usable.
#[test]
fn panics() {
    let armed = Cell::new(true);
    let message = |panic: Box<dyn std::any::Any + Send>| *panic.downcast::<&str>().unwrap();
    for in_function in [true, false] {
        armed.set(true);
        let events = FnEvents::new().with_reset(
            Event::new("jump").rising(),
            |t, _| {
                assert!(!(in_function && armed.get() && t > 1.2), "function");
                Ok(t - 1.0)
            },
            |_, y| {
                assert!(in_function || !armed.get(), "reset");
                y[1] += 1.0;
                Ok(())
            },
        );
        let mut hybrid = hybrid(events).unwrap();
        hybrid.advance_to(0.5, |_| Continue(())).unwrap();
        for _ in 0..2 {
            let run = AssertUnwindSafe(|| hybrid.advance_to(3.0, |_| Continue(())));
            assert_eq!(
                message(catch_unwind(run).unwrap_err()),
                if in_function { "function" } else { "reset" }
            );
            assert!((hybrid.state()[0] - hybrid.time()).abs() < 1e-14, "{hybrid:?}");
        }
        armed.set(false);
        let mut count = 0;
        let count_them = |_: &_| {
            count += 1;
            Continue(())
        };
        hybrid.advance_to(3.0, count_them).unwrap();
        assert_eq!(count, u32::from(!in_function), "the reset comes once, before or after the panic");
        assert!((hybrid.state()[0] - 3.0).abs() < 1e-14 && hybrid.state()[1] == 1.0);
    }
}

/// Failures of the field are reported as without events.
#[test]
fn a_field_that_fails() {
    let fails = from_fn(1, |t: f64, _: &[f64], ydot: &mut [f64]| {
        ydot[0] = if t < 1.0 { 1.0 } else { f64::NAN };
        Ok(())
    });
    let events = FnEvents::new().with(Event::new("half"), |t, _| Ok(t - 0.5));
    let failure = Solve::new(erased(fails), 0.0, &[0.0])
        .method(&Options::new(Method::Adams))
        .events(events)
        .run(&[0.25, 2.0])
        .unwrap_err();
    assert_eq!((failure.reached.trajectory.len(), failure.reached.occurrences.len()), (1, 1));
    let (time, state) = failure.error.reached().unwrap();
    assert!(time <= 1.0 && time > 0.9 && (state[0] - time).abs() < 1e-9);
    assert!(failure.error.code().is_some() || failure.to_string().contains("too short"), "{failure}");
}

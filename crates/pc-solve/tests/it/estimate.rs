//! Global errors from a companion: which one, how far it reaches, and what it is worth over events.

use std::ops::ControlFlow;

use pc_solve::{
    Companion, Ending, ErrorEstimate, Event, FnEvents, Method, NoEvents, Options, Solve, Statistics,
    VectorField, error_of, from_fn,
};

use crate::fields;

fn closure() -> impl VectorField {
    from_fn(2, |_t, y, ydot| {
        ydot[0] = y[1];
        ydot[1] = -y[0];
        Ok(())
    })
}

fn options(method: Method, rtol: f64) -> Options {
    Options::new(method).relative_tolerance(rtol)
}

/// Method and tolerance of the companion of a motion by this method, which met stiffness or did not.
fn companion(field: &mut impl VectorField, method: Method, rtol: f64, is_stiff: bool) -> (Method, f64) {
    let mut work = Statistics::default();
    work.stiff_from = is_stiff.then_some(0.5);
    let companion = Companion::of(field, &options(method, rtol), &work);
    (companion.method(), companion.relative_tolerance())
}

#[test]
fn a_companion_is_by_taylors_method_where_it_can_be() {
    let mut program = fields::oscillator();
    for method in [Method::Auto, Method::Adams, Method::Dop853, Method::Taylor] {
        assert_eq!(companion(&mut program, method, 1e-6, false), (Method::Taylor, 1e-16));
        assert_eq!(companion(&mut closure(), method, 1e-6, false), (Method::Auto, 1e-9));
        assert_eq!(companion(&mut program, method, 1e-6, true), (Method::Auto, 1e-9));
    }
    assert_eq!(companion(&mut program, Method::Bdf, 1e-6, false), (Method::Bdf, 1e-9));
    // Where nothing is finer, other steps.
    assert_eq!(companion(&mut program, Method::Taylor, 1e-16, false), (Method::Taylor, 1e-16 * 1e-3));
    assert_eq!(companion(&mut closure(), Method::Auto, 1e-14, false), (Method::Auto, 1e-15));
    assert_eq!(companion(&mut closure(), Method::Auto, 1e-16, false), (Method::Auto, 1e-14));
}

/// An error is at least half a unit in the last place of the value, and what is not a number stays so.
#[test]
fn no_error_is_less_than_the_rounding_of_the_value() {
    assert_eq!(error_of(3.0, 2.5), 0.5);
    assert_eq!(error_of(-1.0, -1.0), f64::EPSILON / 2.0);
    assert_eq!(error_of(0.0, 0.0), 0.0);
    assert!(error_of(f64::NAN, 1.0).is_nan() && error_of(1.0, f64::NAN).is_nan());
}

/// Of cos t, by fields with a series and without, forwards and backwards.
#[test]
fn errors_of_an_oscillator_are_right() {
    for end in [200.0, -200.0f64] {
        for method in [Method::Auto, Method::Adams, Method::Bdf, Method::Dop853] {
            let (times, options) = ([end / 2.0, end], options(method, 1e-8));
            let check = |motion: &pc_solve::Solution, estimate: &ErrorEstimate| {
                assert_eq!(estimate.len(), 2);
                for (i, t) in times.iter().enumerate() {
                    let (y, errors) = (motion.trajectory.state(i), estimate.errors(motion, i));
                    for (error, estimated) in
                        [y[0] - t.cos(), y[1] + t.sin()].map(f64::abs).iter().zip(errors)
                    {
                        // A finer motion by the same method is better by some dozens.
                        assert!((estimated - error).abs() < 0.2 * error, "{method}: {error:e} {estimated:e}");
                    }
                }
            };
            let start = [1.0, 0.0];
            let motion = Solve::new(closure(), 0.0, &start).method(&options).run(&times).unwrap();
            check(&motion, &ErrorEstimate::of(&motion, (closure(), 0.0, &start), NoEvents, &times, &options));
            let program = fields::oscillator;
            let motion = Solve::new(program(), 0.0, &start).method(&options).run(&times).unwrap();
            check(&motion, &ErrorEstimate::of(&motion, (program(), 0.0, &start), NoEvents, &times, &options));
        }
    }
}

/// A motion that ended by an event has the errors of its state there; the time of the event is later in the companion or earlier.
#[test]
fn the_state_at_a_terminal_event_is_compared() {
    let down = || FnEvents::new().with(Event::new("down").falling().terminal(true), |_t, y| Ok(y[0]));
    let (times, start, options) = ([1.0, 2.0, 3.0], [1.0, 0.0], options(Method::Adams, 1e-6));
    let solve = Solve::new(fields::oscillator(), 0.0, &start).method(&options).events(down());
    let motion = solve.run(&times).unwrap();
    let estimate = ErrorEstimate::of(&motion, (fields::oscillator(), 0.0, &start), down(), &times, &options);
    assert_eq!((motion.trajectory.len(), estimate.len()), (2, 2));
    assert_eq!(estimate.ending(), Some(Ending::Event { event: 0 }));
    assert_ne!(motion.trajectory.times()[1], estimate.beside().times()[1]);
    assert!(estimate.beyond_events(&motion).is_empty());
    // v = −1 at π/2
    let (error, estimated) = ((motion.trajectory.state(1)[1] + 1.0).abs(), estimate.errors(&motion, 1)[1]);
    assert!((estimated - error).abs() < 1e-3 * error, "{error:e} {estimated:e}");
}

#[test]
fn outputs_between_the_times_of_an_event_are_known() {
    // A switch of the velocity at x = ½ beside an output; the tolerance is coarse.
    let switch = || {
        let event = Event::new("switch").falling();
        FnEvents::new().with_reset(
            event,
            |_t, y| Ok(y[0] - 0.5),
            |_t, y| {
                y[1] -= 1.0;
                Ok(())
            },
        )
    };
    let (start, options) = ([1.0, 0.0], options(Method::Adams, 1e-4));
    let run = |times: &[f64]| {
        let solve = Solve::new(fields::oscillator(), 0.0, &start).method(&options).events(switch());
        solve.run(times).unwrap()
    };
    let found = run(&[2.0]).occurrences[0].time;
    let exact = 0.5f64.acos();
    assert_ne!(found, exact);
    let times = [0.5, (found + exact) / 2.0, 1.5];
    let motion = run(&times);
    let estimate =
        ErrorEstimate::of(&motion, (fields::oscillator(), 0.0, &start), switch(), &times, &options);
    assert_eq!(estimate.beyond_events(&motion), [1]);
    assert!(estimate.errors(&motion, 1)[1] > 0.9 && estimate.errors(&motion, 2)[1] < 0.1);
}

#[test]
fn a_companion_that_is_stopped_has_the_errors_before() {
    let (times, start, options) = ([1.0, 2.0, 30.0], [1.0, 0.0], options(Method::Adams, 1e-6));
    let motion = Solve::new(fields::oscillator(), 0.0, &start).method(&options).run(&times).unwrap();
    let field = (fields::oscillator(), 0.0, &start[..]);
    let step = |t: f64, _: &[f64]| if t > 10.0 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) };
    let estimate = ErrorEstimate::observed(&motion, field, NoEvents, &times, &options, step);
    assert_eq!((estimate.len(), estimate.ending()), (2, Some(Ending::Stopped)));
    assert!(estimate.failure().is_none() && !estimate.is_empty());
}

/// Beyond its pole the field has no value, and the companion fails there as the motion did.
#[test]
fn a_motion_that_failed_has_errors_as_far_as_it_came() {
    let root = || fields::field(|_, [x]| [-1.0 / x]); // x = √(1 − 2t)
    let (times, start, options) = ([0.2, 0.4, 0.6], [1.0], options(Method::Dop853, 1e-6));
    let failure = Solve::new(root(), 0.0, &start).method(&options).run(&times).unwrap_err();
    let motion = failure.reached;
    assert_eq!(motion.trajectory.len(), 2);
    let estimate = ErrorEstimate::of(&motion, (root(), 0.0, &start), NoEvents, &times, &options);
    assert_eq!(estimate.len(), 2);
    assert!(estimate.failure().is_none(), "the companion goes no further than the motion");
    let error = (motion.trajectory.state(1)[0] - 0.2f64.sqrt()).abs();
    assert!((estimate.errors(&motion, 1)[0] - error).abs() < 1e-3 * error);
}

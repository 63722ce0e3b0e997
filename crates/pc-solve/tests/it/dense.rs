//! Motions as functions of time, against closed forms.

use std::cell::Cell;
use std::ops::ControlFlow::{Break, Continue};

use crate::boxed::{erased, from_fn};
use pc_solve::{
    DenseOutput, Ending, Event, Failure, FnEvents, InputError, Integration, Method, Options, Segment, Solve,
    VectorField,
};

fn oscillator() -> impl VectorField {
    from_fn(2, |_, y: &[f64], ydot: &mut [f64]| {
        ydot.copy_from_slice(&[y[1], -y[0]]);
        Ok::<(), Failure>(())
    })
}

fn circle(end: f64, options: &Options) -> DenseOutput {
    Solve::new(erased(oscillator()), 0.0, &[1.0, 0.0]).method(options).dense(end).unwrap()
}

/// Each segment begins at exactly the time at which the previous one ends, with its state up to the
/// rounding of a sum of some ten terms.
#[test]
fn segments_fit_together() {
    for method in [Method::Adams, Method::Bdf] {
        for end in [10.0, -10.0] {
            let motion = circle(end, &Options::new(method));
            assert_eq!(motion.span(), Some((0.0, end)));
            let (mut before, mut after) = ([0.0; 2], [0.0; 2]);
            for pair in motion.segments().windows(2) {
                let t = pair[0].span().1;
                assert_eq!(t, pair[1].span().0);
                pair[0].evaluate(t, &mut before);
                pair[1].evaluate(t, &mut after);
                for (before, after) in before.iter().zip(&after) {
                    assert!((before - after).abs() < 1e-14, "{before} {after} at {t}");
                }
            }
            assert!(motion.segments().len() > 20);
        }
    }
}

/// Between the ends of steps the motion is as accurate as there.
#[test]
fn dense_output_is_as_good_as_the_steps() {
    for method in [Method::Adams, Method::Bdf] {
        for rtol in [1e-6, 1e-8, 1e-10, 1e-12] {
            let options = Options::new(method).relative_tolerance(rtol).absolute_tolerance(rtol);
            let motion = circle(10.0, &options);
            let error = |t: f64| {
                let y = motion.evaluate(t).unwrap();
                (y[0] - t.cos()).hypot(y[1] + t.sin())
            };
            let at_steps = motion.segments().iter().map(|s| error(s.span().1)).fold(0.0, f64::max);
            let between = (0..=5000).map(|i| error(f64::from(i) / 500.0)).fold(0.0, f64::max);
            assert!(between < 2.0 * at_steps + 2.0 * rtol, "{method} {rtol}: {between:e} {at_steps:e}");
            // The derivative has the error of a step divided by its length, here the shortest
            // length apart from the first few.
            let shortest = motion.segments()[10..].iter().map(|s| s.span().1 - s.span().0);
            let shortest = shortest.fold(f64::INFINITY, f64::min);
            let rate_error = (100..=1000).map(|i| {
                let t = f64::from(i) / 100.0;
                let rate = motion.derivative(t).unwrap();
                (rate[0] + t.sin()).hypot(rate[1] + t.cos())
            });
            let rate_error = rate_error.fold(0.0, f64::max);
            assert!(
                rate_error < at_steps + 20.0 * rtol / shortest.min(1.0),
                "{method} {rtol}: {rate_error:e}"
            );
        }
    }
}

/// Along each segment the motion deviates from the exact one through its start by no more than the
/// error test allows: the segment has the order of the step. At 1e-12 these are orders up to 12 of
/// Adams' formulas, and steps on which a cubic would err by 1e-6.
#[test]
fn segments_have_the_order_of_their_step() {
    for method in [Method::Adams, Method::Bdf] {
        for rtol in [1e-4, 1e-8, 1e-12] {
            let options = Options::new(method).relative_tolerance(rtol).absolute_tolerance(rtol);
            let motion = circle(20.0, &options);
            let mut worst = 0.0_f64;
            for segment in motion.segments() {
                let (start, end) = segment.span();
                let (mut from, mut y) = ([0.0; 2], [0.0; 2]);
                segment.evaluate(start, &mut from);
                for i in 0..=10 {
                    let t = start + (end - start) * f64::from(i) / 10.0;
                    segment.evaluate(t, &mut y);
                    let (sin, cos) = (t - start).sin_cos();
                    let exact = [from[0] * cos + from[1] * sin, from[1] * cos - from[0] * sin];
                    worst = worst.max((y[0] - exact[0]).hypot(y[1] - exact[1]));
                }
            }
            // The error test bounds only an estimate, and a mean over the components.
            assert!(worst < 10.0 * rtol, "{method} {rtol}: {worst:e}");
        }
    }
}

#[test]
fn a_time_outside_is_refused() {
    let motion = circle(1.0, &Options::default());
    for t in [-1e-9, 1.0 + 1e-9, f64::NAN] {
        let error = motion.evaluate(t).unwrap_err();
        assert!(matches!(error, InputError::OutsideSpan { start: 0.0, end: 1.0, .. }));
        assert!(error.to_string().ends_with("lies outside the dense output, which covers t = 0 to 1"));
    }
    assert_eq!(motion.evaluate(0.0).unwrap().len(), 2);
    assert!((motion.evaluate(1.0).unwrap()[0] - 1.0_f64.cos()).abs() < 1e-8);
    assert!(DenseOutput::default().evaluate(0.0).is_err());
    assert_eq!(DenseOutput::default().span(), None);
}

/// Segments are passed on one by one and not kept; one may begin and end inside a step, and outputs
/// in between change nothing.
#[test]
fn segments_are_given_in_order() {
    let mut cvode = Integration::new(erased(oscillator()), 0.0, &[1.0, 0.0], &Options::default()).unwrap();
    let mut motion = DenseOutput::default();
    let mut spans = Vec::new();
    for end in [0.5, 1.0, 1.0001, 3.0] {
        let keep = |segment: Segment| {
            spans.push(segment.span());
            motion.extend([segment]);
            Continue(())
        };
        assert_eq!(cvode.run_dense(end, keep, |_| Continue(())).unwrap(), Ending::Completed);
        assert_eq!(cvode.time(), end);
        assert_eq!(cvode.state(), motion.evaluate(end).unwrap());
    }
    assert_eq!(motion.span(), Some((0.0, 3.0)));
    assert!(spans.windows(2).all(|pair| pair[0].1 == pair[1].0));
    assert!(spans.contains(&(1.0, 1.0001)));
    assert_eq!(cvode.run_dense(4.0, |_| Break(()), |_| Continue(())).unwrap(), Ending::Stopped);
    assert!(cvode.time() > 3.0 && cvode.time() <= 4.0);
}

/// A bouncing ball: the speed jumps, the height does not, with parabolas in between.
#[test]
fn dense_output_with_resets() {
    for method in [Method::Adams, Method::Bdf] {
        let ball = from_fn(2, |_, y: &[f64], ydot: &mut [f64]| {
            ydot.copy_from_slice(&[y[1], -1.0]);
            Ok(())
        });
        let bounce = FnEvents::new()
            .with_reset(
                Event::new("bounce").falling(),
                |_, y| Ok(y[0]),
                |_, y| {
                    y[1] *= -0.5;
                    Ok(())
                },
            )
            .with(Event::new("mark"), |t, _| Ok(t - 0.5));
        let options = Options::new(method).relative_tolerance(1e-12).absolute_tolerance(1e-14);
        let mut hybrid =
            Integration::new(erased(ball), 0.0, &[1.0, 0.0], &options).unwrap().with_events(bounce).unwrap();
        let (mut motion, mut events) = (DenseOutput::default(), Vec::new());
        let keep = |segment: Segment| {
            motion.extend([segment]);
            Continue(())
        };
        let note = |occurrence: &pc_solve::Occurrence| {
            events.push(occurrence.clone());
            Continue(())
        };
        assert_eq!(hybrid.run_dense(3.0, keep, note).unwrap(), Ending::Completed);
        assert_eq!(motion.span(), Some((0.0, 3.0)));
        let landing = 2.0_f64.sqrt();
        assert_eq!(events.iter().map(|o| o.event).collect::<Vec<_>>(), [1, 0, 0]);
        for occurrence in &events {
            let t = occurrence.time;
            let (before, after) = (motion.evaluate(t - 1e-9).unwrap(), motion.evaluate(t).unwrap());
            assert!((before[0] - after[0]).abs() < 1e-8);
            for (value, expected) in after.iter().zip(&occurrence.state_after) {
                assert!((value - expected).abs() < 1e-14, "right-continuous at {t}");
            }
            assert!((before[1] - occurrence.state_before[1]).abs() < 1e-8);
        }
        for i in 0..=1000 {
            let t = 2.8 * f64::from(i) / 1000.0;
            let since = t - landing;
            let height =
                if since < 0.0 { 1.0 - t * t / 2.0 } else { 0.5 * landing * since - since * since / 2.0 };
            let found = motion.evaluate(t).unwrap()[0];
            assert!((found - height).abs() < 1e-11, "{method}: {found} at {t}, not {height}");
        }
    }
}

/// The same with states projected after each step, here to the circle.
#[test]
fn segments_of_projected_states_fit_together() {
    struct Circle;
    impl VectorField for Circle {
        fn dim(&self) -> usize {
            2
        }
        fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
            ydot.copy_from_slice(&[y[1], -y[0]]);
            Ok(())
        }
        fn has_projection(&self) -> bool {
            true
        }
        fn project(&mut self, _t: f64, y: &mut [f64]) -> Result<(), Failure> {
            let length = y[0].hypot(y[1]);
            y.iter_mut().for_each(|y| *y /= length);
            Ok(())
        }
    }
    let options = Options::default().relative_tolerance(1e-6).absolute_tolerance(1e-6);
    let motion = Solve::new(erased(Circle), 0.0, &[1.0, 0.0]).method(&options).dense(10.0).unwrap();
    let (mut before, mut after) = ([0.0; 2], [0.0; 2]);
    for pair in motion.segments().windows(2) {
        let t = pair[0].span().1;
        pair[0].evaluate(t, &mut before);
        pair[1].evaluate(t, &mut after);
        assert!(before.iter().zip(&after).all(|(a, b)| (a - b).abs() < 1e-14), "{before:?} {after:?} at {t}");
    }
}

/// The derivatives of a high order overflow there, and the powers of the length of the step vanish.
#[test]
fn the_shortest_motions_have_states_and_rates() {
    for method in [Method::Dop853, Method::Auto] {
        for end in [1e-200, -1e-305, 1e-320, f64::from_bits(1)] {
            let motion = circle(end, &Options::new(method));
            for t in [0.0, 0.5 * end, end] {
                assert_eq!(motion.evaluate(t).unwrap()[0], 1.0, "{method} at {t} of {end}");
                let rate = motion.derivative(t).unwrap();
                assert!(rate.iter().all(|rate| rate.is_finite()), "{method} at {t} of {end}: {rate:?}");
            }
        }
    }
}

#[test]
fn the_step_limit_holds() {
    let failed = Solve::new(erased(oscillator()), 0.0, &[1.0, 0.0])
        .method(&Options::default().max_steps(10).max_step(1e-3))
        .dense(1.0);
    let error = failed.unwrap_err();
    assert_eq!(error.code(), Some(pc_solve::Code::TooMuchWork));
    assert!(error.to_string().contains("10 steps were not enough to reach the output at t = 1"), "{error}");
}

#[test]
fn an_interpolation_that_fails_moves_nothing() {
    let broken = Cell::new(false);
    let field = from_fn(1, |_, _: &[f64], ydot: &mut [f64]| {
        ydot[0] = 1.0;
        Ok(())
    })
    .with_projection(|_, _| if broken.get() { Err(Failure::recoverable(std::fmt::Error)) } else { Ok(()) });
    let mut motion =
        Integration::new(erased(field), 0.0, &[0.0], &Options::default().initial_step(0.4)).unwrap();
    let here = motion.state_at(0.3).unwrap().to_vec();
    broken.set(true);
    assert!(motion.interpolate(0.1, 0).is_err());
    assert_eq!((motion.time(), motion.state()), (0.3, &here[..]));
    broken.set(false);
    assert!((motion.state_at(0.35).unwrap()[0] - 0.35).abs() < 1e-15); // not beyond the end of the step
}

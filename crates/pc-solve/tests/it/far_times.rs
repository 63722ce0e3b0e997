//! Motions that begin far from t = 0: they are those from 0.

use crate::boxed::{erased, from_fn};
use crate::fields::oscillator;
use pc_solve::{Event, FnEvents, Method, Options, Solve, VectorField};

/// ẍ = −ω² x with ω = 500 as a function.
fn fast() -> impl VectorField {
    from_fn(2, |_, y: &[f64], ydot: &mut [f64]| {
        (ydot[0], ydot[1]) = (y[1], -2.5e5 * y[0]);
        Ok(())
    })
}

/// cos(500 s) at s = 1 and s = 2.5, which are exact after each of these starts.
#[test]
fn a_motion_from_far_away_is_that_from_0() {
    for method in Method::ALL.into_iter().filter(|method| *method != Method::Taylor) {
        let options = || Options::new(method);
        let run = |start: f64| {
            let times = [start + 1.0, start + 2.5];
            Solve::new(erased(fast()), start, &[1.0, 0.0]).method(options()).run(&times).unwrap().trajectory
        };
        let near = run(0.0);
        for start in [1.7e9, -4.0e9] {
            let far = run(start);
            assert_eq!(near.states(), far.states(), "{method} from {start}");
            assert_eq!(far.times(), [start + 1.0, start + 2.5]);
            assert_eq!(near.statistics().steps, far.statistics().steps);
        }
    }
}

/// By Taylor's method, of a program, and backwards in time.
#[test]
fn programs_from_far_away() {
    for method in Method::ALL {
        for (start, span) in [(1e9, 40.0), (1e12, -40.0)] {
            let options = Options::new(method).relative_tolerance(1e-12);
            let begun = Solve::new(erased(oscillator()), start, &[1.0, 0.0]).method(options);
            let motion = begun.run(&[start + span]).unwrap().trajectory;
            let (t, y) = motion.last().unwrap();
            assert_eq!(t, start + span);
            assert!((y[0] - span.cos()).abs() < 1e-7, "{method}: {y:?}");
        }
    }
}

/// A force that is on for a second from t₀ + 3 on: its breaks and pulses are found there.
#[test]
fn forces_in_time_from_far_away() {
    for method in [Method::Adams, Method::Bdf, Method::Dop853, Method::Auto] {
        let start = 1e9;
        let pulse = from_fn(2, move |t: f64, y: &[f64], ydot: &mut [f64]| {
            (ydot[0], ydot[1]) = (y[1], (-((t - start - 3.0) / 0.1).powi(2)).exp());
            Ok(())
        });
        let begun = Solve::new(erased(pulse), start, &[0.0, 0.0]).method(Options::new(method));
        let motion = begun.run(&[start + 8.0]).unwrap().trajectory;
        let speed = 0.1 * std::f64::consts::PI.sqrt();
        // t is known to 1e-7 of the width of the pulse, 0.1.
        assert!((motion.last().unwrap().1[1] - speed).abs() < 1e-6, "{method}: {motion:?}");
    }
}

/// An event is located to the rounding of t.
#[test]
fn events_from_far_away() {
    for method in Method::ALL {
        let start = 1e9;
        let events = FnEvents::new().with(Event::new("zero"), |_, y| Ok(y[0]));
        let begun = Solve::new(erased(oscillator()), start, &[1.0, 0.0]);
        let motion = begun.method(Options::new(method)).events(events).run(&[start + 7.0]).unwrap();
        let found: Vec<f64> = motion.occurrences.iter().map(|occurrence| occurrence.time - start).collect();
        let quarter = std::f64::consts::FRAC_PI_2;
        assert_eq!(found.len(), 2, "{method}: {found:?}");
        assert!((found[0] - quarter).abs() < 1e-6 && (found[1] - 3.0 * quarter).abs() < 1e-6, "{found:?}");
    }
}

/// At rest, where steps grow until times leave the range of numbers.
#[test]
fn a_state_at_rest_until_the_last_time() {
    for method in [Method::Dop853, Method::Auto] {
        for end in [f64::MAX, -f64::MAX] {
            let begun = Solve::new(erased(oscillator()), 0.0, &[0.0, 0.0]).method(Options::new(method));
            let motion = begun.run(&[end]).unwrap().trajectory;
            assert_eq!(motion.last(), Some((end, &[0.0, 0.0][..])), "{method}");
        }
    }
}

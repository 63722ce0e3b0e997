//! Events along the series of Taylor's method: none is lost, however close.

#![expect(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod fields;

use std::ops::ControlFlow;

use fields::{ProgramEvents, field, program};
use pc_expr::{Backend, Event, Expr, Graph, Inputs, Program, ProgramField};
use pc_solve::{FnEvents, Integration, Method, Options, Taylor};

/// A generator of numbers in [0, 1) [Steele, Lea, Flood 2014].
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

fn options() -> Options {
    Options::new(Method::Taylor).relative_tolerance(1e-12).absolute_tolerance(1e-12)
}

/// y = t.
fn clock() -> ProgramField {
    field(|_, [_y]| [1.0.into()])
}

/// The times at which a function of y = t passes through zero up to t = 1, one step of the method.
fn passages(function: impl for<'g> Fn(Expr<'g>) -> Expr<'g>) -> Vec<f64> {
    let graph = Graph::new();
    let y = graph.symbol("y");
    let inputs = Inputs { time: None, state: vec![y], parameters: Vec::new() };
    let program = Program::new(&graph, &inputs, &[function(y)]).unwrap();
    let motion = Integration::of(Taylor::new(clock(), 0.0, &[0.0], &options().stop_time(1.0)).unwrap());
    let mut motion = motion.with_events(ProgramEvents::new(program)).unwrap();
    let mut times = Vec::new();
    motion
        .advance_to(1.0, |occurrence| {
            times.push(occurrence.time);
            ControlFlow::Continue(())
        })
        .unwrap();
    assert_eq!(motion.statistics().steps, 1);
    times
}

#[test]
fn no_root_of_a_polynomial_in_a_step_is_lost() {
    let mut random = Random(5);
    for case in 0..700 {
        // Single roots, pairs as close as 10⁻⁷ and double ones, all well apart from each other.
        let count = 1 + (random.next() * 5.0) as usize;
        let (mut factors, mut odd) = (Vec::new(), Vec::new());
        for i in 0..count {
            let place = (i as f64 + 0.15 + 0.7 * random.next()) / count as f64;
            match (random.next() * 3.0) as usize {
                0 => {
                    factors.push(place);
                    odd.push(place);
                }
                1 => factors.extend([place; 2]),
                _ => {
                    let gap = 10.0_f64.powf(-2.0 - 5.0 * random.next());
                    factors.extend([place, place + gap]);
                    odd.extend([place, place + gap]);
                }
            }
        }
        // As products, so that rounding does not move the roots.
        let found =
            passages(|y| factors.iter().fold(1.0.into(), |product: Expr<'_>, &root| product * (y - root)));
        assert_eq!(found.len(), odd.len(), "case {case}: {found:?} for {odd:?} of {factors:?}");
        for (found, root) in found.iter().zip(&odd) {
            assert!((found - root).abs() < 1e-13, "case {case}: {found} for {root}");
        }
    }
}

#[test]
fn no_root_of_a_sine_in_a_step_is_lost() {
    let mut random = Random(7);
    for case in 0..300 {
        // sin(ω y + φ) = c, with c near 1 in half of the cases: pairs of roots 2 arccos(c)/ω apart.
        let frequency = 1.0 + 200.0 * random.next();
        let phase = 6.0 * random.next();
        let level = match case % 2 {
            0 => 1.0 - 10.0_f64.powf(-2.0 - 8.0 * random.next()),
            _ => 2.0 * random.next() - 1.0,
        };
        let angle = level.asin();
        let turn = 2.0 * std::f64::consts::PI;
        let mut expected: Vec<f64> = (-2..40)
            .flat_map(|k| [angle, std::f64::consts::PI - angle].map(|angle| angle + turn * f64::from(k)))
            .map(|angle| (angle - phase) / frequency)
            .filter(|root| *root > 1e-9 && *root < 1.0 - 1e-9)
            .collect();
        expected.sort_by(f64::total_cmp);
        let found = passages(|y| (y * frequency + phase).sin() - level);
        let found: Vec<f64> = found.into_iter().filter(|root| *root > 1e-9 && *root < 1.0 - 1e-9).collect();
        assert_eq!(found.len(), expected.len(), "case {case}: {found:?} for {expected:?}");
        for (found, root) in found.iter().zip(&expected) {
            // Where the sine is flat, ε of it is the root of ε of its argument.
            assert!((found - root).abs() < 1e-6, "case {case}: {found} for {root}");
        }
    }
}

#[test]
fn several_functions_along_a_curved_motion_are_followed_together() {
    // x = cos t: x = 0.999999, x = −0.999999 and t² = 20.
    let functions = program(|t, [x, _v]| [x - 0.999_999, x + 0.999_999, t * t - 20.0]);
    let oscillator = field(|_, [x, v]| [v, -x]);
    let motion = Integration::of(Taylor::new(oscillator, 0.0, &[1.0, 0.0], &options()).unwrap());
    let mut motion = motion.with_events(ProgramEvents::new(functions)).unwrap();
    let mut found = [Vec::new(), Vec::new(), Vec::new()];
    motion
        .advance_to(10.0, |occurrence| {
            found[occurrence.event].push(occurrence.time);
            ControlFlow::Continue(())
        })
        .unwrap();
    let near = 0.999_999_f64.acos();
    let (half, turn) = (std::f64::consts::PI, 2.0 * std::f64::consts::PI);
    let expected = [
        vec![near, turn - near, turn + near],
        vec![half - near, half + near, 3.0 * half - near, 3.0 * half + near],
        vec![20.0_f64.sqrt()],
    ];
    for (found, expected) in found.iter().zip(&expected) {
        assert_eq!(found.len(), expected.len(), "{found:?} for {expected:?}");
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-9), "{found:?} for {expected:?}");
    }
}

#[test]
fn a_bouncing_ball_is_that_of_the_closed_form() {
    // From the height 1 without speed; each bounce takes a part of it.
    let (g, part) = (9.81, 0.8);
    let ball = || ProgramField::new(program(|_, [_z, v]| [v, (-g).into()]), Vec::new(), Backend::Fastest);
    let bounce = FnEvents::new().with_reset(
        Event::new("bounce").falling(),
        |_t, y| Ok(y[0]),
        move |_t, y| {
            y[1] *= -part;
            Ok(())
        },
    );
    let motion = Integration::of(Taylor::new(ball(), 0.0, &[1.0, 0.0], &options()).unwrap());
    let mut motion = motion.with_events(bounce).unwrap();
    let mut times = Vec::new();
    motion
        .advance_to(3.0, |occurrence| {
            times.push(occurrence.time);
            ControlFlow::Continue(())
        })
        .unwrap();
    let fall = (2.0_f64 / g).sqrt();
    let mut expected = fall;
    for (i, time) in times.iter().enumerate() {
        assert!((time - expected).abs() < 1e-13, "bounce {i}: {time}, not {expected}");
        expected += 2.0 * fall * part.powi(i as i32 + 1);
    }
    assert!(times.len() >= 6 && expected > 3.0, "{times:?}");
}

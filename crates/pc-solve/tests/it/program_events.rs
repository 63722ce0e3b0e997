//! Events whose functions are programs: none is missed along the polynomial of a step, however
//! close, by any method.

use std::ops::ControlFlow;

use crate::boxed::erased;
use crate::fields::{ProgramEvents, field, program};
use pc_expr::{Backend, Event, Expr, Graph, Inputs, Program, ProgramField};
use pc_solve::{Ending, FnEvents, Integration, Method, Options, Solve, Taylor};

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

fn options(method: Method) -> Options {
    Options::new(method).relative_tolerance(1e-12).absolute_tolerance(1e-12)
}

/// y = t.
fn clock() -> ProgramField {
    field(|_, [_y]| [1.0.into()])
}

/// A program of y alone.
fn of_clock(function: impl for<'g> Fn(Expr<'g>) -> Expr<'g>) -> Program {
    let graph = Graph::new();
    let y = graph.symbol("y");
    let inputs = Inputs { time: None, state: vec![y], parameters: Vec::new() };
    Program::new(&graph, &inputs, &[function(y)]).unwrap()
}

/// The times up to t = 1 at which a function of y = t passes through zero; for Taylor's method this
/// is one step.
fn passages(method: Method, function: impl for<'g> Fn(Expr<'g>) -> Expr<'g>) -> Vec<f64> {
    let events = ProgramEvents::new(of_clock(function));
    let motion =
        Solve::new(erased(clock()), 0.0, &[0.0]).method(options(method)).events(events).run(&[1.0]).unwrap();
    assert_eq!(motion.ending, Some(Ending::Completed));
    if method == Method::Taylor {
        assert_eq!(motion.trajectory.statistics().steps, 1);
    }
    motion.occurrences.iter().map(|occurrence| occurrence.time).collect()
}

/// Roots in (0, 1): all, and those of odd order. Single roots, pairs as close as 10⁻⁷ and double
/// roots, well separated from each other.
fn roots(random: &mut Random) -> (Vec<f64>, Vec<f64>) {
    let count = 1 + (random.next() * 5.0) as usize;
    let (mut all, mut odd) = (Vec::new(), Vec::new());
    for i in 0..count {
        let place = (i as f64 + 0.15 + 0.7 * random.next()) / count as f64;
        match (random.next() * 3.0) as usize {
            0 => {
                all.push(place);
                odd.push(place);
            }
            1 => all.extend([place; 2]),
            _ => {
                let gap = 10.0_f64.powf(-2.0 - 5.0 * random.next());
                all.extend([place, place + gap]);
                odd.extend([place, place + gap]);
            }
        }
    }
    (all, odd)
}

#[test]
fn no_root_of_a_polynomial_in_a_step_is_lost() {
    for method in Method::ALL {
        let mut random = Random(5);
        for case in 0..700 {
            let (all, odd) = roots(&mut random);
            // In factors, so that rounding does not move the roots.
            let found = passages(method, |y| {
                all.iter().fold(1.0.into(), |product: Expr<'_>, &root| product * (y - root))
            });
            assert_eq!(found.len(), odd.len(), "{method}, case {case}: {found:?} for {odd:?} of {all:?}");
            for (found, root) in found.iter().zip(&odd) {
                assert!((found - root).abs() < 1e-13, "{method}, case {case}: {found} for {root}");
            }
        }
    }
}

#[test]
fn no_root_of_a_sine_in_a_step_is_lost() {
    for method in Method::ALL {
        let mut random = Random(7);
        for case in 0..300 {
            // sin(ω y + φ) = c, with c near 1 in half of the cases: pairs of roots 2 arccos(c)/ω
            // apart.
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
            let found = passages(method, |y| (y * frequency + phase).sin() - level);
            let found: Vec<f64> =
                found.into_iter().filter(|root| *root > 1e-9 && *root < 1.0 - 1e-9).collect();
            assert_eq!(found.len(), expected.len(), "{method}, case {case}: {found:?} for {expected:?}");
            for (found, root) in found.iter().zip(&expected) {
                // Where the sine is flat, an error ε of its value is √ε in its argument.
                assert!((found - root).abs() < 1e-6, "{method}, case {case}: {found} for {root}");
            }
        }
    }
}

/// Along x = cos t, the roots of a polynomial of x at their arc cosines, with the steps of the
/// method.
#[test]
fn no_root_along_a_curved_motion_is_lost() {
    for method in Method::ALL {
        let mut random = Random(11);
        for case in 0..100 {
            let (all, odd) = roots(&mut random);
            let product = program(|_, [x, _v]| {
                [all.iter().fold(1.0.into(), |product: Expr<'_>, &root| product * (x - root))]
            });
            let oscillator = field(|_, [x, v]| [v, -x]);
            let motion = Solve::new(erased(oscillator), 0.0, &[1.0, 0.0])
                .method(options(method))
                .events(ProgramEvents::new(product))
                .run(&[1.6])
                .unwrap();
            // Double roots of x are touched, or passed twice within the error of x.
            let found: Vec<f64> = motion.occurrences.iter().map(|occurrence| occurrence.time).collect();
            for root in &odd {
                let near = found.iter().filter(|time| (time.cos() - root).abs() < 1e-8).count();
                assert_eq!(near, 1, "{method}, case {case}: {found:?} for {odd:?} of {all:?}");
            }
            for time in &found {
                let near = all.iter().any(|root| (time.cos() - root).abs() < 1e-5);
                assert!(near, "{method}, case {case}: {time} in {found:?} for {all:?}");
            }
        }
    }
}

/// 3183 roots in ten units of time, hundreds in one step.
#[test]
fn a_function_may_be_much_faster_than_the_motion() {
    for method in Method::ALL {
        let beat = ProgramEvents::new(of_clock(|y| (y * 1000.0).sin()));
        let options = options(method);
        let motion =
            Solve::new(erased(clock()), 0.0, &[0.0]).method(options).events(beat).run(&[10.0]).unwrap();
        assert_eq!(motion.occurrences.len(), 3183, "{method}");
        for (n, occurrence) in (1..).zip(&motion.occurrences) {
            let expected = f64::from(n) * std::f64::consts::PI / 1000.0;
            assert!((occurrence.time - expected).abs() < 1e-12, "{method}: {} {expected}", occurrence.time);
        }
    }
}

#[test]
fn several_functions_along_a_curved_motion_are_followed_together() {
    // x = cos t: x = 0.999999, x = −0.999999 and t² = 20.
    let functions = program(|t, [x, _v]| [x - 0.999_999, x + 0.999_999, t * t - 20.0]);
    let oscillator = field(|_, [x, v]| [v, -x]);
    let motion =
        Integration::of(Taylor::new(oscillator, 0.0, &[1.0, 0.0], &options(Method::Taylor)).unwrap());
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
fn a_bouncing_ball_agrees_with_the_closed_form() {
    // From rest at height 1; each bounce keeps the fraction `part` of the speed.
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
    let motion = Integration::of(Taylor::new(ball(), 0.0, &[1.0, 0.0], &options(Method::Taylor)).unwrap());
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

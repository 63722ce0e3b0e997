use std::sync::Arc;

use crate::time_profile::profile::*;
use crate::{Expr, Graph, Inputs, Interpreter, Kernel, PolynomialMotion, Program, SteepFunctions};

/// A function of (t, y).
type Pulse = Box<dyn for<'g> Fn(&'g Graph, Expr<'g>, Expr<'g>) -> Expr<'g>>;

fn program(rate: impl for<'g> Fn(&'g Graph, Expr<'g>, Expr<'g>) -> Expr<'g>) -> Program {
    let graph = Graph::new();
    let [t, y] = graph.symbols(["t", "y"]);
    let rate = rate(&graph, t, y);
    Program::new(&graph, &Inputs { time: Some(t), state: vec![y], parameters: vec![] }, &[rate]).unwrap()
}

fn profile(program: &Program) -> TimeProfile {
    match TimeDependence::of(&[program], 1, &[]) {
        TimeDependence::Known(profile) => *profile,
        other => panic!("{other:?}"),
    }
}

/// Where a program hides something between two times, along the motion that rests at y = 0.
fn found(program: &Program, from: f64, to: f64) -> Vec<f64> {
    let of_time = profile(program).surprises((from, to), to, false).clone();
    let rest = PolynomialMotion { start: from, coefficients: &[0.0, 0.0] };
    let steep = SteepFunctions::of(&[program], 1, &[]);
    let of_state =
        steep.map(|mut steep| steep.surprises((from, to), rest, false).clone()).unwrap_or_default();
    [of_time.few, of_time.many, of_state.few, of_state.many].concat()
}

#[test]
fn a_field_without_time_has_no_profile() {
    let program = program(|_, _, y| -y.sin());
    assert!(matches!(TimeDependence::of(&[&program], 1, &[]), TimeDependence::Absent));
}

/// A pulse of any form and length is noticed near its middle.
#[test]
fn pulses_are_found_however_short() {
    for width in [1e-1, 1e-3, 1e-5, 1e-8] {
        for at in [0.123_456_7, 3.0, 5.0, 7.5, 9.99] {
            let pulses: [(&str, Pulse); 8] = [
                ("Gauss", Box::new(move |_, t, y| (-((t - at) / width).square()).exp() - y)),
                ("Lorentz", Box::new(move |_, t, y| 1.0 / (1.0 + ((t - at) / width).square()) - y)),
                ("cusp", Box::new(move |_, t, y| y - (-((t - at) / width).abs()).exp())),
                (
                    "box",
                    Box::new(move |_, t, y| {
                        let edge = |shift: f64| ((t - at) * (1e3 / width) + shift).tanh();
                        y + edge(1e3) - edge(-1e3)
                    }),
                ),
                (
                    "switch",
                    Box::new(move |graph, t, y| {
                        let on = |from: f64| (t - from).step(1.0, 0.0);
                        graph.sum([on(at - 0.5 * width) * (1.0 + y), -on(at + 0.5 * width) * (1.0 + y)])
                    }),
                ),
                ("triangle", Box::new(move |_, t, y| (1.0 - ((t - at) / width).abs()).max(0.0) * (y + 1.0))),
                (
                    "product",
                    Box::new(move |_, t, y| {
                        (1.0 + ((t - at) / width + 1.0).tanh())
                            * (1.0 - ((t - at) / width - 1.0).tanh())
                            * (y + 2.0)
                    }),
                ),
                ("moving", Box::new(move |_, t, y| (-((t - y - at) / width).square()).exp())),
            ];
            for (name, pulse) in pulses {
                let program = program(|graph, t, y| pulse(graph, t, y));
                let mut f = Interpreter::new(Arc::new(program.clone()));
                let mut value = |t: f64| {
                    let mut rate = [0.0];
                    f.eval(t, &[0.0], &[], &mut rate);
                    rate[0]
                };
                let background = value(at + 0.5e4 * width.max(1e-4));
                for (from, to) in [(0.0, 10.0), (10.0, 0.0), (at - 10.0 * width, at + 5.0 * width)] {
                    let times = found(&program, from, to);
                    // Values at an end are visible there.
                    let mut at_ends = [from, to].into_iter().map(&mut value);
                    let seen = at_ends.any(|end| (end - background).abs() > 0.1)
                        || times.iter().any(|&t| (value(t) - background).abs() > 0.3);
                    assert!(seen, "{name} of width {width} at {at} from {from} to {to}: {times:?}");
                    assert!(times.len() < 60, "{name}: {}", times.len());
                }
            }
        }
    }
}

/// An oscillation resolved by the steps is not examined.
#[test]
fn features_resolved_by_steps_are_not_examined() {
    let program = program(|_, t, y| t.sin() + (0.3 * t).cos() * y - t * t);
    let mut profile = profile(&program);
    let (mut t, mut count) = (0.0, 0);
    while t < 100.0 {
        let found = profile.surprises((t, t + 0.7), 100.0, false);
        assert_eq!(found.many, []);
        count += found.few.len();
        t += 0.7;
    }
    assert!(count < 10, "{count}");
    assert!(profile.surprises((t, t + 20.0), 200.0, false).few.len() >= 10);
}

/// Among thousands of features, all are known up to a stated time.
#[test]
fn a_fast_oscillation_is_known_piece_by_piece() {
    let program = program(|_, t, y| (1e6 * t).sin() + y);
    let mut profile = profile(&program);
    let found = profile.surprises((0.0, 10.0), 10.0, false);
    let until = found.until.unwrap();
    assert!(until > 1e-4 && until < 1.0 && found.many.len() > 300, "{until} {}", found.many.len());
    assert!(found.many.iter().all(|&t| t <= until));
    assert_eq!(profile.surprises((0.0, 10.0), 10.0, true).until, None);
}

/// A function that turns faster than floating-point times resolve is reported as noise and no longer examined
/// closely. Any number of jumps is not noise.
#[test]
fn features_beyond_the_resolution_of_time_are_noise() {
    let noise = program(|_, t, y| (1e21 * t).sin() + y);
    let mut of_noise = profile(&noise);
    let found = of_noise.surprises((0.0, 1.0), 10.0, false);
    assert!(found.noise && found.until.is_some_and(|until| until < 1e-6), "{:?}", found.until);
    let later = of_noise.surprises((1e-6, 1.0), 10.0, false);
    assert_eq!((later.noise, later.until), (true, None));
    assert!(later.few.len() + later.many.len() < 100);
    let square = program(|_, t, y| (300.0 * t).sin().sign() + y);
    let found = profile(&square).surprises((0.0, 10.0), 10.0, false).clone();
    assert!(!found.noise && found.many.len() > 100, "{}", found.many.len());
}

/// A peak of any form and width is noticed where a motion passes over it, forwards and backwards, on a line and on a
/// parabola.
#[test]
fn peaks_in_the_state_are_found_however_narrow() {
    for width in [1e-1, 1e-3, 1e-5, 1e-8] {
        let peaks: [(&str, Pulse); 7] = [
            ("Gauss", Box::new(move |_, _, y| (-((y - 5.0) / width).square()).exp())),
            ("Lorentz", Box::new(move |_, _, y| 1.0 / (1.0 + ((y - 5.0) / width).square()))),
            ("power", Box::new(move |_, _, y| (1.0 + ((y - 5.0) / width).square()).pow(-1.5))),
            ("soliton", Box::new(move |_, _, y| 1.0 / ((y - 5.0) / width).cosh().square())),
            (
                "box",
                Box::new(move |_, _, y| ((y - 5.0) / width + 1.0).tanh() - ((y - 5.0) / width - 1.0).tanh()),
            ),
            (
                "force of a soliton",
                Box::new(move |_, _, y| {
                    let u = (y - 5.0) / width;
                    3.0 * u.sinh() / u.cosh().square() / u.cosh()
                }),
            ),
            (
                "logistic box",
                Box::new(move |_, _, y| {
                    let rise = |shift: f64| 1.0 / (1.0 + ((y - 5.0) / -width + shift).exp());
                    rise(1.0) - rise(-1.0)
                }),
            ),
        ];
        for (name, peak) in peaks {
            let program = program(|graph, t, y| peak(graph, t, y));
            let mut f = Interpreter::new(Arc::new(program.clone()));
            for path in [&[0.0, 1.0][..], &[0.0, 0.4, 0.06], &[10.0, -0.7, -0.05]] {
                let state = |t: f64| path.iter().rev().fold(0.0, |y, c| y * t + c);
                let mut steep = SteepFunctions::of(&[&program], 1, &[]).unwrap();
                let motion = PolynomialMotion { start: 0.0, coefficients: path };
                let times = steep.surprises((0.0, 10.0), motion, false).few.clone();
                let mut rate = [0.0];
                let seen = times.iter().any(|&t| {
                    f.eval(t, &[state(t)], &[], &mut rate);
                    rate[0].abs() > 0.3
                });
                assert!(seen && times.len() < 20, "{name} of width {width} along {path:?}: {times:?}");
            }
        }
    }
}

/// Functions without a scale of their own, and those whose change any step feels, are not followed.
/// Each step of a motion that goes wild would take as many evaluations as a query may.
#[test]
fn queries_that_find_too_much_again_and_again_look_at_less() {
    let program = program(|_, _, y| (-(1e3 * (1e8 * y).sin()).square()).exp());
    let mut steep = SteepFunctions::of(&[&program], 1, &[]).unwrap();
    let mut known = |speed: f64| {
        let motion = PolynomialMotion { start: 0.0, coefficients: &[0.1, speed] };
        steep.surprises((0.0, 1.0), motion, false).until.unwrap_or(1.0)
    };
    let (calm, first) = (known(1e-10), known(1.0));
    assert!(calm == 1.0 && first < 1.0, "{calm} {first}");
    let later: Vec<f64> = (0..10).map(|_| known(1.0)).collect();
    assert!(
        later.is_sorted_by(|a, b| a >= b) && later[9] < 0.1 * first && later[9] > 0.0,
        "{first} {later:?}"
    );
    for _ in 0..10 {
        assert_eq!(known(1e-10), 1.0);
    }
    assert_eq!(known(1.0), first);
}

#[test]
fn gentle_functions_of_the_state_are_not_followed() {
    let gentle: [Pulse; 6] = [
        Box::new(|_, _, y| y.sin() / (2.0 + y.cos())),
        Box::new(|_, _, y| 1.0 / y.square()),
        Box::new(|_, _, y| y.square() * (1.0 + y.square()).sqrt()),
        Box::new(|_, _, y| (0.5 * y.sin()).exp()),
        Box::new(|_, _, y| (0.1 * y.cos()).tanh()),
        Box::new(|_, t, y| (-((t - 5.0) / 1e-3).square()).exp() - y),
    ];
    for (i, gentle) in gentle.into_iter().enumerate() {
        let program = program(|graph, t, y| gentle(graph, t, y));
        assert!(SteepFunctions::of(&[&program], 1, &[]).is_none(), "{i}");
    }
}

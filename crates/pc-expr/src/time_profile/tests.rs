use std::sync::Arc;

use crate::time_profile::profile::*;
use crate::{Expr, Graph, Inputs, Interpreter, Kernel, Program};

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

fn found(program: &Program, from: f64, to: f64) -> Vec<f64> {
    let found = profile(program).surprises((from, to), (&[0.0], &[0.0]), to, false).clone();
    [found.few, found.many].concat()
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
        let found = profile.surprises((t, t + 0.7), (&[0.0], &[0.0]), 100.0, false);
        assert_eq!(found.many, []);
        count += found.few.len();
        t += 0.7;
    }
    assert!(count < 10, "{count}");
    assert!(profile.surprises((t, t + 20.0), (&[0.0], &[0.0]), 200.0, false).few.len() >= 10);
}

/// Among thousands of features, all are known up to a stated time.
#[test]
fn a_fast_oscillation_is_known_piece_by_piece() {
    let program = program(|_, t, y| (1e6 * t).sin() + y);
    let mut profile = profile(&program);
    let found = profile.surprises((0.0, 10.0), (&[0.0], &[0.0]), 10.0, false);
    let until = found.until.unwrap();
    assert!(until > 1e-4 && until < 1.0 && found.many.len() > 300, "{until} {}", found.many.len());
    assert!(found.many.iter().all(|&t| t <= until));
    assert_eq!(profile.surprises((0.0, 10.0), (&[0.0], &[0.0]), 10.0, true).until, None);
}

/// A function that turns faster than floating-point times resolve is reported as noise and no longer examined
/// closely. Any number of jumps is not noise.
#[test]
fn features_beyond_the_resolution_of_time_are_noise() {
    let noise = program(|_, t, y| (1e21 * t).sin() + y);
    let mut of_noise = profile(&noise);
    let found = of_noise.surprises((0.0, 1.0), (&[0.0], &[0.0]), 10.0, false);
    assert!(found.noise && found.until.is_some_and(|until| until < 1e-6), "{:?}", found.until);
    let later = of_noise.surprises((1e-6, 1.0), (&[0.0], &[0.0]), 10.0, false);
    assert_eq!((later.noise, later.until), (true, None));
    assert!(later.few.len() + later.many.len() < 100);
    let square = program(|_, t, y| (300.0 * t).sin().sign() + y);
    let found = profile(&square).surprises((0.0, 10.0), (&[0.0], &[0.0]), 10.0, false).clone();
    assert!(!found.noise && found.many.len() > 100, "{}", found.many.len());
}

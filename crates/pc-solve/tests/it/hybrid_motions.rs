//! Motions with resets by all methods: the same to 1e-10, and to the last bit after a checkpoint.

use std::num::NonZeroU64;
use std::ops::ControlFlow::Continue;

use crate::boxed::erased;
use crate::fields::{ProgramEvents, field, program};
use pc_expr::{Event, ProgramField};
use pc_solve::{Checkpoint, Method, Options, Resumable, Solution, Solve};

/// Field and events.
type Parts = fn() -> (ProgramField, ProgramEvents);

/// A ball under gravity 1 that keeps 0.8 of its speed in a bounce.
fn ball() -> (ProgramField, ProgramEvents) {
    let bounce = program(|_, [y, _v]| [y]);
    (
        field(|_, [_y, v]| [v, (-1.0).into()]),
        ProgramEvents::with(bounce, vec![(Event::new("bounce").falling(), Some(|y| y[1] *= -0.8))]),
    )
}

/// A block on a floor, pulled by a spring whose end moves at speed 1/2: y = (x, v, σ) with σ = 1
/// where it slips, by x″ = 0.5 t − x − 0.5. It sticks when v reaches 0, until the force of the
/// spring is 1.
fn block() -> (ProgramField, ProgramEvents) {
    let functions = program(|t, [x, v, _s]| [t * 0.5 - x - 1.0, v]);
    let slip = |y: &mut [f64]| y[2] = 1.0;
    let stick = |y: &mut [f64]| (y[1], y[2]) = (0.0, 0.0);
    (
        field(|t, [x, v, s]| [v, s * (t * 0.5 - x - 0.5), 0.0.into()]),
        ProgramEvents::with(
            functions,
            vec![(Event::new("slip").rising(), Some(slip)), (Event::new("stick").falling(), Some(stick))],
        ),
    )
}

fn sharp(method: Method) -> Options {
    Options::new(method).relative_tolerance(1e-13).absolute_tolerance(1e-15)
}

fn run(parts: Parts, y0: &[f64], times: &[f64], options: &Options) -> Solution {
    let (field, events) = parts();
    Solve::new(erased(field), 0.0, y0).method(options).events(events).run(times).unwrap()
}

/// The first landing is at √2, the following flights take 2√2 · 0.8ⁿ.
#[test]
fn a_ball_bounces_alike_by_all_methods() {
    for method in Method::ALL {
        let motion = run(ball, &[1.0, 0.0], &[2.0, 6.0], &sharp(method));
        let (mut landing, mut flight) = (2.0_f64.sqrt(), 2.0 * 2.0_f64.sqrt() * 0.8);
        assert!(motion.occurrences.len() >= 3, "{method}: {motion:?}");
        for occurrence in &motion.occurrences {
            assert!((occurrence.time - landing).abs() < 1e-10, "{method}: {} {landing}", occurrence.time);
            landing += flight;
            flight *= 0.8;
        }
        assert!(landing > 6.0, "{method}: none is missing");
    }
}

/// From x = −1 at rest it slips by x = 0.5 t − 0.5 − ½ (cos t + sin t), hence v = ½ (1 + sin
/// t − cos t), until t = 3π/2; it then stays until 0.5 t − x = 1, and so on.
#[test]
fn a_block_sticks_and_slips_alike_by_all_methods() {
    let slip = 1.5 * std::f64::consts::PI;
    let at = 0.5 * slip - 0.5 - 0.5 * (slip.cos() + slip.sin());
    let stop = 2.0 * (1.0 + at) - slip;
    for method in Method::ALL {
        let motion = run(block, &[-1.0, 0.0, 1.0], &[20.0], &sharp(method));
        let times: Vec<f64> = motion.occurrences.iter().map(|occurrence| occurrence.time).collect();
        let events: Vec<usize> = motion.occurrences.iter().map(|occurrence| occurrence.event).collect();
        assert_eq!(events, [1, 0, 1, 0, 1], "{method}: {times:?}");
        for (k, time) in times.iter().enumerate() {
            let expected = (k.div_ceil(2)) as f64 * stop + (k / 2 + 1) as f64 * slip;
            assert!((time - expected).abs() < 1e-10, "{method}: {time} is not {expected}");
        }
    }
}

#[test]
fn checkpoints_change_no_bit() {
    let cases: [(Parts, &[f64], &[f64]); 2] =
        [(ball, &[1.0, 0.0], &[2.0, 4.0, 6.0]), (block, &[-1.0, 0.0, 1.0], &[5.0, 15.0, 20.0])];
    for (parts, y0, times) in cases {
        for method in Method::ALL {
            let options =
                Options::new(method).relative_tolerance(1e-5).absolute_tolerance(1e-7).max_step(0.2);
            let every = NonZeroU64::new(10).unwrap();
            let mut kept = Vec::new();
            let save = |checkpoint: &Checkpoint, _| kept.push(checkpoint.to_bytes("a label"));
            let start = Checkpoint::start(0.0, y0);
            let whole = Resumable::new(parts, start)
                .method(&options)
                .every(every)
                .run(times, save, |_, _| Continue(()))
                .unwrap();
            assert!(kept.len() > 3 && whole.occurrences.len() >= 3, "{method}: {}", kept.len());
            let stride = kept.len().div_ceil(15);
            for bytes in kept.iter().step_by(stride) {
                let (from, _) = Checkpoint::from_bytes(bytes).unwrap();
                let later = Resumable::new(parts, from).method(&options).every(every).run(
                    times,
                    |_, _| (),
                    |_, _| Continue(()),
                );
                assert_eq!(later.unwrap(), whole, "{method}");
            }
        }
    }
}

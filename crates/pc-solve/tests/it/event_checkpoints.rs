//! Checkpoints of motions with events: the same numbers, occurrences and ending to the last bit.
use std::num::NonZeroU64;
use std::ops::ControlFlow::{self, Break, Continue};

use crate::boxed::from_fn;
use pc_solve::{
    Checkpoint, CheckpointError, Code, Cvode, Ending, Event, Failure, FnEvents, InputError, Integration,
    Method, NoEvents, Observed, Occurrence, Options, Reason, Resumable, Sensitivities, Solution, Solve,
    SolveError, SolveFailure, VectorField,
};

type Rates = fn(f64, &[f64], &mut [f64]);
type Parts = (Rates, fn() -> FnEvents<'static>);

fn field(rates: Rates, dim: usize) -> impl VectorField {
    from_fn(dim, move |t, y: &[f64], ydot: &mut [f64]| {
        rates(t, y, ydot);
        Ok(())
    })
}

fn every(steps: u64) -> NonZeroU64 {
    NonZeroU64::new(steps).unwrap()
}

const GO_ON: fn(f64, &[f64]) -> ControlFlow<()> = |_, _| Continue(());

/// A ball under gravity 1 that keeps 0.9 of its speed in a bounce.
const BALL: Parts = (
    |_, y, ydot| ydot.copy_from_slice(&[y[1], -1.0]),
    || {
        FnEvents::new().with_reset(
            Event::new("bounce").falling(),
            |_, y| Ok(y[0]),
            |_, y| {
                y[1] *= -0.9;
                Ok(())
            },
        )
    },
);

/// A block on a belt, y = (x, v, σ): σ = 1 where it slips.
const BLOCK: Parts = (
    |t, y, ydot| ydot.copy_from_slice(&[y[1], y[2] * (0.5 * t - y[0] - 0.5), 0.0]),
    || {
        FnEvents::new()
            .with_reset(
                Event::new("slip").rising(),
                |t, y| Ok(0.5 * t - y[0] - 1.0),
                |_, y| {
                    y[2] = 1.0;
                    Ok(())
                },
            )
            .with_reset(
                Event::new("stick").falling(),
                |_, y| Ok(y[1]),
                |_, y| {
                    (y[1], y[2]) = (0.0, 0.0);
                    Ok(())
                },
            )
    },
);

/// An oscillator with zeros that change nothing; two occur at once, one of a coordinate that is
/// always zero.
const WATCHED: Parts = (
    |_, y, ydot| ydot.copy_from_slice(&[y[1], -y[0], 0.0]),
    || {
        FnEvents::new()
            .with(Event::new("both"), |_, y| Ok(y[0]))
            .with(Event::new("rising").rising(), |_, y| Ok(2.0 * y[0]))
            .with(Event::new("turn"), |_, y| Ok(y[1]))
            .with(Event::new("never"), |_, y| Ok(y[2]))
    },
);

/// [`WATCHED`] with a terminal event.
const ENDED: Parts =
    (WATCHED.0, || (WATCHED.1)().with(Event::new("end").terminal(true), |t, y| Ok(y[0] + 0.05 * t - 0.9)));

fn solve(
    (rates, events): Parts,
    from: Checkpoint,
    times: &[f64],
    options: &Options,
    steps: u64,
    save: impl FnMut(&Checkpoint, bool),
) -> Result<Solution, Box<SolveFailure<Solution>>> {
    let dim = from.state().len();
    let parts = || (field(rates, dim), events());
    Resumable::new(parts, from).method(options).every(every(steps)).run(times, save, GO_ON)
}

/// Checks that up to 16 checkpoints of a motion, encoded and decoded, lead to the same motion;
/// returns it with their number.
#[track_caller]
fn goes_on(parts: Parts, y0: &[f64], times: &[f64], options: &Options, steps: u64) -> (Solution, usize) {
    let mut kept = Vec::new();
    let keep = |checkpoint: &Checkpoint, last: bool| {
        assert!(!last);
        kept.push(checkpoint.to_bytes("a label"));
    };
    let motion = solve(parts, Checkpoint::start(0.0, y0), times, options, steps, keep).unwrap();
    let stride = kept.len().div_ceil(15);
    for (n, bytes) in kept.iter().enumerate().step_by(stride).chain(kept.iter().enumerate().next_back()) {
        let (from, _) = Checkpoint::from_bytes(bytes).unwrap();
        assert_eq!(from.to_bytes("a label"), *bytes);
        let resumed = solve(parts, from, times, options, steps, |_, _| ()).unwrap();
        // Outputs, times, occurrences, ending, work: nonzero numbers that are equal have the same
        // bits.
        assert_eq!(resumed, motion, "from checkpoint {n}");
    }
    (motion, kept.len())
}

#[test]
fn a_motion_with_events_resumes_from_any_checkpoint_with_the_same_bits() {
    let block = [-1.0, 0.0, 1.0];
    let times: Vec<f64> = (0..=60).map(|i| 0.2 * f64::from(i)).collect();
    for method in [Method::Adams, Method::Bdf, Method::Dop853, Method::Auto] {
        for (steps, rtol) in [(1, 1e-3), (2, 1e-3), (7, 1e-6), (30, 1e-7), (1_000_000, 1e-7)] {
            let options = Options::new(method).relative_tolerance(rtol).absolute_tolerance(1e-2 * rtol);
            // A longer first step of each leg than the one estimated.
            let options = if steps < 7 { options.initial_step(0.02) } else { options };
            let (motion, checkpoints) = goes_on(BALL, &[1.0, 0.0], &times, &options, steps);
            assert!(motion.occurrences.len() > 4 && motion.ending == Some(Ending::Completed));
            assert!(checkpoints as u64 > motion.trajectory.statistics().steps / (steps + 1));
            let (motion, _) = goes_on(BLOCK, &block, &times, &options, steps);
            assert_eq!(motion.occurrences.len(), 3);
            let (motion, _) = goes_on(WATCHED, &[1.0, 0.0, 0.0], &times, &options, steps);
            assert_eq!(motion.occurrences.len(), 4 + 2 + 3);
            let (motion, _) = goes_on(ENDED, &[1.0, 0.0, 0.0], &times, &options, steps);
            assert_eq!(motion.ending, Some(Ending::Event { event: 4 }));
            assert_eq!(motion.trajectory.last().unwrap().0, motion.occurrences.last().unwrap().time);
        }
        // Backwards.
        goes_on(WATCHED, &[1.0, 0.0, 0.0], &[-1.0, -20.0], &Options::new(method), 20);
    }
}

/// Checkpoints change times within the tolerance only.
#[test]
fn checkpoints_leave_occurrences_where_they_are() {
    let options = Options::new(Method::Adams).relative_tolerance(1e-12).absolute_tolerance(1e-14);
    for (parts, y0) in [(BALL, &[1.0, 0.0][..]), (BLOCK, &[-1.0, 0.0, 1.0]), (WATCHED, &[1.0, 0.0, 0.0])] {
        let plain = Solve::new(field(parts.0, y0.len()), 0.0, y0)
            .method(&options)
            .events((parts.1)())
            .run(&[12.0])
            .unwrap();
        for steps in [20, 40] {
            let motion =
                solve(parts, Checkpoint::start(0.0, y0), &[12.0], &options, steps, |_, _| ()).unwrap();
            let close = plain.occurrences.iter().zip(&motion.occurrences);
            assert_eq!(plain.occurrences.len(), motion.occurrences.len());
            // Local errors of 1e-12 in some thousand steps.
            close.for_each(|(a, b)| assert!(a.event == b.event && (a.time - b.time).abs() < 1e-8));
        }
    }
}

/// The history of occurrences continues across checkpoints.
#[test]
fn occurrences_accumulate_over_checkpoints() {
    let failure = |steps| {
        let from = Checkpoint::start(0.0, &[1.0, 0.0]);
        *solve(BALL, from, &[1.0, 100.0], &Options::new(Method::Adams), steps, |_, _| ()).unwrap_err()
    };
    let reason = |failure: SolveFailure<Solution>| match failure.error {
        SolveError::Integration(error) => (error.reason, failure.reached),
        other => panic!("{other}"),
    };
    let (Reason::Accumulation { occurrences: expected, .. }, _) = reason(failure(1_000_000)) else {
        panic!()
    };
    for steps in [10, 30] {
        let (Reason::Accumulation { event, occurrences, t }, reached) = reason(failure(steps)) else {
            panic!()
        };
        assert_eq!((event.as_str(), occurrences, reached.ending), ("bounce", expected, None));
        assert_eq!(reached.occurrences.len() as u64, expected);
        // √2 (1 + e)/(1 − e); local errors of 1e-9 in some ten thousand steps, of low order after
        // each checkpoint.
        assert!((t - 19.0 * 2.0_f64.sqrt()).abs() < 1e-3, "{t}");
    }
}

/// Where an observer stops it: between events, just after one, and at one still to be applied.
#[test]
fn an_integration_resumes_from_any_time() {
    let options = Options::new(Method::Adams);
    let start = |parts: Parts, y0: &[f64]| {
        Integration::new(field(parts.0, y0.len()), 0.0, y0, &options)
            .unwrap()
            .with_events((parts.1)())
            .unwrap()
    };
    let (landing, end) = (2.0_f64.sqrt(), 8.0);
    let plain = Solve::new(field(BALL.0, 2), 0.0, &[1.0, 0.0])
        .method(&options)
        .events((BALL.1)())
        .run(&[end])
        .unwrap();
    let rest = |from: &Checkpoint, met: usize| {
        let mut hybrid = Integration::resume(field(BALL.0, 2), from, &options)
            .and_then(|resumed| resumed.with_events_of((BALL.1)(), from))
            .unwrap();
        assert_eq!((hybrid.time(), hybrid.state()), (from.time(), from.state()));
        let mut seen = Vec::new();
        let ending = hybrid.advance_to(end, |occurrence| {
            seen.push(occurrence.time);
            Continue(())
        });
        assert_eq!(ending.unwrap(), Ending::Completed);
        let expected = &plain.occurrences[met..];
        assert_eq!(seen.len(), expected.len(), "{seen:?} {expected:?}");
        // rtol 1e-9, over some hundred steps.
        seen.iter().zip(expected).for_each(|(t, expected)| assert!((t - expected.time).abs() < 1e-6));
        (seen, hybrid.state().to_vec())
    };
    for after in [0.3, 1.0, 1e-3, 1e-9, 3e-15, 0.0] {
        let mut hybrid = start(BALL, &[1.0, 0.0]);
        hybrid.advance_to(plain.occurrences[0].time + after, |_| Continue(())).unwrap();
        rest(&hybrid.checkpoint(), 1);
    }
    let mut hybrid = start(BALL, &[1.0, 0.0]);
    let mut due = 0;
    loop {
        // Step by step.
        let ending = hybrid.run_observed(
            &[end],
            Observed::new(|_, _| Continue(())).occurrences(|_| Continue(())).steps(|_, _| Break(())),
        );
        if ending.unwrap() == Ending::Completed || hybrid.time() > 3.0 {
            break;
        }
        let from = hybrid.checkpoint();
        let (read, _) = Checkpoint::from_bytes(&from.to_bytes("")).unwrap();
        assert_eq!(read, from);
        let falls = from.state()[1] < 0.0;
        let is_due = falls && (from.time() - landing).abs() < 1e-9;
        let met = usize::from(from.time() > landing - 1e-9 && !is_due);
        let later = rest(&from, met);
        assert_eq!(later, rest(&read, met));
        assert!(!is_due || later.0[0] == from.time(), "it is not looked for again");
        due += u32::from(is_due);
    }
    assert!(due > 0, "the bounce is due where the step before it ends");
}

/// The zeros of a piecewise constant function of time with these values from 0, 0.45, 0.54, 0.6 and
/// 0.7 on: found by resuming from a checkpoint at each event, and from a single checkpoint at 0.55.
fn zeros_of(values: [f64; 5]) -> [Vec<f64>; 2] {
    let events = || {
        FnEvents::new().with(Event::new("zero"), move |t, _| {
            Ok(values[[0.45, 0.54, 0.6, 0.7].iter().filter(|&&from| t >= from).count()])
        })
    };
    // One step to the end.
    let (still, options) =
        (|| field(|_, _, ydot| ydot.fill(0.0), 1), Options::new(Method::Adams).initial_step(1.0));
    let start = || Integration::new(still(), 0.0, &[1.0], &options).unwrap().with_events(events()).unwrap();
    let (mut found, mut hybrid) = ([Vec::new(), Vec::new()], start());
    let mut to = |hybrid: &mut Integration<Cvode<_>, _>, t, part: usize| {
        let see = |occurrence: &Occurrence| {
            found[part].push((1e12 * occurrence.time).round() / 1e12);
            Break(())
        };
        hybrid.advance_to(t, see).unwrap()
    };
    while to(&mut hybrid, 1.0, 0) == Ending::Stopped {
        hybrid = Integration::resume(still(), &hybrid.checkpoint(), &options)
            .and_then(|resumed| resumed.with_events_of(events(), &hybrid.checkpoint()))
            .unwrap();
    }
    let mut hybrid = start();
    while to(&mut hybrid, 0.55, 1) == Ending::Stopped {}
    let mut hybrid = Integration::resume(still(), &hybrid.checkpoint(), &options)
        .and_then(|resumed| resumed.with_events_of(events(), &hybrid.checkpoint()))
        .unwrap();
    while to(&mut hybrid, 1.0, 1) == Ending::Stopped {}
    found
}

/// After a passage a function has to exceed the rounding of its values on both sides before it can
/// pass again, but its side is known.
#[test]
fn functions_near_zero_stay_on_their_sides() {
    let (near, nearer) = (1e-30, 1e-31);
    for values in [[-near, near, -nearer, 1.0, 1.0], [near, -near, nearer, -1.0, -1.0]] {
        assert_eq!(zeros_of(values), [[0.45], [0.45]]);
    }
    for values in [[-near, near, near, near, -1.0], [near, -near, -near, -near, 1.0]] {
        assert_eq!(zeros_of(values), [[0.45, 0.7], [0.45, 0.7]]);
    }
}

#[test]
fn a_stopped_or_failed_motion_leaves_its_last_checkpoint() {
    let (times, options) = ([0.5, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0], Options::new(Method::Adams));
    let whole = solve(BALL, Checkpoint::start(0.0, &[1.0, 0.0]), &times, &options, 10, |_, _| ()).unwrap();
    for stop in [3, 25, 57, whole.trajectory.statistics().steps] {
        let (mut steps, mut last) = (0, None);
        let keep = |checkpoint: &Checkpoint, stopped: bool| {
            if stopped {
                last = Some(checkpoint.clone());
            }
        };
        let step = |_, _: &[f64]| {
            steps += 1;
            if steps == stop { Break(()) } else { Continue(()) }
        };
        let parts = || (field(BALL.0, 2), (BALL.1)());
        let from = Checkpoint::start(0.0, &[1.0, 0.0]);
        let part = Resumable::new(parts, from).method(&options).every(every(10)).run(&times, keep, step);
        let (part, last) = (part.unwrap(), last.unwrap());
        assert_eq!(part.ending, Some(Ending::Stopped));
        assert_eq!(part.occurrences[..], whole.occurrences[..part.occurrences.len()]);
        assert_eq!(part.trajectory.times(), &times[..part.trajectory.len()]);
        assert!(last.occurrences().len() <= part.occurrences.len());
        assert!(last.outputs().len() <= part.trajectory.len());
        assert_eq!(solve(BALL, last, &times, &options, 10, |_, _| ()).unwrap(), whole);
    }
    // A reset that fails.
    let broken: Parts = (BALL.0, || {
        FnEvents::new().with_reset(
            Event::new("floor"),
            |_, y| Ok(y[0]),
            |_, _| Err(Failure::fatal(std::fmt::Error)),
        )
    });
    for steps in [5, 10] {
        let mut last = None;
        let keep = |checkpoint: &Checkpoint, failed: bool| last = Some((checkpoint.time(), failed));
        let from = Checkpoint::start(0.0, &[1.0, 0.0]);
        let failure = solve(broken, from, &times, &options, steps, keep).unwrap_err();
        assert_eq!(failure.reached.trajectory.times(), [0.5, 1.0]);
        let (t, failed) = last.unwrap();
        assert!(failed && t < 2.0_f64.sqrt() && t > 0.05, "{t}");
        assert!(failure.to_string().starts_with("the event floor cannot reset the state at t = 1.41"));
    }
}

/// The limit applies to the steps from one output to the next, across events.
#[test]
fn the_step_limit_is_that_of_a_motion_without_checkpoints() {
    let options = |most| Options::new(Method::Adams).max_step(0.01).max_steps(most);
    let (y0, times) = ([1.0, 0.0, 0.0], [20.0]);
    // 2000 steps, and some hundred more after the restarts.
    for steps in [20, 100] {
        let run =
            |most| solve(WATCHED, Checkpoint::start(0.0, &y0), &times, &options(most), steps, |_, _| ());
        assert!(run(4000).unwrap().trajectory.is_complete());
        let failure = run(1900).unwrap_err();
        assert_eq!(failure.error.code(), Some(Code::TooMuchWork));
    }
    let refused = solve(WATCHED, Checkpoint::start(0.0, &y0), &times, &options(0), 20, |_, _| ());
    assert!(matches!(refused.unwrap_err().error, SolveError::Input(InputError::MaxSteps)));
}

/// At t = 1e6, where times are 1.2e-10 apart, the first step of each leg does not advance the time;
/// the next is longer.
#[test]
fn a_step_of_length_zero_is_not_a_leg() {
    let (from, options) = (Checkpoint::start(1e6, &[1.0]), Options::new(Method::Adams).initial_step(1e-11));
    let (mut kept, mut idle, mut last) = (Vec::new(), 0, 1e6);
    let step = |t, _: &[f64]| {
        idle += u32::from(t == last);
        last = t;
        Continue(())
    };
    let decay = || field(|_, y, ydot| ydot[0] = -1e4 * y[0], 1);
    let keep = |checkpoint: &Checkpoint, _| kept.push(checkpoint.time());
    let times = [1e6 + 1e-4];
    let motion = Resumable::new(|| (decay(), NoEvents), from)
        .method(&options)
        .every(every(1))
        .run(&times, keep, step)
        .unwrap()
        .trajectory;
    assert!(idle > 100 && motion.is_complete(), "{idle}");
    assert!(kept.windows(2).all(|pair| pair[0] < pair[1]), "each checkpoint is ahead of the last");
    // The tolerance gives steps of about 5e-9, which are rounded by up to 1.2e-10, that is 1/40.
    let expected = (-1e4 * (times[0] - 1e6)).exp();
    assert!((motion.state(0)[0] - expected).abs() < expected / 40.0, "{:?}", motion.state(0));
}

#[test]
fn checkpoints_of_other_motions_are_refused() {
    let mut kept = Vec::new();
    let keep = |checkpoint: &Checkpoint, _| kept.push(checkpoint.clone());
    let (options, times) = (Options::new(Method::Adams), [5.0]);
    solve(BALL, Checkpoint::start(0.0, &[1.0, 0.0]), &times, &options, 20, keep).unwrap();
    let from = kept.pop().unwrap();
    assert!(!from.occurrences().is_empty());
    let failure = solve((BALL.0, FnEvents::new), from.clone(), &times, &options, 20, |_, _| ()).unwrap_err();
    assert!(matches!(failure.error, SolveError::Input(InputError::EventCount { expected: 0, found: 1 })));
    assert_eq!(
        failure.to_string(),
        "the checkpoint belongs to another motion: its number of events is 1, not 0"
    );

    let bytes = from.to_bytes("ball");
    for length in 0..bytes.len() {
        assert!(Checkpoint::from_bytes(&bytes[..length]).is_err(), "cut at {length}");
    }
    for bit in 0..8 * bytes.len() {
        let mut flipped = bytes.clone();
        flipped[bit / 8] ^= 1 << (bit % 8);
        assert!(Checkpoint::from_bytes(&flipped).is_err(), "bit {bit}");
    }
    // The version is checked before the rest is read.
    for (version, found) in [("1", 1), ("2", 2), ("17", 17)] {
        let other = [format!("pc checkpoint {version}\n").as_bytes(), &bytes[16..]].concat();
        let error = Checkpoint::from_bytes(&other).unwrap_err();
        assert_eq!(error, CheckpointError::Version { found });
        assert_eq!(
            error.to_string(),
            format!("it is a checkpoint of version {version} of the format, not 6")
        );
    }
}

#[test]
fn nothing_happens_beyond_the_last_output() {
    // At rest, so that the third step goes from 0.8 to 1.2, past the output and the terminal event
    // beyond it.
    let parts: Parts = (
        |_, _, ydot| ydot.fill(0.0),
        || FnEvents::new().with(Event::new("end").terminal(true), |t, _| Ok(t - 1.1)),
    );
    for steps in [1, 2, 3, 30] {
        let options = Options::new(Method::Adams).initial_step(0.4).stop_time(10.0);
        let motion =
            solve(parts, Checkpoint::start(0.0, &[1.0]), &[1.0], &options, steps, |_, _| ()).unwrap();
        assert_eq!(motion.trajectory.times(), [1.0], "{steps}");
        assert_eq!((motion.ending, motion.occurrences.len()), (Some(Ending::Completed), 0), "{steps}");
    }
}

/// The columns by the start of a bouncing ball: those of an uninterrupted motion, at the outputs and on the way, to the last
/// bit, and those of a motion without checkpoints within its tolerance.
#[test]
fn sensitivities_go_on_from_checkpoints() {
    let wanted = Sensitivities::new().by_starts([0, 1]);
    let times: Vec<f64> = (1..=8).map(|k| 0.5 * f64::from(k)).collect();
    for method in [Method::Adams, Method::Bdf, Method::Dop853] {
        let options = Options::new(method);
        // Multistep methods begin anew after each checkpoint.
        let often = every(if method == Method::Dop853 { 4 } else { 20 });
        let parts = || (field(BALL.0, 2), (BALL.1)());
        let run = |from: Checkpoint, save: &mut dyn FnMut(&Checkpoint, bool)| {
            Resumable::new(parts, from)
                .method(&options)
                .every(often)
                .sensitivities(&wanted)
                .run(&times, save, GO_ON)
                .unwrap()
        };
        let mut kept = Vec::new();
        let whole = run(Checkpoint::start(0.0, &[1.0, 0.3]), &mut |checkpoint, _| {
            kept.push(checkpoint.to_bytes(""));
        });
        for bytes in kept.iter().step_by(kept.len() / 8 + 1) {
            let from = Checkpoint::from_bytes(bytes).unwrap().0;
            assert_eq!(run(from, &mut |_, _| ()), whole, "{method}");
        }
        // On the way up from a bounce at t₁ with w = 0.9 √(v² + 2 h): y = w s − s²/2 with s = t − t₁.
        let [h, v] = [1.0, 0.3];
        let speed = f64::sqrt(v * v + 2.0 * h);
        let s = times[4] - (v + speed);
        let by_h = 0.9 / speed * s - (0.9 * speed - s) / speed;
        let by_v = 0.9 * v / speed * s - (0.9 * speed - s) * (1.0 + v / speed);
        let trajectory = &whole.trajectory;
        let found = [trajectory.column(4, 0)[0], trajectory.column(4, 1)[0]];
        assert!((found[0] - by_h).abs() < 1e-6 && (found[1] - by_v).abs() < 1e-6, "{found:?} {by_h} {by_v}");
        let begun = Checkpoint::from_bytes(&kept[kept.len() / 2]).unwrap().0;
        let fewer = Sensitivities::new().by_start(0);
        let refused = Resumable::new(parts, begun).method(&options).every(often).sensitivities(&fewer).run(
            &times,
            |_, _| (),
            GO_ON,
        );
        let error = refused.unwrap_err().error;
        assert!(
            matches!(error, SolveError::Input(InputError::Sensitivities { expected: 1, found: 2 })),
            "{error}"
        );
    }
}

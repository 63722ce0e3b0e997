//! Checkpoints of motions that conserve an integral, with jumps that change its value.
use std::num::NonZeroU64;
use std::ops::ControlFlow::Continue;

use pc_solve::{
    Checkpoint, Event, Failure, FnEvents, Integration, Method, Options, Resumable, Solution, VectorField,
};

/// A ball under gravity 1, y = (h, v), whose energy v²/2 + h is projected to a level.
#[derive(Clone)]
struct Ball {
    level: f64,
}

fn energy(y: &[f64]) -> f64 {
    y[1] * y[1] / 2.0 + y[0]
}

impl VectorField for Ball {
    fn dim(&self) -> usize {
        2
    }

    fn rhs(&mut self, _t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        ydot.copy_from_slice(&[y[1], -1.0]);
        Ok(())
    }

    fn has_projection(&self) -> bool {
        true
    }

    /// Projects along the gradient (1, v).
    fn project(&mut self, _t: f64, y: &mut [f64]) -> Result<(), Failure> {
        for _ in 0..5 {
            let part = (energy(y) - self.level) / (1.0 + y[1] * y[1]);
            y[0] -= part;
            y[1] -= part * y[1];
        }
        Ok(())
    }

    fn restart(&mut self, _t: f64, y: &[f64]) {
        self.level = energy(y);
    }
}

/// A bounce keeps 0.9 of the speed.
fn bounce() -> FnEvents<'static> {
    FnEvents::new().with_reset(
        Event::new("bounce").falling(),
        |_, y| Ok(y[0]),
        |_, y| {
            y[1] *= -0.9;
            Ok(())
        },
    )
}

const START: [f64; 2] = [1.0, 0.0];

fn solve(
    level: f64,
    from: Checkpoint,
    times: &[f64],
    options: &Options,
    steps: u64,
    save: impl FnMut(&Checkpoint, bool),
) -> Solution {
    let parts = || (Ball { level }, bounce());
    let every = NonZeroU64::new(steps).unwrap();
    Resumable::new(parts, from).method(options).every(every).run(times, save, |_, _| Continue(())).unwrap()
}

/// Each bounce multiplies the energy by 0.81; before the first it is that of the field, which may
/// differ from that of the start.
#[test]
fn kept_values_are_those_after_the_last_reset() {
    let times: Vec<f64> = (0..=80).map(|i| 0.15 * f64::from(i)).collect();
    for (method, level) in [(Method::Adams, 1.0), (Method::Bdf, 1.0), (Method::Adams, 1.25)] {
        let options = Options::new(method).relative_tolerance(1e-6).absolute_tolerance(1e-8);
        for steps in [3, 10, 40, 1_000_000] {
            let mut kept = Vec::new();
            let keep = |checkpoint: &Checkpoint, _| kept.push(checkpoint.to_bytes(""));
            let motion = solve(level, Checkpoint::start(0.0, &START), &times, &options, steps, keep);
            assert!(motion.occurrences.len() > 4, "{}", motion.occurrences.len());
            for (t, y) in motion.trajectory.iter().skip(1) {
                let bounces = motion.occurrences.iter().filter(|occurrence| occurrence.time <= t).count();
                let expected = level * 0.81_f64.powi(i32::try_from(bounces).unwrap());
                // Some roundings at each of up to some hundred checkpoints.
                let excess = energy(y) - expected;
                assert!(excess.abs() < 1e-12, "{method} {steps}: {excess:e} at {t} after {bounces}");
            }
            let stride = kept.len().div_ceil(15);
            for bytes in kept.iter().step_by(stride).chain(kept.last()) {
                let (from, _) = Checkpoint::from_bytes(bytes).unwrap();
                assert_eq!(solve(level, from, &times, &options, steps, |_, _| ()), motion);
            }
        }
    }
}

/// With events and without, across integrations.
#[test]
fn kept_values_continue_from_a_jump() {
    let options = Options::default();
    let near = |y: &[f64], level: f64| assert!((energy(y) - level).abs() < 1e-14, "{} {level}", energy(y));
    let again = |checkpoint: Checkpoint| Checkpoint::from_bytes(&checkpoint.to_bytes("")).unwrap().0;

    let mut cvode = Integration::new(Ball { level: 1.0 }, 0.0, &START, &options).unwrap();
    cvode.state_at(0.25).unwrap();
    let before = again(cvode.checkpoint());
    cvode.restart(0.25, &[1.0, 1.0]).unwrap();
    let at = again(cvode.checkpoint());
    near(cvode.state_at(0.5).unwrap(), 1.5);
    let after = again(cvode.checkpoint());
    for (from, level) in [(&before, 1.0), (&at, 1.5), (&after, 1.5)] {
        let mut later = Integration::resume(Ball { level: 1.0 }, from, &options).unwrap();
        near(later.state_at(0.75).unwrap(), level);
        // And once more.
        let mut later =
            Integration::resume(Ball { level: 1.0 }, &again(later.checkpoint()), &options).unwrap();
        near(later.state_at(1.0).unwrap(), level);
    }

    let mut hybrid =
        Integration::new(Ball { level: 1.0 }, 0.0, &START, &options).unwrap().with_events(bounce()).unwrap();
    for (end, level) in [(1.0, 1.0), (2.0, 0.81), (5.0, 0.6561)] {
        hybrid.advance_to(end, |_| Continue(())).unwrap();
        near(hybrid.state(), level);
        let from = again(hybrid.checkpoint());
        let mut later = Integration::resume(Ball { level: 1.0 }, &from, &options)
            .and_then(|resumed| resumed.with_events_of(bounce(), &from))
            .unwrap();
        later.advance_to(end + 0.3, |_| Continue(())).unwrap();
        near(later.state(), level);
    }
}

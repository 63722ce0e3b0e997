//! Checkpoints: the same numbers to the last bit, and invalid bytes are refused.
use std::num::NonZeroU64;
use std::ops::ControlFlow;

use crate::boxed::{erased, from_fn};
use pc_solve::{
    Checkpoint, CheckpointError, Code, Failure, Integration, Method, NoEvents, Options, Resumable,
    SolveError, Trajectory, VectorField, solve,
};

/// Van der Pol's equation with μ = 20, and its Jacobian.
fn oscillator() -> impl VectorField {
    let rhs = |_t: f64, y: &[f64], ydot: &mut [f64]| {
        ydot[0] = y[1];
        ydot[1] = 20.0 * (1.0 - y[0] * y[0]) * y[1] - y[0];
        Ok(())
    };
    from_fn(2, rhs).with_jacobian(|_t, y, jacobian| {
        jacobian.copy_from_slice(&[0.0, -40.0 * y[0] * y[1] - 1.0, 1.0, 20.0 * (1.0 - y[0] * y[0])]);
        Ok(())
    })
}

/// A point that turns, projected to the unit circle: the states of the integrator have an offset.
struct Turning;

impl VectorField for Turning {
    fn dim(&self) -> usize {
        2
    }

    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        let speed = 1.0 + t.sin();
        ydot.copy_from_slice(&[-speed * y[1], speed * y[0]]);
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

fn every(steps: u64) -> NonZeroU64 {
    NonZeroU64::new(steps).unwrap()
}

const GO_ON: fn(f64, &[f64]) -> ControlFlow<()> = |_, _| ControlFlow::Continue(());

/// The motion with all its checkpoints, as bytes.
fn undisturbed<F: VectorField>(
    mut field: impl FnMut() -> F,
    times: &[f64],
    options: &Options,
    steps: u64,
) -> (Trajectory, Vec<Vec<u8>>) {
    let mut checkpoints = Vec::new();
    let keep = |checkpoint: &Checkpoint, last: bool| {
        assert!(!last);
        checkpoints.push(checkpoint.to_bytes("a label"));
    };
    let from = Checkpoint::start(0.0, &[2.0_f64.sqrt().recip(), 2.0_f64.sqrt().recip()]);
    let motion = Resumable::new(|| (field(), NoEvents), from)
        .method(options)
        .every(every(steps))
        .run(times, keep, GO_ON)
        .unwrap();
    (motion.trajectory, checkpoints)
}

fn goes_on<F: VectorField>(field: impl Fn() -> F, options: &Options) {
    for times in [&[0.0, 0.5, 0.6, 7.0, 20.0][..], &[30.0], &[-1.0, -9.0]] {
        for steps in [7, 50, 1_000_000] {
            let (motion, checkpoints) = undisturbed(&field, times, options, steps);
            assert!(motion.is_complete() && motion.times() == times);
            assert_eq!(checkpoints.len() as u64, 1 + motion.statistics().steps / steps);
            let stride = checkpoints.len().div_ceil(25);
            for bytes in checkpoints.iter().step_by(stride).chain(checkpoints.last()) {
                let (from, label) = Checkpoint::from_bytes(bytes).unwrap();
                assert_eq!(label, "a label");
                let resumed = Resumable::new(|| (field(), NoEvents), from)
                    .method(options)
                    .every(every(steps))
                    .run(times, |_, _| (), GO_ON)
                    .unwrap();
                // Outputs, times and work: nonzero numbers that are equal have the same bits.
                assert_eq!(resumed.trajectory, motion);
            }
        }
    }
}

#[test]
fn a_motion_resumes_from_any_of_its_checkpoints_with_the_same_bits() {
    let loose = |method| Options::new(method).relative_tolerance(1e-5).absolute_tolerance(1e-7);
    goes_on(oscillator, &loose(Method::Bdf));
    goes_on(oscillator, &loose(Method::Adams));
    goes_on(|| Turning, &loose(Method::Adams));
    goes_on(|| Turning, &loose(Method::Bdf).initial_step(1e-3));
}

#[test]
fn checkpoints_change_the_motion_within_its_tolerance() {
    let times = [1.0, 5.0, 10.0];
    let angle = |t: f64| std::f64::consts::FRAC_PI_4 + t + 1.0 - t.cos();
    let (motion, checkpoints) = undisturbed(|| Turning, &times, &Options::new(Method::Adams), 20);
    assert!(checkpoints.len() > 5);
    for (t, y) in motion.iter() {
        // Local errors of 1e-9 in a few hundred steps, which do not grow.
        assert!((y[0] - angle(t).cos()).abs() < 1e-6 && (y[1] - angle(t).sin()).abs() < 1e-6);
        assert!((y[0].hypot(y[1]) - 1.0).abs() < 4.0 * f64::EPSILON, "projected at an output in a step");
    }
    let plain =
        solve(erased(Turning), 0.0, &[0.5_f64.sqrt(); 2], &times, &Options::new(Method::Adams)).unwrap();
    assert!(motion.statistics().steps > plain.statistics().steps, "orders grow again after each");
}

#[test]
fn a_stopped_motion_leaves_its_last_checkpoint() {
    let times: Vec<f64> = (0..100).map(|i| 0.3 * f64::from(i)).collect();
    let options = Options::new(Method::Adams);
    let (motion, _) = undisturbed(|| Turning, &times, &options, 30);
    let (mut steps, mut last) = (0, None);
    let from = Checkpoint::start(0.0, &[2.0_f64.sqrt().recip(); 2]);
    let keep = |checkpoint: &Checkpoint, stopped: bool| {
        if stopped {
            last = Some(checkpoint.clone());
        }
    };
    let stop = |_, _: &[f64]| {
        steps += 1;
        if steps == 100 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    };
    let part = Resumable::new(|| (Turning, NoEvents), from)
        .method(&options)
        .every(every(30))
        .run(&times, keep, stop)
        .unwrap()
        .trajectory;
    let last = last.unwrap();
    assert!(!part.is_complete() && part.states() == &motion.states()[..part.states().len()]);
    assert!(last.outputs().len() <= part.len() && last.statistics().steps == 90);
    let resumed = Resumable::new(|| (Turning, NoEvents), last)
        .method(&options)
        .every(every(30))
        .run(&times, |_, _| (), GO_ON)
        .unwrap();
    assert_eq!(resumed.trajectory, motion);
}

#[test]
fn a_failure_ends_a_motion_with_checkpoints_as_it_ends_one_without() {
    // ẏ = y² from 1 is infinite at t = 1.
    let field = || {
        from_fn(1, |_t, y: &[f64], ydot: &mut [f64]| {
            ydot[0] = y[0] * y[0];
            Ok(())
        })
    };
    for steps in [20, 100] {
        let from = Checkpoint::start(0.0, &[1.0]);
        let options = Options::new(Method::Adams).max_steps(1_000_000);
        let failure = Resumable::new(|| (field(), NoEvents), from)
            .method(&options)
            .every(every(steps))
            .run(&[0.5, 2.0], |_, _| (), GO_ON)
            .unwrap_err();
        assert_eq!(failure.reached.trajectory.len(), 1);
        let (t, _) = failure.error.reached().unwrap();
        assert!((t - 1.0).abs() < 1e-6, "{t}");
    }
    let from = Checkpoint::start(0.0, &[1.0]);
    let options = Options::new(Method::Adams).max_steps(35);
    let times = [0.01, 0.9];
    let failure = Resumable::new(|| (field(), NoEvents), from)
        .method(&options)
        .every(every(10))
        .run(&times, |_, _| (), GO_ON)
        .unwrap_err();
    assert_eq!(failure.error.code(), Some(Code::TooMuchWork));
    assert!(
        failure.error.to_string().contains("35 steps were not enough to reach the output at t = 0.9"),
        "{failure}"
    );
    let wrong = Checkpoint::start(0.0, &[1.0, 2.0]);
    let failure = Resumable::new(|| (field(), NoEvents), wrong)
        .method(&Options::new(Method::Adams))
        .every(every(1))
        .run(&[1.0], |_, _| (), GO_ON);
    assert!(matches!(failure.unwrap_err().error, SolveError::Input(_)), "two numbers for one component");
}

#[test]
fn numbers_keep_their_bits() {
    let numbers = [-0.0, f64::MIN_POSITIVE / 8.0, f64::MAX, 0.1, f64::INFINITY, -1e-300];
    let (read, label) = Checkpoint::from_bytes(&Checkpoint::start(-0.0, &numbers).to_bytes("λ")).unwrap();
    let bits = |numbers: &[f64]| numbers.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
    assert_eq!((bits(read.state()), label.as_str()), (bits(&numbers), "λ"));
    assert_eq!(read.time().to_bits(), (-0.0_f64).to_bits());
}

#[test]
fn damaged_bytes_are_refused() {
    let mut cvode =
        Integration::new(erased(Turning), 0.0, &[1.0, 0.0], &Options::new(Method::Adams)).unwrap();
    cvode.state_at(1.0).unwrap();
    let bytes = cvode.checkpoint().to_bytes("model");
    assert_eq!(Checkpoint::from_bytes(&bytes).unwrap().0.state(), cvode.state());
    for length in 0..bytes.len() {
        assert!(Checkpoint::from_bytes(&bytes[..length]).is_err(), "cut at {length}");
    }
    for bit in 0..8 * bytes.len() {
        let mut flipped = bytes.clone();
        flipped[bit / 8] ^= 1 << (bit % 8);
        assert!(Checkpoint::from_bytes(&flipped).is_err(), "bit {bit}");
    }
    let longer = [&bytes[..], &[0]].concat();
    assert_eq!(Checkpoint::from_bytes(&longer), Err(CheckpointError::Damaged));
    assert_eq!(Checkpoint::from_bytes(b"t,x\n0,1\n"), Err(CheckpointError::Foreign));
    // Other versions of the format, whatever follows.
    for (digit, found) in [(b'1', 1), (b'2', 2)] {
        let mut other = bytes.clone();
        other["pc checkpoint ".len()] = digit;
        assert_eq!(Checkpoint::from_bytes(&other), Err(CheckpointError::Version { found }));
    }
}

/// The limit applies to the steps from one output to the next, across checkpoints.
#[test]
fn the_step_limit_is_that_of_a_run_without_checkpoints() {
    let times: Vec<f64> = (1..=40).map(|i| 0.5 * f64::from(i)).collect();
    let circle = || {
        from_fn(2, |_t, y: &[f64], ydot: &mut [f64]| {
            ydot.copy_from_slice(&[y[1], -y[0]]);
            Ok(())
        })
    };
    // Steps of at most 0.01: about 50 between outputs, a few more after a restart.
    let options = |most| Options::new(Method::Adams).max_step(0.01).max_steps(most);
    for steps in [50, 60, 70, 79] {
        let run = |most| {
            let from = Checkpoint::start(0.0, &[1.0, 0.0]);
            Resumable::new(|| (circle(), NoEvents), from).method(&options(most)).every(every(steps)).run(
                &times,
                |_, _| (),
                GO_ON,
            )
        };
        assert!(run(80).unwrap().trajectory.is_complete(), "{steps}");
        let failure = run(40).unwrap_err();
        assert_eq!(failure.error.code(), Some(Code::TooMuchWork));
        assert!(failure.reached.trajectory.is_empty());
    }
}

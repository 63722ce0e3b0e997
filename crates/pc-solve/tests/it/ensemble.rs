//! Ensembles: order, bounded memory, members that fail, and early stops.
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

use crate::boxed::{erased, from_fn};
use pc_solve::{Ending, Ensemble, Failure, MemberError, Options, Stop, VectorField, member_stream, solve};
use rand_chacha::rand_core::Rng;

/// Why a member cannot be made.
#[derive(Debug, thiserror::Error)]
#[error("member {0} has no mass")]
struct NoMass(u64);

fn threads(n: usize) -> Ensemble<'static> {
    Ensemble::new().threads(NonZeroUsize::new(n).unwrap())
}

/// The pendulum φ̈ = −sin φ.
fn pendulum() -> impl VectorField {
    from_fn(2, |_t, y, ydot| {
        ydot[0] = y[1];
        ydot[1] = -y[0].sin();
        Ok(())
    })
}

/// A start drawn from the stream of a member.
fn start(member: u64) -> Vec<f64> {
    let mut stream = member_stream(2, member);
    let mut number = || f64::from(stream.next_u32()) / f64::from(u32::MAX);
    vec![number(), number()]
}

const TIMES: [f64; 3] = [0.0, 1.5, 3.0];

fn pendulums(ensemble: &Ensemble<'_>, members: u64) -> Vec<(u64, Vec<f64>)> {
    let mut motions = Vec::new();
    let make = |member| Ok::<_, Failure>((pendulum(), start(member)));
    let ending = ensemble
        .solve(0..members, make, 0.0, &TIMES, &Options::default(), |member, motion| {
            motions.push((member, motion.unwrap().states().to_vec()));
            ControlFlow::Continue(())
        })
        .unwrap();
    assert_eq!(ending, Ending::Completed);
    motions
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let alone: Vec<(u64, Vec<f64>)> = (0..50)
        .map(|member| {
            let motion = solve(erased(pendulum()), 0.0, &start(member), &TIMES, &Options::default()).unwrap();
            (member, motion.states().to_vec())
        })
        .collect();
    for n in [1, 2, 7] {
        assert_eq!(pendulums(&threads(n), 50), alone, "{n} threads");
        let narrow = threads(n).window(NonZeroUsize::MIN);
        assert_eq!(pendulums(&narrow, 50), alone, "{n} threads, window 1");
    }
    assert_eq!(pendulums(&threads(2), 0), []);
}

#[test]
fn a_member_that_fails_is_reported_with_what_it_had_reached_and_the_others_finish() {
    // ẏ = y² from 1 is infinite at t = 1; the others decay.
    let make = |member: u64| match member {
        3 => Err(NoMass(3)),
        _ => {
            let field = from_fn(1, move |t, y: &[f64], ydot: &mut [f64]| {
                assert!(!(member == 11 && t > 0.5), "the field of member 11");
                ydot[0] = if member == 7 { y[0] * y[0] } else { -y[0] };
                Ok(())
            });
            Ok((field, vec![1.0]))
        }
    };
    let mut seen = Vec::new();
    let times = [0.25, 2.0];
    let ending = threads(3).solve(0..20, make, 0.0, &times, &Options::default(), |member, motion| {
        seen.push(member);
        match (member, motion) {
            (3, Err(error @ MemberError::Make(NoMass(3)))) => {
                assert_eq!(error.to_string(), "member 3 has no mass");
                assert!(error.reached().is_none());
            }
            (7, Err(MemberError::Solve(failure))) => {
                assert_eq!(failure.reached.len(), 1);
                let (t, y) = failure.error.reached().unwrap();
                // 1/(1 − t), with its pole displaced by up to a hundred tolerances.
                assert!((t - 1.0).abs() < 1e-7 && y[0] > 1e6, "{t} {y:?}");
            }
            (11, Err(error @ MemberError::Panic { .. })) => {
                let (t, y) = error.reached().unwrap();
                // A hundred times the tolerance of a step.
                assert!(t > 0.0 && t <= 0.5 && (y[0] - (-t).exp()).abs() < 1e-7, "{t} {y:?}");
                assert_eq!(error.to_string(), "the vector field panicked: the field of member 11");
            }
            (_, motion) => assert!((motion.unwrap().state(1)[0] - (-2.0_f64).exp()).abs() < 1e-7),
        }
        ControlFlow::Continue(())
    });
    assert_eq!(ending.unwrap(), Ending::Completed);
    assert!(seen.into_iter().eq(0..20));
}

#[test]
fn no_more_members_wait_than_the_window_holds() {
    let window = 5;
    let (begun, consumed, widest) = (AtomicU64::new(0), AtomicU64::new(0), AtomicU64::new(0));
    let work = |member: u64, _: &Stop<'_>| {
        begun.fetch_max(member + 1, Ordering::SeqCst);
        // The first member takes long: the others must wait for it.
        let start = Instant::now();
        while member == 0
            && begun.load(Ordering::SeqCst) < window as u64
            && start.elapsed() < Duration::from_secs(60)
        {
            std::thread::sleep(Duration::from_millis(1));
        }
        widest.fetch_max(begun.load(Ordering::SeqCst) - consumed.load(Ordering::SeqCst), Ordering::SeqCst);
        member
    };
    let ensemble = threads(3).window(NonZeroUsize::new(window).unwrap());
    let ending = ensemble.map(0..200, work, |member, result| {
        assert_eq!(result, Ok(member));
        consumed.store(member + 1, Ordering::SeqCst);
        ControlFlow::Continue(())
    });
    assert_eq!(ending.unwrap(), Ending::Completed);
    // A result is taken before it is counted as consumed: one more member may begin meanwhile.
    let widest = widest.into_inner();
    assert!((window as u64..=window as u64 + 1).contains(&widest), "{widest}");
}

/// A member that would never end.
fn endless(_: u64) -> Result<(impl VectorField, Vec<f64>), NoMass> {
    Ok((pendulum(), vec![1.0, 0.0]))
}

#[test]
fn the_consumer_and_a_flag_stop_members_in_progress() {
    let mut consumed = 0;
    let options = Options::default().max_steps(100_000_000);
    let first_is_short = |member: u64| match member {
        0 => Err(NoMass(0)),
        member => endless(member),
    };
    let ending = threads(2).solve(0..9, first_is_short, 0.0, &[1e12], &options, |member, motion| {
        assert!(member == 0 && motion.is_err());
        consumed += 1;
        ControlFlow::Break(())
    });
    assert_eq!((ending.unwrap(), consumed), (Ending::Stopped, 1));

    let flag = AtomicBool::new(false);
    std::thread::scope(|scope| {
        scope.spawn(|| {
            std::thread::sleep(Duration::from_millis(50));
            flag.store(true, Ordering::Relaxed);
        });
        let ensemble = threads(2).stopped_by(&flag);
        let ending = ensemble.solve(0..9, endless, 0.0, &[1e12], &options, |_, _| ControlFlow::Continue(()));
        assert_eq!(ending.unwrap(), Ending::Stopped);
    });
}

#[test]
fn a_panic_of_the_consumer_reaches_the_caller() {
    let panicking = || {
        let make = |member| Ok::<_, Failure>((pendulum(), start(member)));
        threads(2).solve(0..1000, make, 0.0, &TIMES, &Options::default(), |member, _| {
            assert!(member < 10, "the consumer");
            ControlFlow::Continue(())
        })
    };
    let panic = catch_unwind(AssertUnwindSafe(panicking)).unwrap_err();
    assert_eq!(panic.downcast_ref::<&str>(), Some(&"the consumer"));
}

#[test]
fn streams_of_members_and_seeds_are_different_and_stay_the_same() {
    let numbers: Vec<u64> =
        (0..3).flat_map(|seed| (0..3).map(move |member| member_stream(seed, member).next_u64())).collect();
    let mut distinct = numbers.clone();
    distinct.sort_unstable();
    distinct.dedup();
    assert_eq!(distinct.len(), 9);
    assert_eq!(numbers[0], member_stream(0, 0).next_u64());
}

//! Members of ensembles in lanes: the same bytes for any number of lanes and threads, and the same
//! motions as alone.
use std::num::NonZeroUsize;
use std::ops::ControlFlow;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use pc_expr::{Backend, Expr, Graph, Inputs, LaneField, Program, ProgramField, Watched};
use pc_solve::{
    Ending, Ensemble, Failure, MemberError, Method, Options, Trajectory, VectorField, member_stream, solve,
};
use rand_chacha::rand_core::Rng;

use crate::boxed::erased;

/// A field of (y₀, y₁ …) with parameters (p, q).
fn program(dim: usize, rates: impl for<'g> Fn(&[Expr<'g>], Expr<'g>, Expr<'g>) -> Vec<Expr<'g>>) -> Program {
    let graph = Graph::new();
    let state: Vec<Expr<'_>> = (0..dim).map(|i| graph.symbol(&format!("y{i}"))).collect();
    let [p, q] = graph.symbols(["p", "q"]);
    let rates = rates(&state, p, q);
    let inputs = Inputs { time: None, state, parameters: vec![p, q] };
    Program::new(&graph, &inputs, &rates).unwrap()
}

/// The pendulum φ̈ = −p sin φ − q φ̇ |φ̇|.
fn pendulum() -> Program {
    program(2, |y, p, q| vec![y[1], -p * y[0].sin() - q * y[1] * y[1].abs()])
}

/// Numbers between 0 and 1 drawn from the stream of a member.
fn numbers<const N: usize>(member: u64) -> [f64; N] {
    let mut stream = member_stream(5, member);
    std::array::from_fn(|_| f64::from(stream.next_u32()) / f64::from(u32::MAX))
}

/// A field of a program.
fn of(program: &Program, parameters: [f64; 2]) -> ProgramField {
    ProgramField::new(program.clone(), parameters.to_vec(), Backend::Fastest)
}

fn swinging(program: &Program, member: u64) -> Result<(ProgramField, Vec<f64>), Failure> {
    let [a, b, c, d] = numbers(member);
    Ok((of(program, [1.0 + a, 0.1 * b]), vec![3.0 * c, d - 0.5]))
}

fn ensemble(threads: usize, lanes: usize) -> Ensemble<'static> {
    Ensemble::new().threads(NonZeroUsize::new(threads).unwrap()).lanes(NonZeroUsize::new(lanes).unwrap())
}

fn options(rtol: f64) -> Options {
    Options::new(Method::Dop853).relative_tolerance(rtol).absolute_tolerance(rtol * 1e-3)
}

type Made = Result<(ProgramField, Vec<f64>), Failure>;

fn motions(
    ensemble: &Ensemble<'_>,
    members: u64,
    make: impl Fn(u64) -> Made + Sync,
    (t0, times): (f64, &[f64]),
    options: &Options,
) -> Vec<Trajectory> {
    let mut motions = Vec::new();
    let ending = ensemble
        .solve(0..members, make, t0, times, options, |member, motion| {
            assert_eq!(member, motions.len() as u64);
            motions.push(motion.unwrap());
            ControlFlow::Continue(())
        })
        .unwrap();
    assert_eq!(ending, Ending::Completed);
    motions
}

fn bits(motions: &[Trajectory]) -> Vec<u64> {
    motions.iter().flat_map(|motion| motion.states().iter().map(|y| y.to_bits())).collect()
}

#[test]
fn neither_lanes_nor_threads_nor_windows_change_a_bit() {
    let program = pendulum();
    let make = |member| swinging(&program, member);
    let times = [0.0, 0.3, 0.4, 2.0, 5.0];
    let first = motions(&ensemble(1, 8), 61, make, (0.0, &times), &options(1e-9));
    for motion in &first {
        assert!(motion.is_complete() && motion.statistics().lane_steps == motion.statistics().steps);
        assert!(motion.statistics().steps > 5 && motion.times() == times);
    }
    for (threads, lanes) in [(1, 1), (1, 4), (2, 8), (2, 3), (5, 8), (1, 16), (2, 13)] {
        let other = motions(&ensemble(threads, lanes), 61, make, (0.0, &times), &options(1e-9));
        assert_eq!(other, first, "{threads} threads, {lanes} lanes");
    }
    let narrow = ensemble(2, 8).window(NonZeroUsize::MIN);
    assert_eq!(bits(&motions(&narrow, 61, make, (0.0, &times), &options(1e-9))), bits(&first));
    // A member does not depend on the others.
    let alone = motions(&ensemble(1, 8), 1, |_| make(17), (0.0, &times), &options(1e-9));
    assert_eq!(alone[0], first[17]);
    // More outputs change no step.
    let ends = motions(&ensemble(1, 8), 61, make, (0.0, &times[4..]), &options(1e-9));
    for (a, b) in ends.iter().zip(&first) {
        assert_eq!(a.state(0), b.state(4));
    }
}

/// Errors are within a few hundred tolerances, as those of single motions.
#[test]
fn lanes_agree_with_single_motions_within_the_tolerance() {
    let program = pendulum();
    let make = |member| swinging(&program, member);
    for (t0, times) in [(0.0, [0.1, 1.0, 3.5, 10.0]), (1.0, [0.8, 0.1, -0.9, -3.0])] {
        for rtol in [1e-6, 1e-9, 1e-12] {
            let found = motions(&ensemble(1, 8), 40, make, (t0, &times), &options(rtol));
            let mut steps = [0; 2];
            for (member, motion) in found.iter().enumerate() {
                let (single, start) = make(member as u64).unwrap();
                let exact = solve(erased(single.clone()), t0, &start, &times, &options(1e-14)).unwrap();
                for (a, b) in motion.states().iter().zip(exact.states()) {
                    assert!((a - b).abs() <= 300.0 * rtol * (1.0 + b.abs()), "{member}: {a} {b} at {rtol:e}");
                }
                let single = solve(erased(single), t0, &start, &times, &options(rtol)).unwrap();
                steps[0] += motion.statistics().steps;
                steps[1] += single.statistics().steps;
            }
            // Lengths have two digits; for some members this decides on many steps, where the
            // friction changes sign.
            let [found, expected] = steps.map(|steps| steps as f64);
            assert!((found - expected).abs() <= 0.05 * expected, "{found} steps, not {expected}");
        }
    }
}

/// The last step ends at the last output anyway.
#[test]
fn a_stop_time_from_the_last_output_on_changes_no_bit() {
    let program = pendulum();
    let make = |member| swinging(&program, member);
    for (t0, times) in [(0.0, [1.0, 3.5, 10.0]), (1.0, [0.1, -0.9, -3.0])] {
        let motions = |options: &Options| motions(&ensemble(1, 8), 20, make, (t0, &times), options);
        let free = bits(&motions(&options(1e-9)));
        for beyond in [0.0, 0.5] {
            let stop = times[2] + beyond * (times[2] - t0);
            assert_eq!(bits(&motions(&options(1e-9).stop_time(stop))), free, "to {stop}");
        }
    }
}

/// ÿ = −y: the error falls with the tolerance as a power, inside steps too.
#[test]
fn states_inside_steps_lie_on_the_motion() {
    let oscillator = program(2, |y, p, _| vec![y[1], -p * y[0]]);
    let make = |_| Ok((of(&oscillator, [1.0, 0.0]), vec![1.0, 0.0]));
    let times: Vec<f64> = (1..=200).map(|k| f64::from(k) * 0.05).collect();
    for rtol in [1e-8, 1e-11] {
        let found = motions(&ensemble(1, 8), 9, make, (0.0, &times), &options(rtol));
        for motion in &found {
            for (t, y) in motion.iter() {
                assert!((y[0] - t.cos()).abs() < 30.0 * rtol, "{t}: {} at {rtol:e}", y[0] - t.cos());
            }
            assert_eq!(motion.statistics(), found[0].statistics());
        }
    }
}

/// ẏ = p y² from 1 is infinite at t = 1/p.
#[test]
fn a_member_that_fails_reports_as_alone_and_leaves_the_others_unchanged() {
    let program = program(1, |y, p, q| vec![p * y[0].square() - q * y[0].sqrt()]);
    let make = |fails: bool| {
        let program = &program;
        move |member: u64| -> Made {
            let [a] = numbers(member);
            let p = if fails && member % 5 == 3 { 1.0 } else { -a };
            Ok((of(program, [p, 0.0]), vec![1.0 + a * a]))
        }
    };
    let mut healthy = Vec::new();
    ensemble(1, 8)
        .solve(0..30, make(false), 0.0, &[0.25, 2.0], &options(1e-9), |_, motion| {
            healthy.push(motion.unwrap());
            ControlFlow::Continue(())
        })
        .unwrap();
    for (threads, lanes) in [(1, 8), (2, 8), (1, 1)] {
        let mut failed = 0;
        let consume = |member: u64, motion: Result<Trajectory, MemberError<Failure>>| {
            match motion {
                Ok(motion) => assert_eq!(motion, healthy[member as usize]),
                Err(error) => {
                    assert_eq!(member % 5, 3);
                    let (field, start) = make(true)(member).unwrap();
                    let alone = solve(erased(field), 0.0, &start, &[0.25, 2.0], &options(1e-9)).unwrap_err();
                    assert_eq!(error.to_string(), alone.to_string());
                    assert_eq!(error.reached(), alone.error.reached());
                    failed += 1;
                }
            }
            ControlFlow::Continue(())
        };
        ensemble(threads, lanes)
            .solve(0..30, make(true), 0.0, &[0.25, 2.0], &options(1e-9), consume)
            .unwrap();
        assert_eq!(failed, 6);
    }
}

/// A field with a pivot, 1 − y₀ or 0, that must not vanish.
struct Watching {
    field: ProgramField,
    program: Arc<Program>,
}

impl VectorField for Watching {
    fn dim(&self) -> usize {
        1
    }
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        if 1.0 - y[0] <= 1e-6 {
            return Err(Failure::fatal(std::fmt::Error));
        }
        self.field.rhs(t, y, ydot)
    }
    fn lanes(&mut self) -> Option<LaneField> {
        let watched = Watched { pivots: 1, smallest: f64::INFINITY, largest: 0.0, vanishing: 1e-6 };
        let parameters = self.field.parameters().to_vec();
        let unit_quaternions = Vec::new();
        Some(LaneField { program: Arc::clone(&self.program), parameters, watched, unit_quaternions })
    }
}

#[test]
fn a_pivot_that_vanishes_leads_out_of_the_lanes() {
    let rates = program(1, |_, p, _| vec![p]);
    let watching = {
        let graph = Graph::new();
        let [y, p, q] = graph.symbols(["y0", "p", "q"]);
        let inputs = Inputs { time: None, state: vec![y], parameters: vec![p, q] };
        Arc::new(
            Program::new(&graph, &inputs, &[p, (1.0 - y).max(Expr::from(0.0)), Expr::from(1.0)]).unwrap(),
        )
    };
    let make = |member: u64| {
        let speed = 0.1 * member as f64;
        let field = of(&rates, [speed, 0.0]);
        Ok::<_, Failure>((Watching { field, program: Arc::clone(&watching) }, vec![0.0]))
    };
    let options = options(1e-9).max_step(0.01);
    let mut ends = Vec::new();
    ensemble(1, 8)
        .solve(0..20, make, 0.0, &[1.0], &options, |_, motion| {
            ends.push(motion);
            ControlFlow::Continue(())
        })
        .unwrap();
    for (member, end) in ends.into_iter().enumerate() {
        match end {
            Ok(motion) => {
                assert!(member < 10 && (motion.state(0)[0] - 0.1 * member as f64).abs() < 1e-12, "{member}");
                assert!(motion.statistics().lane_steps >= 100, "the longest step is 0.01");
            }
            Err(error) => assert!(member >= 10, "{member}: {error}"),
        }
    }
}

#[test]
fn programs_may_differ_from_member_to_member() {
    let oscillator = program(2, |y, p, _| vec![y[1], -p * y[0]]);
    let pendulum = pendulum();
    let make = |member: u64| {
        let field = match member / 3 % 3 {
            0 => of(&pendulum, [1.0, 0.0]),
            1 => of(&oscillator, [1.0, 0.0]),
            // Fields for the interpreter are not integrated in lanes.
            _ => ProgramField::new(pendulum.clone(), vec![1.0, 0.0], Backend::Interpreter),
        };
        Ok((field, vec![0.1, 0.01 * member as f64]))
    };
    let found = motions(&ensemble(2, 8), 50, make, (0.0, &[4.0]), &options(1e-9));
    for (member, motion) in found.iter().enumerate() {
        assert_eq!(motion.statistics().lane_steps == 0, member / 3 % 3 == 2, "{member}");
        let alone = motions(&ensemble(1, 1), 1, |_| make(member as u64), (0.0, &[4.0]), &options(1e-9));
        assert_eq!(&alone[0], motion);
    }
}

#[test]
fn limits_of_steps_are_those_of_single_motions() {
    let program = pendulum();
    let make = |_| Ok::<_, Failure>((of(&program, [1.0, 0.0]), vec![1.0, 0.0]));
    let alone =
        solve(erased(of(&program, [1.0, 0.0])), 0.0, &[1.0, 0.0], &[9.0], &options(1e-9).max_steps(4))
            .unwrap_err();
    let mut errors = Vec::new();
    ensemble(1, 8)
        .solve(0..3, make, 0.0, &[9.0], &options(1e-9).max_steps(4), |_, motion| {
            errors.push(motion.unwrap_err().to_string());
            ControlFlow::Continue(())
        })
        .unwrap();
    assert_eq!(errors, vec![alone.to_string(); 3]);
    // Each member reports invalid options by itself.
    let consume = |_, motion: Result<Trajectory, MemberError<Failure>>| {
        assert!(motion.unwrap_err().to_string().contains("tolerance"));
        ControlFlow::Continue(())
    };
    let wrong = options(1e-9).absolute_tolerance(vec![1e-9; 3]);
    ensemble(1, 8).solve(0..3, make, 0.0, &[9.0], &wrong, consume).unwrap();
}

#[test]
fn a_flag_and_the_consumer_stop_lanes_in_progress() {
    let program = pendulum();
    let make = |_| Ok::<_, Failure>((of(&program, [1.0, 0.0]), vec![1.0, 0.0]));
    let endless = options(1e-9).max_steps(100_000_000);
    let flag = AtomicBool::new(false);
    let ending = std::thread::scope(|scope| {
        scope.spawn(|| {
            std::thread::sleep(Duration::from_millis(50));
            flag.store(true, Ordering::Relaxed);
        });
        let consume = |_, _: Result<Trajectory, MemberError<Failure>>| ControlFlow::Continue(());
        ensemble(2, 8).stopped_by(&flag).solve(0..100, make, 0.0, &[1e9], &endless, consume)
    });
    assert_eq!(ending.unwrap(), Ending::Stopped);

    let mut seen = Vec::new();
    let ending = ensemble(2, 8).solve(0..1000, make, 0.0, &[1.0], &options(1e-9), |member, _| {
        seen.push(member);
        if member == 4 { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
    });
    assert_eq!((ending.unwrap(), seen), (Ending::Stopped, vec![0, 1, 2, 3, 4]));
}

/// A request to stop may come at any moment, also between two groups of members.
#[test]
fn a_stop_between_groups_ends_the_ensemble() {
    let program = pendulum();
    let make = |_| Ok::<_, Failure>((of(&program, [1.0, 0.0]), vec![1.0, 0.0]));
    for case in 0..60 {
        let flag = AtomicBool::new(false);
        let ensemble = ensemble(1 + case % 3, 8).window(NonZeroUsize::new(1 + case % 4).unwrap());
        let by_flag = case % 2 == 0;
        let consume = |member, _: Result<Trajectory, MemberError<Failure>>| {
            if member < (case / 4) as u64 {
                return ControlFlow::Continue(());
            }
            flag.store(true, Ordering::Relaxed);
            if by_flag { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        };
        let ensemble = ensemble.stopped_by(&flag);
        let ending = ensemble.solve(0..100, make, 0.0, &[0.1], &options(1e-9), consume);
        assert_eq!(ending.unwrap(), Ending::Stopped, "{case}");
    }
}

/// By [`Method::Auto`] stiff members leave their lanes and are integrated as alone, to the last bit;
/// the others stay.
#[test]
fn stiff_members_are_integrated_by_themselves() {
    // Van der Pol's oscillator; every third one is stiff.
    let program = program(2, |y, p, _| vec![y[1], p * (1.0 - y[0] * y[0]) * y[1] - y[0]]);
    let damping = |member: u64| if member % 3 == 1 { 500.0 + member as f64 } else { 0.1 * member as f64 };
    let field = |member| of(&program, [damping(member), 0.0]);
    let make = |member| Ok::<_, Failure>((field(member), vec![2.0, 0.0]));
    let auto = Options::new(Method::Auto).relative_tolerance(1e-8).absolute_tolerance(1e-10);
    let times = [3.0, 20.0];
    let of_threads = |threads, lanes| motions(&ensemble(threads, lanes), 21, make, (0.0, &times), &auto);
    let all = of_threads(1, 16);
    assert_eq!(bits(&all), bits(&of_threads(2, 5)));
    for (member, motion) in (0..).zip(&all) {
        let alone = solve(erased(field(member)), 0.0, &[2.0, 0.0], &times, &auto).unwrap();
        if member % 3 == 1 {
            assert_eq!((motion, motion.statistics().lane_steps), (&alone, 0), "{member}");
            assert!(alone.statistics().stiff_from.is_some(), "{member}");
        } else {
            let work = motion.statistics();
            assert_eq!(work.lane_steps, work.steps, "{member}");
            for (a, b) in motion.states().iter().zip(alone.states()) {
                // The tolerance times the growth over a few periods.
                assert!((a - b).abs() < 1e-5, "{member}: {a} {b}");
            }
        }
    }
}

//! Outputs, steps and stops.

use std::cell::Cell;
use std::ops::ControlFlow::{self, Break, Continue};

use crate::boxed::{erased, from_fn};
use pc_solve::{
    Cvode, Ending, Failure, InputError, Integration, Method, NonlinearSolver, Observed, Options, Solve,
    SolveError, VectorField, solve,
};

fn pendulum(_t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
    ydot[0] = y[1];
    ydot[1] = -y[0].sin();
    Ok(())
}

fn pendulum_at(t0: f64, options: &Options) -> Integration<Cvode<impl VectorField + use<>>> {
    Integration::new(erased(from_fn(2, pendulum)), t0, &[1.0, 0.0], options).expect("valid input")
}

/// Outputs are read from the polynomials of the internal steps, which depend on the last output
/// time only: they are exactly the same for any number of outputs.
#[test]
fn outputs_do_not_depend_on_the_grid() {
    for method in [Method::Adams, Method::Bdf] {
        let options = Options::new(method);
        let coarse: Vec<f64> = (0..=10).map(f64::from).collect();
        let fine: Vec<f64> = (0..=1000).map(|i| f64::from(i) / 100.0).collect();
        let start = [1.0, 0.0];
        let coarse = solve(erased(from_fn(2, pendulum)), 0.0, &start, &coarse, &options).unwrap();
        let fine = solve(erased(from_fn(2, pendulum)), 0.0, &start, &fine, &options).unwrap();
        for i in 0..coarse.len() {
            assert_eq!(coarse.times()[i], fine.times()[100 * i]);
            assert_eq!(coarse.state(i), fine.state(100 * i));
        }
        assert_eq!(coarse.statistics(), fine.statistics());
    }
}

/// Another end changes the first trial step and so all later ones: the motion is equal to the
/// accuracy of the steps.
#[test]
fn advancing_piecewise_gives_the_same_motion() {
    let options = Options::default();
    let mut at_once = pendulum_at(0.0, &options);
    let mut piecewise = pendulum_at(0.0, &options);
    let end = at_once.state_at(10.0).unwrap().to_vec();
    for i in 1..=100 {
        piecewise.state_at(f64::from(i) / 10.0).unwrap();
        assert_eq!(piecewise.time(), f64::from(i) / 10.0);
    }
    for (a, b) in piecewise.state().iter().zip(&end) {
        assert!((a - b).abs() < 1e-6); // 1000 rtol
    }
    // The current time may be requested again, and outputs may begin there.
    let here = piecewise.state().to_vec();
    assert_eq!(piecewise.state_at(10.0).unwrap(), here);
    assert_eq!(piecewise.run(&[10.0, 11.0], |_, _| Continue(())).unwrap(), Ending::Completed);
    assert_eq!(piecewise.time(), 11.0);
}

#[test]
fn steps_and_interpolation() {
    let mut cvode = pendulum_at(0.0, &Options::default());
    assert_eq!(
        cvode.interpolate(0.0, 0).unwrap_err().to_string(),
        "there is nothing to interpolate: no step has been made"
    );
    let mut before = 0.0;
    while cvode.time() < 5.0 {
        let state_before = cvode.state().to_vec();
        let t = cvode.step_towards(5.0).unwrap();
        assert!(t > before);
        assert_eq!((t, cvode.statistics().current_time), (cvode.time(), t));
        let state = cvode.state().to_vec();
        // The polynomial passes through the end of the step, and through its start to about the
        // local error.
        assert_eq!(cvode.interpolate(t, 0).unwrap(), state);
        for (a, b) in cvode.interpolate(before, 0).unwrap().iter().zip(&state_before) {
            assert!((a - b).abs() < 1e-7, "{a} is not {b}");
        }
        // Its derivative is f, to the tolerance over the step.
        let rate = cvode.interpolate(t, 1).unwrap()[0];
        assert!((rate - state[1]).abs() < 1e-4, "{rate} is not {}", state[1]);
        assert_eq!((cvode.time(), cvode.state()), (t, &state[..]));
        before = t;
    }
    let last_step = cvode.statistics().last_step;
    let (from, to) = (cvode.time() - last_step, cvode.time());

    // Advancing inside the last step makes no new one, and a step then goes to its end.
    let mut cvode = pendulum_at(0.0, &Options::default());
    cvode.state_at(5.0).unwrap();
    let steps = cvode.statistics().steps;
    assert!(cvode.statistics().current_time > 5.0);
    let end = cvode.step_towards(10.0).unwrap();
    assert_eq!(end, cvode.statistics().current_time);
    assert_eq!(cvode.statistics().steps, steps);
    assert_eq!((end, end - cvode.statistics().last_step), (to, from));
}

/// Times outside the last step, and orders beyond the degree of its polynomial, are refused before
/// CVODES is called.
#[test]
fn invalid_interpolations_are_refused() {
    for end in [5.0, -5.0] {
        let mut cvode = pendulum_at(0.0, &Options::default());
        cvode.state_at(end).unwrap();
        let statistics = cvode.statistics();
        let (to, length, order) = (statistics.current_time, statistics.last_step, statistics.last_order);
        assert!((to - end) * end > 0.0 && length * end > 0.0 && order > 1, "the step goes on beyond {end}");
        // The ends belong to it, up to rounding.
        for t in [to, to - length, to + 1e-15 * end, to - length - 1e-15 * end] {
            assert!(cvode.interpolate(t, 0).is_ok() && cvode.interpolate(t, order).is_ok(), "{t}");
        }
        for t in [0.0, to - 1.001 * length, to + 1e-3 * length] {
            let error = cvode.interpolate(t, 0).unwrap_err();
            let from = to - length;
            assert_eq!(
                error.to_string(),
                format!("t = {t} lies outside the last step, which covers t = {from} to {to}")
            );
            assert!(matches!(error, SolveError::Input(InputError::OutsideStep { .. })));
        }
        for beyond in [order + 1, 13, u32::MAX] {
            let error = cvode.interpolate(to, beyond).unwrap_err();
            assert_eq!(
                error.to_string(),
                format!(
                    "the derivative of order {beyond} is requested, but within the last step derivatives are known up to \
                     order {order}"
                )
            );
            assert!(matches!(error, SolveError::Input(InputError::DerivativeOrder { .. })));
        }
        assert_eq!(cvode.time(), end);
    }
}

#[test]
fn an_output_observer_stops() {
    let mut seen = Vec::new();
    let mut cvode = pendulum_at(0.0, &Options::default());
    let ending = cvode
        .run(&[0.0, 1.0, 2.0, 3.0], |t, y| {
            seen.push(t);
            if y[0] < 0.0 { Break(()) } else { Continue(()) }
        })
        .unwrap();
    assert_eq!(ending, Ending::Stopped);
    assert_eq!(seen, [0.0, 1.0, 2.0]);
    assert_eq!(cvode.time(), 2.0);
    cvode.state_at(3.0).unwrap();
}

#[test]
fn a_step_observer_stops() {
    let interrupted = Cell::new(false);
    let mut steps = 0;
    let motion = Solve::new(erased(from_fn(2, pendulum)), 0.0, &[1.0, 0.0])
        .method(&Options::default())
        .run_observed(&[1.0, 2.0, 50.0], |t, y| {
            assert_eq!(y.len(), 2);
            steps += 1;
            interrupted.set(t > 10.0);
            if interrupted.get() { Break(()) } else { Continue(()) }
        })
        .unwrap()
        .trajectory;
    assert!(!motion.is_complete());
    assert_eq!(motion.times(), [1.0, 2.0]);
    assert_eq!(motion.statistics().steps, steps);
    assert!(motion.statistics().current_time < 12.0);
}

#[test]
fn a_step_observer_sees_every_step() {
    let mut steps = 0;
    let mut outputs = 0;
    let mut cvode = pendulum_at(0.0, &Options::default());
    let ending = cvode
        .run_observed(
            &[1.0, 1.001, 1.002, 20.0],
            Observed::new(|_, _| {
                outputs += 1;
                Continue(())
            })
            .steps(|_, _| {
                steps += 1;
                Continue(())
            }),
        )
        .unwrap();
    assert_eq!((ending, outputs, steps), (Ending::Completed, 4, cvode.statistics().steps));
}

/// `solve` never evaluates beyond the last time, in either direction; `Cvode` does unless it has a
/// stop time.
#[test]
fn nothing_is_evaluated_beyond_the_stop_time() {
    for end in [1.0, -1.0] {
        for options in [
            Options::new(Method::Adams),
            Options::new(Method::Bdf),
            Options::new(Method::Bdf).initial_step(7.0).min_step(0.01),
        ] {
            let farthest = Cell::new(0.0_f64);
            let field = || {
                from_fn(1, |t: f64, y: &[f64], ydot: &mut [f64]| {
                    farthest.set(farthest.get().max(t / end));
                    ydot[0] = (20.0 * y[0]).cos();
                    Ok(())
                })
            };
            let options = options.relative_tolerance(1e-2).absolute_tolerance(1.0);
            let motion = solve(erased(field()), 0.0, &[0.0], &[0.3 * end, end], &options).unwrap();
            assert_eq!(motion.last().unwrap().0, end);
            assert!(farthest.get() <= 1.0, "{}", farthest.get());

            farthest.set(0.0);
            let mut cvode = Integration::new(erased(field()), 0.0, &[0.0], &options).unwrap();
            cvode.state_at(end).unwrap();
            assert!(farthest.get() > 1.0);

            farthest.set(0.0);
            let mut cvode = Integration::new(erased(field()), 0.0, &[0.0], &options.stop_time(end)).unwrap();
            cvode.state_at(0.5 * end).unwrap();
            cvode.state_at(end).unwrap();
            assert!(farthest.get() <= 1.0);
            assert_eq!(cvode.statistics().current_time, end);
            let error = cvode.state_at(1.5 * end).unwrap_err().to_string();
            assert_eq!(error, format!("t = {} lies beyond the stop time {end}", 1.5 * end));
            cvode.set_stop_time(Some(2.0 * end)).unwrap();
            cvode.state_at(1.5 * end).unwrap();
            cvode.set_stop_time(None).unwrap();
            cvode.state_at(3.0 * end).unwrap();
        }
    }
}

#[test]
fn limits_of_step_and_order_are_kept() {
    let options = Options::default().max_step(0.01).initial_step(1e-5).max_order(2);
    let mut cvode = pendulum_at(0.0, &options);
    assert_eq!(cvode.step_towards(1.0).unwrap(), 1e-5); // short enough for the error test
    let mut before = cvode.time();
    while cvode.time() < 1.0 {
        let t = cvode.step_towards(1.0).unwrap();
        assert!(t - before <= 0.01 * (1.0 + 1e-12));
        assert!(cvode.statistics().last_order <= 2);
        before = t;
    }
    // The first step has the given length backwards too.
    let mut backwards = pendulum_at(0.0, &options);
    assert_eq!(backwards.step_towards(-1.0).unwrap(), -1e-5);
}

#[test]
fn trajectories_are_read_by_time_and_by_component() {
    let motion =
        solve(erased(from_fn(2, pendulum)), 0.0, &[1.0, 0.0], &[0.0, 1.0], &Options::default()).unwrap();
    assert_eq!((motion.dim(), motion.len(), motion.is_empty()), (2, 2, false));
    assert_eq!(motion.states(), [motion.state(0), motion.state(1)].concat());
    assert_eq!(motion.component(1).collect::<Vec<_>>(), [0.0, motion.state(1)[1]]);
    assert_eq!(motion.last(), Some((1.0, motion.state(1))));
    assert_eq!(motion.iter().len(), 2);
}

#[test]
fn statistics_count_all_evaluations() {
    for method in [Method::Adams, Method::Bdf] {
        for solver in [NonlinearSolver::Newton, NonlinearSolver::FixedPoint] {
            let calls = Cell::new(0);
            let field = from_fn(2, |t, y, ydot| {
                calls.set(calls.get() + 1);
                pendulum(t, y, ydot)
            });
            let options = Options::new(method).nonlinear_solver(solver);
            let motion = solve(erased(field), 0.0, &[1.0, 0.0], &[10.0], &options).unwrap();
            let work = motion.statistics();
            assert_eq!(work.rhs_evaluations, calls.get());
            assert_eq!((work.current_time, work.steps > 0, work.last_order > 0), (10.0, true, true));
            assert!(work.nonlinear_iterations >= work.steps);
            let newton = solver == NonlinearSolver::Newton;
            assert_eq!((work.jacobian_evaluations > 0, work.linear_setups > 0), (newton, newton));
        }
    }
}

#[test]
fn debug_shows_where_it_stands() {
    let cvode = pendulum_at(0.5, &Options::default());
    let shown = format!("{cvode:?}");
    assert!(
        shown.starts_with(
            "Integration { time: 0.5, state: [1.0, 0.0], events: [], statistics: Statistics { steps: 0, "
        ),
        "{shown}"
    );
}

/// Solvers are independent of each other and of the thread in which they were made.
#[test]
fn a_solver_moves_between_threads() {
    let run =
        |mut cvode: Integration<Cvode<_>>| std::thread::spawn(move || cvode.state_at(10.0).unwrap().to_vec());
    let cvode = |phase: f64| {
        let field = pc_solve::from_fn(1, move |t: f64, _y: &[f64], ydot: &mut [f64]| {
            ydot[0] = (t + phase).cos();
            Ok(())
        });
        Integration::new(field, 0.0, &[phase.sin()], &Options::default()).unwrap()
    };
    let threads: Vec<_> = (0..8).map(|i| (f64::from(i), run(cvode(f64::from(i))))).collect();
    for (phase, thread) in threads {
        let y = thread.join().unwrap()[0];
        assert!((y - (10.0 + phase).sin()).abs() < 1e-6);
    }
}

/// A closure may be the observer of one run and be used again.
#[test]
fn observers_may_borrow() {
    let mut count = 0;
    let mut observe = |_: f64, _: &[f64]| -> ControlFlow<()> {
        count += 1;
        Continue(())
    };
    let mut cvode = pendulum_at(0.0, &Options::default());
    cvode.run(&[1.0, 2.0], &mut observe).unwrap();
    cvode.run(&[2.0, 3.0], &mut observe).unwrap();
    assert_eq!(count, 4);
}

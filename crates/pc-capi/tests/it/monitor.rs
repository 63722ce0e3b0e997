//! A solver at another start, followed step by step, with its errors and inequalities.

use std::ffi::{c_int, c_void};
use std::ptr;
use std::sync::atomic::{AtomicUsize, Ordering::SeqCst};

use crate::common::{Model, Solver, System, by_event, call, sharp, stopped};
use pc::pc_status::*;
use pc::*;

/// The ends of steps that a monitor has received, and after how many of them it stops.
struct Steps {
    list: Vec<(f64, Vec<f64>, c_int, f64)>,
    most: usize,
}

static DESTROYED: AtomicUsize = AtomicUsize::new(0);

unsafe extern "C" fn follow(
    t: f64,
    y: *const f64,
    n: usize,
    order: c_int,
    step: f64,
    user: *mut c_void,
) -> c_int {
    // SAFETY: steps, and a state as long as said.
    let (steps, y) = unsafe { (&mut *user.cast::<Steps>(), std::slice::from_raw_parts(y, n)) };
    steps.list.push((t, y.to_vec(), order, step));
    c_int::from(steps.list.len() >= steps.most)
}

unsafe extern "C" fn destroy(_: *mut c_void) {
    DESTROYED.fetch_add(1, SeqCst);
}

fn watch(solver: &Solver, steps: &mut Steps) {
    let user = ptr::from_mut(steps).cast();
    // SAFETY: a live solver, and steps that live longer than they are followed.
    call(|error| unsafe { pc_solver_set_monitor(solver.0, Some(follow), user, Some(destroy), error) })
        .unwrap();
}

fn statistics(solver: &Solver) -> pc_statistics {
    let mut work = pc_statistics::default();
    let size = size_of::<pc_statistics>();
    // SAFETY: a live solver and room for the numbers.
    call(|error| unsafe { pc_solver_statistics(solver.0, &raw mut work, size, error) }).unwrap();
    work
}

fn reset(solver: &Solver, t: f64, y: &[f64]) -> Result<(), crate::common::Refusal> {
    // SAFETY: a live solver and as many numbers as said.
    call(|error| unsafe { pc_solver_reset(solver.0, t, y.as_ptr(), y.len(), error) })
}

fn options(method: pc_method) -> pc_solver_options {
    pc_solver_options { method: method as c_int, ..sharp() }
}

/// The numbers after a reset are those of a new solver, to the last bit, with every method.
#[test]
fn a_solver_that_is_reset_is_like_a_new_one() {
    let methods = [
        pc_method::PC_ADAMS,
        pc_method::PC_BDF,
        pc_method::PC_DOP853,
        pc_method::PC_TAYLOR,
        pc_method::PC_AUTO,
    ];
    let system = System::of("heavy-top-lagrange");
    let (t, mut y) = system.start();
    for method in methods {
        let options = options(method);
        let used = Solver::of(&system, &options);
        used.advance(0.7).0.unwrap();
        y[0] += 0.1;
        reset(&used, t, &y).unwrap();
        assert_eq!(statistics(&used).steps, 0);
        let mut fresh = ptr::null_mut();
        // SAFETY: live objects and a place for the handle.
        call(|error| unsafe {
            pc_solver_new(system.0, &raw const options, t, y.as_ptr(), y.len(), &raw mut fresh, error)
        })
        .unwrap();
        let mut expected = vec![0.0; y.len()];
        // SAFETY: a live solver, freed once, and room as said.
        unsafe {
            call(|error| pc_solver_advance(fresh, -0.5, expected.as_mut_ptr(), expected.len(), error))
                .unwrap();
            pc_solver_free(fresh);
        }
        assert_eq!(used.advance(-0.5).1, expected);
    }
    let solver = Solver::of(&system, &sharp());
    solver.advance(0.2).0.unwrap();
    let before = solver.advance(0.2).1;
    assert_eq!(reset(&solver, 0.0, &y[1..]).unwrap_err().message, "y: 5 numbers instead of 6");
    assert_eq!(reset(&solver, f64::NAN, &y).unwrap_err().status, PC_INVALID_ARGUMENT);
    let refused = reset(&solver, 0.0, &[f64::INFINITY, 1.0, 1.0, 0.0, 0.0, 0.0]).unwrap_err();
    assert_eq!(refused.status, PC_INVALID_ARGUMENT, "{}", refused.message);
    assert_eq!(solver.advance(0.2), (Ok(()), before)); // unchanged
}

/// Events, their observers and counts: the ball bounces as often as before.
#[test]
fn events_are_counted_anew_after_a_reset() {
    let system = System::of("bouncing-ball");
    let solver = Solver::of(&system, &sharp());
    let count = || {
        let mut count = 0;
        // SAFETY: a live solver and a place for the number.
        call(|error| unsafe { pc_solver_event_occurrences(solver.0, 0, &raw mut count, error) }).unwrap();
        count
    };
    solver.advance(1.0).0.unwrap();
    let bounces = count();
    assert!(bounces > 0);
    let (t, y) = system.start();
    reset(&solver, t, &y).unwrap();
    assert_eq!(count(), 0);
    solver.advance(1.0).0.unwrap();
    assert_eq!(count(), bounces);
}

#[test]
fn a_monitor_follows_every_step_and_stops() {
    let system = System::of("heavy-top-lagrange");
    for method in [pc_method::PC_ADAMS, pc_method::PC_DOP853, pc_method::PC_TAYLOR] {
        let is_adams = matches!(method, pc_method::PC_ADAMS);
        let (alone, solver) =
            (Solver::of(&system, &options(pc_method::PC_ADAMS)), Solver::of(&system, &options(method)));
        let mut steps = Steps { list: Vec::new(), most: usize::MAX };
        watch(&solver, &mut steps);
        let (ended, y) = solver.advance(1.5);
        assert_eq!(ended, Ok(()));
        if is_adams {
            assert_eq!(alone.advance(1.5).1, y); // it does not change the steps
        }
        let work = statistics(&solver);
        assert_eq!(steps.list.len() as u64, work.steps);
        let (t, _, order, length) = steps.list.last().unwrap();
        assert_eq!((*t, *order as u64, *length), (work.step_time, work.last_order, work.last_step));
        let times: Vec<f64> = steps.list.iter().map(|step| step.0).collect();
        assert!(times.windows(2).all(|pair| pair[0] < pair[1]) && *t >= 1.5);
        for pair in steps.list.windows(2) {
            assert!((pair[1].0 - pair[0].0 - pair[1].3).abs() < 1e-12);
        }
        let known = steps.list.len();
        solver.step(9.0).0.unwrap(); // to the end of the step in which it is, or a new one
        steps.most = steps.list.len() + 2;
        let (ended, _) = solver.advance(5.0);
        assert_eq!((ended, steps.list.len()), (Err(stopped()), steps.most));
        assert!(steps.list.len() > known);
        let mut now = 0.0;
        // SAFETY: a live solver and a place for the time.
        call(|error| unsafe { pc_solver_time(solver.0, &raw mut now, error) }).unwrap();
        assert_eq!(now, steps.list.last().unwrap().0);
        steps.most = usize::MAX;
        let followed = steps.list.len();
        let mut dense = ptr::null_mut();
        // SAFETY: a live solver, a place for the handle, which is freed once.
        unsafe {
            call(|error| pc_solver_run_dense(solver.0, now + 1.0, &raw mut dense, error)).unwrap();
            pc_dense_free(dense);
        }
        assert!(steps.list.len() > followed);
        let (before, followed) = (DESTROYED.load(SeqCst), steps.list.len());
        // SAFETY: a live solver; no function is set.
        call(|error| unsafe { pc_solver_set_monitor(solver.0, None, ptr::null_mut(), Some(destroy), error) })
            .unwrap();
        assert!(DESTROYED.load(SeqCst) > before);
        solver.advance(now + 1.5).0.unwrap();
        assert_eq!(steps.list.len(), followed);
    }
}

/// Before an event a monitor receives the state before it.
#[test]
fn a_monitor_is_called_before_an_event() {
    let text = "[coordinates]\nx = 1\n[lagrangian]\nkinetic = \"x'^2/2\"\npotential = \"10*x\"\n\
        [events.ground]\nwhen = \"x\"\nterminal = true\n";
    let system = Model::text(text).unwrap().system(pc_form::PC_POINCARE).unwrap();
    let solver = Solver::of(&system, &sharp());
    let mut steps = Steps { list: Vec::new(), most: usize::MAX };
    watch(&solver, &mut steps);
    assert_eq!(solver.advance(1.0).0, Err(by_event()));
    let (t, y, ..) = steps.list.last().unwrap();
    assert!((t - 0.2f64.sqrt()).abs() < 1e-12 && y[0].abs() < 1e-12, "{t} {y:?}");
}

fn errors(solver: &Solver, dim: usize) -> Result<(Vec<f64>, Vec<f64>), crate::common::Refusal> {
    let (mut weights, mut errors) = (vec![0.0; dim], vec![0.0; dim]);
    // SAFETY: a live solver and room as said.
    call(|error| unsafe {
        let (w, e) = (weights.as_mut_ptr(), errors.as_mut_ptr());
        pc_solver_errors(solver.0, w, weights.len(), e, errors.len(), error)
    })?;
    Ok((weights, errors))
}

#[test]
fn errors_are_those_of_the_error_test() {
    let system = System::of("heavy-top-lagrange");
    let rough = |method: pc_method| pc_solver_options {
        method: method as c_int,
        relative_tolerance: 1e-6,
        absolute_tolerance: 1e-8,
        ..Default::default()
    };
    for method in [pc_method::PC_ADAMS, pc_method::PC_BDF] {
        let solver = Solver::of(&system, &rough(method));
        assert_eq!(errors(&solver, 6).unwrap_err().status, PC_INVALID_ARGUMENT);
        (0..29).for_each(|_| solver.step(9.0).0.unwrap());
        let (_, _, y) = solver.step(9.0);
        let (weights, errors) = errors(&solver, 6).unwrap();
        for (weight, y) in weights.iter().zip(&y) {
            let expected = 1.0 / (1e-6 * y.abs() + 1e-8);
            assert!((weight - expected).abs() < 1e-12 * expected);
        }
        let sum: f64 = weights.iter().zip(&errors).map(|(weight, error)| (weight * error).powi(2)).sum();
        let test = (sum / 6.0).sqrt();
        assert!(test > 1e-6 && test <= 1.0, "{test}");
    }
    let solver = Solver::of(&system, &rough(pc_method::PC_DOP853));
    solver.step(9.0).0.unwrap();
    let refused = errors(&solver, 6).unwrap_err();
    assert_eq!(
        (refused.status, refused.message.as_str()),
        (
            PC_UNSUPPORTED,
            "an estimate of the error of each component is not available for this system: the method of the last step \
             has none; PC_ADAMS and PC_BDF do"
        )
    );
    let mut weights = [0.0; 6];
    // SAFETY: a live solver and room as said.
    call(|error| unsafe { pc_solver_errors(solver.0, weights.as_mut_ptr(), 6, ptr::null_mut(), 0, error) })
        .unwrap();
    assert!(weights.iter().all(|weight| *weight > 0.0));
}

/// ẏ = −50 y falls below 0 in long steps, unless it may not.
#[test]
fn inequalities_hold_at_the_ends_of_steps() {
    let text = "[coordinates]\nx = 0\n[states]\nz = { rate = \"-50*z\", start = 1 }\n[lagrangian]\nkinetic = \"x'^2/2\"\n";
    let system = Model::text(text)
        .unwrap_or_else(|refusal| panic!("{refusal:?}"))
        .system(pc_form::PC_POINCARE)
        .unwrap();
    let wanted = [0, 0, 1];
    let with = |method: pc_method, inequalities: &[c_int]| pc_solver_options {
        method: method as c_int,
        relative_tolerance: 1e-3,
        absolute_tolerance: 1e-3,
        inequalities: inequalities.as_ptr(),
        inequalities_length: inequalities.len(),
        ..Default::default()
    };
    let least = |options: &pc_solver_options| {
        let solver = Solver::of(&system, options);
        (0..60).map(|_| solver.step(9.0).2[2]).fold(f64::INFINITY, f64::min)
    };
    for method in [pc_method::PC_ADAMS, pc_method::PC_BDF, pc_method::PC_DOP853, pc_method::PC_AUTO] {
        assert!(least(&with(method, &wanted)) >= 0.0);
    }
    assert!(least(&with(pc_method::PC_BDF, &[])) < 0.0);
    let refused = |options: &pc_solver_options| {
        let mut solver = ptr::null_mut();
        // SAFETY: live objects and a place for the handle, which stays null.
        call(|error| unsafe { pc_solver_new(system.0, options, 0.0, ptr::null(), 0, &raw mut solver, error) })
            .unwrap_err()
    };
    let taylor = refused(&with(pc_method::PC_TAYLOR, &wanted));
    assert_eq!(taylor.status, PC_INVALID_ARGUMENT, "{}", taylor.message);
    assert!(taylor.message.contains("inequalities"), "{}", taylor.message);
    let start = refused(&with(pc_method::PC_BDF, &[0, 0, -1])).message;
    assert_eq!(start, "z at the start is 1, but must be zero or negative");
    assert_eq!(refused(&with(pc_method::PC_BDF, &[0, 0, 3])).message, "3 is not a value of pc_inequality");
    assert_eq!(refused(&with(pc_method::PC_BDF, &[0, 1])).message, "inequalities: 2 numbers instead of 3");
}

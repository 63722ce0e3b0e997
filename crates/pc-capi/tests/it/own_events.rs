//! Events that functions of the program compute, and wrong calls about events.

use std::ffi::{c_int, c_void};
use std::ptr;

use crate::common::ball::{G, assert_close, bounces};
use crate::common::{Model, Refusal, Solver, System, by_event, c, call, sharp};
use pc::pc_status::*;
use pc::*;

/// An observer that does nothing.
extern "C" fn tell(
    _event: usize,
    _t: f64,
    _before: *const f64,
    _after: *const f64,
    _y_length: usize,
    _user: *mut c_void,
) -> c_int {
    0
}

/// An event of the tests: y[0] − level, with the codes that its functions return.
#[derive(Default)]
struct Own {
    level: f64,
    restitution: f64,
    /// Returned by the function from this time on.
    fails: Option<(f64, c_int)>,
    /// Returned by the reset.
    reset: c_int,
    value: Option<f64>,
    destroyed: usize,
}

extern "C" fn above(t: f64, y: *const f64, y_length: usize, value: *mut f64, user: *mut c_void) -> c_int {
    // SAFETY: what the tests pass; a state of two components.
    unsafe {
        let own = &*user.cast::<Own>();
        assert_eq!(y_length, 2);
        match own.fails {
            Some((from, code)) if t >= from => return code,
            _ => value.write(own.value.unwrap_or(*y - own.level)),
        }
    }
    0
}

extern "C" fn rebound(_t: f64, y: *mut f64, y_length: usize, user: *mut c_void) -> c_int {
    // SAFETY: what the tests pass; a state of two components.
    unsafe {
        let own = &*user.cast::<Own>();
        assert_eq!(y_length, 2);
        *y.add(1) *= -own.restitution;
        own.reset
    }
}

extern "C" fn destroy(user: *mut c_void) {
    // SAFETY: what the tests pass.
    unsafe { (*user.cast::<Own>()).destroyed += 1 };
}

/// Adds a falling event with these functions; `own` outlives the solver.
fn add(solver: &Solver, own: &mut Own, terminal: bool, reset: bool) -> Result<(), Refusal> {
    let name = c("mine");
    let (user, reset): (_, pc_event_reset) =
        ((&raw mut *own).cast(), if reset { Some(rebound) } else { None });
    let direction = pc_direction::PC_FALLING as c_int;
    // SAFETY: a live solver, and functions with what they take.
    call(|error| unsafe {
        let (name, terminal) = (name.as_ptr(), terminal.into());
        pc_solver_add_event(
            solver.0,
            name,
            direction,
            terminal,
            Some(above),
            reset,
            user,
            Some(destroy),
            error,
        )
    })
}

/// A ball without a floor.
fn falling() -> System {
    let text = "[coordinates]\ny = 1.0\n[lagrangian]\nkinetic = \"y'^2/2\"\npotential = \"9.81*y\"\n";
    Model::text(text).unwrap().system(pc_form::PC_POINCARE).unwrap()
}

#[test]
fn functions_of_the_program_are_in_no_checkpoint() {
    let (mut own, solver) = (Own::default(), Solver::of(&falling(), &sharp()));
    add(&solver, &mut own, false, false).unwrap();
    let (mut data, mut length) = (ptr::null_mut(), 0);
    // SAFETY: a live solver, null where it is allowed, and places for results.
    let refusal = call(|error| unsafe {
        pc_solver_checkpoint(solver.0, ptr::null(), &raw mut data, &raw mut length, error)
    });
    let refusal = refusal.unwrap_err();
    assert_eq!((refusal.status, data.is_null()), (PC_UNSUPPORTED, true));
    assert_eq!(
        refusal.message,
        "a checkpoint is not available for this system: there are events of the program's own"
    );
    drop(solver); // before the argument of its function
}

#[test]
fn no_event_is_added_after_the_first_step() {
    let (mut own, solver) = (Own::default(), Solver::of(&System::of("bouncing-ball"), &sharp()));
    solver.advance(0.6).0.unwrap();
    let (mut data, mut length) = (ptr::null_mut(), 0);
    // SAFETY: a live solver and places for results; the bytes are freed once.
    unsafe {
        call(|error| pc_solver_checkpoint(solver.0, ptr::null(), &raw mut data, &raw mut length, error))
            .unwrap();
        pc_bytes_free(data);
    }
    // The same after a restart at a checkpoint.
    let refusal = add(&solver, &mut own, false, false).unwrap_err();
    assert_eq!(refusal.status, PC_INVALID_ARGUMENT);
    assert_eq!(refusal.message, "an event must come before the first step, and one has been taken");
    assert_eq!(own.destroyed, 1);
}

#[test]
fn a_reset_of_the_program_makes_the_same_ball() {
    let mut own = Own { restitution: 0.8, ..Own::default() };
    let system = falling();
    let solver = Solver::of(&system, &sharp());
    add(&solver, &mut own, false, true).unwrap();
    let model = System::of("bouncing-ball");
    let other = Solver::of(&model, &sharp());
    let (reached, expected) = (solver.advance(3.0), other.advance(3.0));
    assert_eq!((&reached.0, solver.occurrences(0)), (&Ok(()), other.occurrences(0)));
    assert_close(&reached.1, &expected.1);
    assert_close(&[solver.last(0).unwrap().0], &bounces(0.8, 3.0)[bounces(0.8, 3.0).len() - 1..]);
    drop(system); // the solver does not need it
    assert_eq!(own.destroyed, 0);
    drop(solver);
    assert_eq!(own.destroyed, 1);
}

extern "C" fn count(_t: f64, _y: *const f64, _y_length: usize, user: *mut c_void) -> c_int {
    // SAFETY: what the test passes.
    unsafe { *user.cast::<usize>() += 1 };
    0
}

#[test]
fn a_terminal_event_ends_each_kind_of_call_and_the_next_continues() {
    let mut own = Own { level: 0.5, ..Own::default() };
    let at = (2.0 * 0.5 / G).sqrt();
    let system = System::of("bouncing-ball");
    let terminal = |solver: &Solver| {
        let mut event = 9;
        // SAFETY: a live solver and a place for a number.
        call(|error| unsafe { pc_solver_terminal_event(solver.0, &raw mut event, error) }).map(|()| event)
    };
    let mut with_event = || {
        let solver = Solver::of(&system, &sharp());
        add(&solver, &mut own, true, false).unwrap();
        solver
    };
    let solver = with_event();
    assert_eq!(terminal(&solver).unwrap_err().status, PC_NOT_FOUND);
    let (outcome, y) = solver.advance(0.4);
    assert_eq!(outcome, Err(by_event()));
    assert_close(&[solver.time(), y[0], y[1]], &[at, 0.5, -G * at]);
    assert_eq!(terminal(&solver), Ok(1));
    assert_eq!(solver.last(1).unwrap().2, y);
    solver.advance(0.4).0.unwrap();
    assert_eq!(terminal(&solver).unwrap_err().status, PC_NOT_FOUND);

    // In a run, the event is the last output.
    let solver = with_event();
    let (mut outputs, times) = (0_usize, [0.1, 0.2, 0.3, 0.4, 0.5]);
    let user = (&raw mut outputs).cast();
    // SAFETY: a live solver, times as many as said, and what the observer takes.
    let run = |error| unsafe { pc_solver_run(solver.0, times.as_ptr(), 5, Some(count), user, error) };
    assert_eq!((call(run), outputs), (Err(by_event()), 4));
    assert_close(&[solver.time()], &[at]);

    let solver = with_event();
    let (outcome, motion) = solver.run_dense(1.0);
    assert_eq!((outcome, motion.span()), (Err(by_event()), (0.0, solver.time())));
    assert_close(&[motion.span().1], &[at]);

    let solver = with_event();
    let ends = std::iter::repeat_with(|| solver.step(1.0)).find(|(outcome, ..)| outcome.is_err());
    let (outcome, t, y) = ends.unwrap();
    assert_eq!(outcome, Err(by_event()));
    assert_close(&[t, y[0]], &[at, 0.5]);
}

#[test]
fn failures_of_functions_are_reported() {
    let system = System::of("bouncing-ball");
    let refused = |own: &mut Own, reset| {
        let solver = Solver::of(&system, &sharp());
        add(&solver, own, false, reset).unwrap();
        let refusal = solver.advance(1.0).0.unwrap_err();
        assert_eq!(refusal.status, PC_INTEGRATION);
        assert!(solver.time() >= 0.0 && solver.time() <= 1.0);
        // It stays at the last state that could be computed.
        assert!(solver.state().iter().all(|y| y.is_finite()));
        (solver.time(), refusal.message)
    };
    let own = || Own { level: 0.5, ..Own::default() };
    let (t, message) = refused(&mut Own { fails: Some((0.3, 7)), ..own() }, false);
    assert!(t < 0.3 && message.starts_with("the event mine cannot be evaluated at t = 0."), "{message}");
    assert!(message.ends_with(": the function of the event mine returned 7"), "{message}");
    let (t, message) = refused(&mut Own { reset: -3, ..own() }, true);
    assert_close(&[t], &[(1.0 / G).sqrt()]);
    assert!(message.starts_with("the event mine cannot reset the state at t = 0.319"), "{message}");
    assert!(message.ends_with(": the reset of the event mine returned -3"), "{message}");
    let (_, message) = refused(&mut Own { restitution: f64::NAN, ..own() }, true);
    assert!(message.contains("the event mine sets y' to NaN"), "{message}");

    // An event that fails at the start is not added.
    let solver = Solver::of(&system, &sharp());
    let mut wrong = Own { fails: Some((0.0, 7)), ..Own::default() };
    let refusal = add(&solver, &mut wrong, false, false).unwrap_err();
    assert_eq!((refusal.status, wrong.destroyed), (PC_INTEGRATION, 1));
    let mut infinite = Own { value: Some(f64::INFINITY), ..Own::default() };
    let refusal = add(&solver, &mut infinite, false, false).unwrap_err();
    assert!(
        refusal.message.ends_with("the function of the event mine is inf at t = 0"),
        "{}",
        refusal.message
    );
    // SAFETY: a live solver.
    assert_eq!(unsafe { pc_solver_event_count(solver.0.as_ref()) }, 1);
    solver.advance(1.0).0.unwrap();
    // Nor after the first step.
    let mut late = Own::default();
    let refusal = add(&solver, &mut late, false, false).unwrap_err();
    assert_eq!((refusal.status, late.destroyed, infinite.destroyed), (PC_INVALID_ARGUMENT, 1, 1));
    assert_eq!(refusal.message, "an event must come before the first step, and one has been taken");
}

#[test]
fn missing_events_are_refused() {
    let (model, system) = (Model::named("bouncing-ball"), System::of("bouncing-ball"));
    let solver = Solver::of(&system, &sharp());
    let (name, null) = (c"x".as_ptr(), ptr::null());
    let (no_system, no_solver, none): (*mut pc_system, *mut pc_solver, *mut f64) =
        (ptr::null_mut(), ptr::null_mut(), ptr::null_mut());
    let (mut own, mut y, mut z, mut size, mut number) = (Own::default(), [0.0; 2], [0.0; 2], 0, 0_u64);
    let user: *mut c_void = (&raw mut own).cast();
    let (y, z, size, number) = (y.as_mut_ptr(), z.as_mut_ptr(), &raw mut size, &raw mut number);
    let mut draft = ptr::null_mut();
    // SAFETY: a place for the handle.
    call(|error| unsafe { pc_model_new(name, &raw mut draft, error) }).unwrap();
    let draft = Model(draft);
    refused! { PC_INVALID_ARGUMENT, "is a null pointer";
        pc_model_add_event(ptr::null_mut(), name, name, 0, 0);
        pc_model_add_event(draft.0, null, name, 0, 0);
        pc_model_add_event(draft.0, name, null, 0, 0);
        pc_model_add_event_reset(ptr::null_mut(), name, name, name);
        pc_model_add_event_reset(draft.0, null, name, name);
        pc_model_add_event_reset(draft.0, name, null, name);
        pc_model_add_event_reset(draft.0, name, name, null);
        pc_system_events(no_system, 0.0, y, 2, z, 1);
        pc_system_events(system.0, 0.0, ptr::null(), 2, z, 1);
        pc_system_events(system.0, 0.0, y, 2, none, 1);
        pc_system_event_reset(no_system, 0, 0.0, y, 2);
        pc_system_event_reset(system.0, 0, 0.0, none, 2);
        pc_solver_observe_events(no_solver, Some(tell), user);
        pc_solver_add_event(no_solver, name, 0, 0, Some(above), None, user, Some(destroy));
        pc_solver_add_event(solver.0, null, 0, 0, Some(above), None, user, Some(destroy));
        pc_solver_add_event(solver.0, name, 0, 0, None, None, user, Some(destroy));
        pc_solver_event_occurrences(no_solver, 0, number);
        pc_solver_event_occurrences(solver.0, 0, ptr::null_mut());
        pc_solver_last_occurrence(no_solver, 0, y, y, 2, z, 2);
        pc_solver_last_occurrence(solver.0, 0, y, none, 2, z, 2);
        pc_solver_last_occurrence(solver.0, 0, y, y, 2, none, 2);
        pc_solver_terminal_event(no_solver, size);
    }
    assert_eq!(own.destroyed, 3);
    refused! { PC_INVALID_ARGUMENT, "numbers instead of 2";
        pc_system_events(system.0, 0.0, y, 3, z, 1);
        pc_system_event_reset(system.0, 0, 0.0, y, 1);
        pc_solver_last_occurrence(solver.0, 0, z, y, 1, z, 2);
        pc_solver_last_occurrence(solver.0, 0, z, y, 2, z, 3);
        pc_solver_last_occurrence(solver.0, 0, z, none, 0, z, 0);
    }
    refused! { PC_INVALID_ARGUMENT, "numbers instead of 1"; pc_system_events(system.0, 0.0, y, 2, z, 2); }
    refused! { PC_INVALID_ARGUMENT, "share memory, but must be separate";
        pc_system_events(system.0, 0.0, y, 2, y, 1);
        pc_solver_last_occurrence(solver.0, 0, z, y, 2, y, 2);
    }
    refused! { PC_INVALID_ARGUMENT, "the events: index 7 is not below 1";
        pc_system_event_reset(system.0, 7, 0.0, y, 2);
        pc_solver_event_occurrences(solver.0, 7, number);
        pc_solver_last_occurrence(solver.0, 7, z, y, 2, z, 2);
    }
    refused! { PC_INVALID_ARGUMENT, "-2 is not a value of pc_direction";
        pc_solver_add_event(solver.0, name, -2, 0, Some(above), None, user, Some(destroy));
        pc_model_add_event(draft.0, name, name, -2, 0);
    }
    refused! { PC_INVALID_ARGUMENT, "this one was read from a text";
        pc_model_add_event(model.0, name, name, 0, 0);
        pc_model_add_event_reset(model.0, name, name, name);
    }
    // SAFETY: null, or live handles.
    unsafe {
        assert_eq!(
            (pc_system_event_count(no_system.as_ref()), pc_solver_event_count(no_solver.as_ref())),
            (0, 0)
        );
        assert!(
            pc_system_event_name(no_system.as_ref(), 0).is_null()
                && pc_system_event_name(system.0.as_ref(), 1).is_null()
        );
        assert!(
            pc_solver_event_name(no_solver.as_ref(), 0).is_null()
                && pc_solver_event_name(solver.0.as_ref(), 1).is_null()
        );
        assert_eq!(
            (
                pc_system_event_direction(no_system.as_ref(), 0),
                pc_system_event_direction(system.0.as_ref(), 1)
            ),
            (0, 0)
        );
        assert_eq!(
            (
                pc_system_event_resets(no_system.as_ref(), 0),
                pc_system_event_is_terminal(system.0.as_ref(), 1)
            ),
            (0, 0)
        );
    }
}

/// The sensitivity of the fall y = h − g t²/2 by g, which an event that resets nothing leaves as it is.
#[test]
fn sensitivities_go_on_through_an_event_without_a_reset() {
    let text = "[parameters]\ng = 9.81\n[coordinates]\ny = 1.0\n[lagrangian]\nkinetic = \"y'^2/2\"\n\
                potential = \"g*y\"\n[events.low]\nwhen = \"y - 0.25\"\n";
    let model = Model::text(text).unwrap();
    // SAFETY: a live model.
    call(|error| unsafe { pc_model_differentiate(model.0, 1, error) }).unwrap();
    let system = model.system(pc_form::PC_POINCARE).unwrap();
    let solver = Solver::of(&system, &sharp());
    // SAFETY: a live solver, and no start.
    call(|error| unsafe { pc_solver_add_sensitivity(solver.0, 0, ptr::null(), 0, error) }).unwrap();
    let mut own = Own { level: 0.5, ..Own::default() };
    add(&solver, &mut own, false, false).unwrap();
    let (t, mut column) = (0.4, [f64::NAN; 2]);
    solver.advance(t).0.unwrap();
    let mut count = 0;
    // SAFETY: a live solver, and a place for a number.
    call(|error| unsafe { pc_solver_event_occurrences(solver.0, 1, &raw mut count, error) }).unwrap();
    // SAFETY: a live solver, and room for a column.
    call(|error| unsafe { pc_solver_sensitivity(solver.0, 0, column.as_mut_ptr(), 2, error) }).unwrap();
    assert_eq!(count, 1);
    for (found, expected) in column.iter().zip([-t * t / 2.0, -t]) {
        // The tolerance of the integration.
        assert!((found - expected).abs() < 1e-9, "{found} is not {expected}");
    }
}

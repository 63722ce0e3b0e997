//! Events: those of the model, and those of the program.

use std::ffi::{CStr, c_int, c_void};
use std::ptr;

use crate::common::ball::{G, assert_close, bounces};
use crate::common::{Model, Solver, System, by_event, c, call, sharp, stopped, taken};
use pc::pc_status::*;
use pc::*;

/// The events that an observer received, and the number after which it stops.
struct Told {
    times: Vec<f64>,
    states: Vec<(Vec<f64>, Vec<f64>)>,
    stop_after: usize,
    solver: *mut pc_solver,
}

extern "C" fn tell(
    event: usize,
    t: f64,
    before: *const f64,
    after: *const f64,
    y_length: usize,
    user: *mut c_void,
) -> c_int {
    // SAFETY: what the tests pass; the states are as long as said.
    unsafe {
        let told = &mut *user.cast::<Told>();
        let state = |y| std::slice::from_raw_parts(y, y_length).to_vec();
        assert_eq!(CStr::from_ptr(pc_solver_event_name(told.solver.as_ref(), event)), c"bounce");
        let mut now = 0.0;
        assert_eq!(pc_solver_time(told.solver, &raw mut now, ptr::null_mut()), PC_BUSY);
        pc_solver_free(told.solver); // has no effect
        told.times.push(t);
        told.states.push((state(before), state(after)));
        c_int::from(told.times.len() >= told.stop_after)
    }
}

fn observed(solver: &Solver, stop_after: usize) -> Box<Told> {
    let mut told = Box::new(Told { times: vec![], states: vec![], stop_after, solver: solver.0 });
    let user = (&raw mut *told).cast();
    // SAFETY: a live solver; `told` outlives its use.
    call(|error| unsafe { pc_solver_observe_events(solver.0, Some(tell), user, error) }).unwrap();
    told
}

#[test]
fn a_ball_bounces_at_the_times_of_the_closed_form() {
    let expected = bounces(0.8, 3.0);
    assert!(expected.len() > 5);
    for form in [pc_form::PC_POINCARE, pc_form::PC_CANONICAL] {
        let system = Model::named("bouncing-ball").system(form).unwrap();
        let solver = Solver::of(&system, &sharp());
        assert_eq!(solver.last(0).unwrap_err().message, "the event bounce has not occurred");
        let told = observed(&solver, usize::MAX);
        solver.advance(3.0).0.unwrap();
        assert_close(&told.times, &expected);
        for (before, after) in &told.states {
            // A single product, with m = 1.
            assert_eq!((after[0], after[1]), (before[0], -0.8 * before[1]));
        }
        assert_eq!(solver.occurrences(0), expected.len() as u64);
        let (t, before, after) = solver.last(0).unwrap();
        assert_eq!((Some(&t), Some(&(before, after))), (told.times.last(), told.states.last()));
        // SAFETY: a live solver, and no places for states.
        let only_the_time = |error| unsafe {
            let (mut t, none) = (0.0, ptr::null_mut());
            pc_solver_last_occurrence(solver.0, 0, &raw mut t, none, 0, none, 0, error)
        };
        call(only_the_time).unwrap();
    }
}

#[test]
fn steps_go_from_event_to_event_and_are_those_of_an_advance() {
    let system = System::of("bouncing-ball");
    let (solver, other) = (Solver::of(&system, &sharp()), Solver::of(&system, &sharp()));
    let (told, expected) = (observed(&solver, usize::MAX), observed(&other, usize::MAX));
    other.advance(2.0).0.unwrap();
    let (mut ends, mut t) = (vec![], 0.0);
    while t < 2.0 {
        let (outcome, end, y) = solver.step(2.0);
        outcome.unwrap();
        assert!(end > t && y.iter().all(|y| y.is_finite()));
        if told.times.last() == Some(&end) {
            let refusal = solver.interpolate(0.5 * (t + end), 0).unwrap_err();
            assert_eq!(refusal.status, PC_INVALID_ARGUMENT); // the reset has restarted the method
        } else {
            let middle = solver.interpolate(0.5 * (t + end), 0).unwrap();
            if end < told.times.first().copied().unwrap_or(f64::INFINITY) {
                assert!((middle[0] - (1.0 - G / 8.0 * (t + end).powi(2))).abs() < 1e-10);
            }
            assert_eq!(solver.interpolate(end + 1.0, 0).unwrap_err().status, PC_INVALID_ARGUMENT);
        }
        ends.push(end);
        t = end;
    }
    // The steps are the same, since all go towards the same time.
    assert!(told.times.iter().zip(&expected.times).all(|(a, b)| a == b) && told.times.len() >= 3);
    assert!(told.times.iter().all(|t| ends.contains(t)));
    assert_eq!(solver.step(f64::NAN).0.unwrap_err().status, PC_INVALID_ARGUMENT);
}

#[test]
fn an_observer_of_events_stops_the_integration() {
    let system = System::of("bouncing-ball");
    let solver = Solver::of(&system, &sharp());
    let told = observed(&solver, 2);
    let (outcome, y) = solver.advance(3.0);
    assert_eq!(outcome, Err(stopped()));
    assert_close(&[solver.time()], &bounces(0.8, 3.0)[1..2]);
    assert_eq!(y, told.states[1].1);
    // SAFETY: a live solver.
    call(|error| unsafe { pc_solver_observe_events(solver.0, None, ptr::null_mut(), error) }).unwrap();
    solver.advance(3.0).0.unwrap();
    assert_eq!((told.times.len(), solver.occurrences(0)), (2, bounces(0.8, 3.0).len() as u64));
}

#[test]
fn accumulating_bounces_are_an_error() {
    let solver = Solver::of(&System::of("bouncing-ball"), &sharp());
    let refusal = solver.advance(5.0).0.unwrap_err();
    assert_eq!(refusal.status, PC_INTEGRATION);
    // t₀ (1 + e)/(1 − e) = 4.06.
    assert!(
        refusal.message.contains("the event bounce occurs at ever shorter intervals near t = 4.06"),
        "{}",
        refusal.message
    );
}

#[test]
fn events_are_declared_call_by_call() {
    let mut model = ptr::null_mut();
    let [name, y, dy, one, kinetic, potential, when, low, reset] =
        ["ball", "y", "y'", "e", "y'^2/2", "9.81*y", "y", "low \"one\"", "-e*y'"].map(c);
    // SAFETY: live handles, texts and places.
    unsafe {
        call(|error| pc_model_new(name.as_ptr(), &raw mut model, error)).unwrap();
        let model = Model(model);
        call(|error| pc_model_add_coordinate(model.0, y.as_ptr(), 1.0, error)).unwrap();
        call(|error| pc_model_add_parameter(model.0, one.as_ptr(), 0.8, error)).unwrap();
        call(|error| pc_model_set_kinetic(model.0, kinetic.as_ptr(), error)).unwrap();
        call(|error| pc_model_set_potential(model.0, potential.as_ptr(), error)).unwrap();
        let falling = pc_direction::PC_FALLING as c_int;
        call(|error| pc_model_add_event(model.0, low.as_ptr(), when.as_ptr(), falling, 0, error)).unwrap();
        let (low, dy, reset) = (low.as_ptr(), dy.as_ptr(), reset.as_ptr());
        call(|error| pc_model_add_event_reset(model.0, low, dy, reset, error)).unwrap();
        let mut text = ptr::null_mut();
        call(|error| pc_model_text(model.0, &raw mut text, error)).unwrap();
        let text = taken(text);
        let reset_entry = "\"low \\\"one\\\"\".\"reset\".\"y'\" = \"-e*y'\"\n";
        assert!(text.ends_with(reset_entry), "{text}");

        let refusal = call(|error| pc_model_add_event_reset(model.0, y.as_ptr(), dy, reset, error));
        assert_eq!(refusal.unwrap_err().status, PC_NOT_FOUND);
        let refusal = call(|error| pc_model_add_event(model.0, low, reset, 2, 0, error)).unwrap_err();
        assert_eq!(refusal.message, "2 is not a value of pc_direction");

        let system = model.system(pc_form::PC_POINCARE).unwrap();
        assert_eq!(
            (pc_system_event_count(system.0.as_ref()), pc_system_event_direction(system.0.as_ref(), 0)),
            (1, -1)
        );
        assert_eq!(
            (pc_system_event_is_terminal(system.0.as_ref(), 0), pc_system_event_resets(system.0.as_ref(), 0)),
            (0, 1)
        );
        assert_eq!(CStr::from_ptr(pc_system_event_name(system.0.as_ref(), 0)), c"low \"one\"");
        let solver = Solver::of(&system, &sharp());
        solver.advance(3.0).0.unwrap();
        assert_eq!(solver.occurrences(0), bounces(0.8, 3.0).len() as u64);

        // The error shows a wrong expression at its place.
        call(|error| pc_model_add_event(model.0, name.as_ptr(), name.as_ptr(), 0, 1, error)).unwrap();
        let refusal = model.system(pc_form::PC_POINCARE).err().unwrap();
        assert_eq!(refusal.status, PC_INVALID_MODEL);
        assert!(refusal.message.contains("the name `ball` is not declared"), "{}", refusal.message);
    }
}

/// The floor, the speed after a kick and the mass are parameters.
const KICKED: &str = r#"
[parameters]
m = 1.0
floor = 0.0
u = 3.0
[coordinates]
y = 1.0
[lagrangian]
kinetic = "m*y'^2/2"
potential = "9.81*m*y"
[events.kick]
when = "y - floor - 0*y'"
direction = "falling"
reset = { "y'" = "u" }
[events.slow]
when = "y' + 1"
terminal = true
"#;

#[test]
fn events_and_their_copies_use_the_current_parameters() {
    for (form, canonical) in [(pc_form::PC_POINCARE, false), (pc_form::PC_CANONICAL, true)] {
        let system = Model::text(KICKED).unwrap().system(form).unwrap();
        let reset = |system: &System, event, y: [f64; 2]| {
            let mut y = y;
            // SAFETY: a live system and a state as long as said.
            call(|error| unsafe { pc_system_event_reset(system.0, event, 0.0, y.as_mut_ptr(), 2, error) })
                .map(|()| y)
        };
        assert_eq!(system.at(pc_system_events, 0.0, &[1.0, 0.0], 2), Ok(vec![1.0, 1.0]));
        assert_eq!(reset(&system, 0, [0.0, -2.0]), Ok([0.0, 3.0]));
        // SAFETY: a live system.
        call(|error| unsafe { pc_system_set_parameters(system.0, [2.0, 0.5, 4.0].as_ptr(), 3, error) })
            .unwrap();
        let mut copy = ptr::null_mut();
        // SAFETY: a live system and a place for the copy.
        call(|error| unsafe { pc_system_clone(system.0, &raw mut copy, error) }).unwrap();
        let copy = System(copy);
        let mass = if canonical { 2.0 } else { 1.0 };
        for system in [&system, &copy] {
            assert_eq!(
                system.at(pc_system_events, 0.0, &[1.0, 3.0 * mass], 2),
                Ok(vec![0.5, 4.0]),
                "{canonical}"
            );
            assert_eq!(reset(system, 0, [0.5, -2.0]), Ok([0.5, 4.0 * mass]), "{canonical}");
            assert_eq!(reset(system, 1, [0.5, -2.0]), Ok([0.5, -2.0]));
            assert_eq!(reset(system, 2, [0.5, -2.0]).unwrap_err().status, PC_INVALID_ARGUMENT);
            // The same in an integration: y' = −1 at t = 1/g.
            let solver = Solver::of(system, &sharp());
            let (outcome, y) = solver.advance(1.0);
            assert_eq!(outcome, Err(by_event()));
            assert_close(&[solver.time(), y[1]], &[1.0 / G, -mass]);
            assert_eq!(solver.advance(0.315).0, Ok(()));
            assert_eq!(solver.advance(0.325).1[1].signum(), 1.0, "kicked at y = 1/2, t = 0.319");
        }
    }
}

//! Ensembles: each member is integrated as by a single solver.

use std::ffi::{CStr, c_int, c_void};
use std::ptr;

use crate::common::{self, Model, Refusal, System, call, stopped};
use pc::pc_status::*;
use pc::*;

/// What the observer received of a member.
#[derive(Clone, Debug, PartialEq)]
struct Seen {
    status: pc_status,
    message: Option<String>,
    times: Vec<f64>,
    states: Vec<f64>,
}

struct Watch {
    seen: Vec<Seen>,
    stop_after: usize,
    system: *mut pc_system,
}

extern "C" fn watch(member: *const pc_member, user: *mut c_void) -> c_int {
    // SAFETY: what `run` passes; arrays and text as documented.
    unsafe {
        let (watch, member) = (&mut *user.cast::<Watch>(), &*member);
        assert_eq!((member.number, member.dim), (watch.seen.len(), pc_system_dim(watch.system.as_ref())));
        let message =
            (!member.message.is_null()).then(|| CStr::from_ptr(member.message).to_str().unwrap().into());
        assert_eq!((member.times.is_null(), member.states.is_null()), (member.rows == 0, member.rows == 0));
        let numbers = |data: *const f64, len| match data.is_null() {
            true => Vec::new(),
            false => std::slice::from_raw_parts(data, len).to_vec(),
        };
        let times = numbers(member.times, member.rows);
        let states = numbers(member.states, member.rows * member.dim);
        watch.seen.push(Seen { status: member.status, message, times, states });
        // The system can be used meanwhile, and is not freed.
        pc_system_free(watch.system);
        let mut values = vec![0.0; pc_system_parameter_count(watch.system.as_ref())];
        let (data, length) = (values.as_mut_ptr(), values.len());
        assert_eq!(pc_system_parameters(watch.system, data, length, ptr::null_mut()), PC_OK);
        c_int::from(watch.seen.len() >= watch.stop_after)
    }
}

/// What all members share.
struct Case<'a> {
    system: &'a System,
    options: pc_solver_options,
    members: usize,
    t: f64,
    states: Option<Vec<f64>>,
    parameters: Option<Vec<f64>>,
    times: Vec<f64>,
}

impl Case<'_> {
    fn run(&self, threads: usize, stop_after: usize) -> (Result<(), Refusal>, Vec<Seen>) {
        let mut watching = Watch { seen: vec![], stop_after, system: self.system.0 };
        let user = (&raw mut watching).cast();
        let array = |numbers: &Option<Vec<f64>>| {
            numbers.as_ref().map_or((ptr::null(), 0), |numbers| (numbers.as_ptr(), numbers.len()))
        };
        let (states, states_length) = array(&self.states);
        let (parameters, parameters_length) = array(&self.parameters);
        // SAFETY: a live system, arrays as long as said, and what the observer takes.
        let outcome = call(|error| unsafe {
            pc_ensemble_run(
                self.system.0,
                &raw const self.options,
                self.members,
                self.t,
                states,
                states_length,
                parameters,
                parameters_length,
                self.times.as_ptr(),
                self.times.len(),
                threads,
                Some(watch),
                user,
                error,
            )
        });
        (outcome, watching.seen)
    }

    /// The same member by a single solver.
    fn alone(&self, member: usize) -> Seen {
        let (mut copy, mut solver) = (ptr::null_mut(), ptr::null_mut());
        // SAFETY: live handles and arrays as said; the solver is freed once.
        unsafe {
            call(|error| pc_system_clone(self.system.0, &raw mut copy, error)).unwrap();
            let system = System(copy);
            if let Some(all) = &self.parameters {
                let count = pc_system_parameter_count(system.0.as_ref());
                let values = all[member * count..].as_ptr();
                call(|error| pc_system_set_parameters(system.0, values, count, error)).unwrap();
            }
            let dim = system.dim();
            let start = self.states.as_ref().map(|all| &all[member * dim..(member + 1) * dim]);
            let (y, length) = start.map_or((ptr::null(), 0), |y| (y.as_ptr(), dim));
            let options = &raw const self.options;
            let mut seen = Seen { status: PC_OK, message: None, times: vec![], states: vec![] };
            let begun =
                call(|error| pc_solver_new(system.0, options, self.t, y, length, &raw mut solver, error));
            if let Err(refusal) = begun {
                (seen.status, seen.message) = (refusal.status, Some(refusal.message));
                return seen;
            }
            let (data, count, user) = (self.times.as_ptr(), self.times.len(), (&raw mut seen).cast());
            match call(|error| pc_solver_run(solver, data, count, Some(output), user, error)) {
                Ok(()) => {}
                Err(refusal) => {
                    seen.status = refusal.status;
                    seen.message = Some(refusal.message).filter(|message| !message.is_empty());
                }
            }
            pc_solver_free(solver);
            seen
        }
    }
}

extern "C" fn output(t: f64, y: *const f64, y_length: usize, user: *mut c_void) -> c_int {
    // SAFETY: what `alone` passes; the state is as long as said.
    unsafe {
        let seen = &mut *user.cast::<Seen>();
        seen.times.push(t);
        seen.states.extend(std::slice::from_raw_parts(y, y_length));
    }
    0
}

/// Members near the start of the model, with parameters near its own.
fn spread(system: &System, members: usize) -> (f64, Vec<f64>, Vec<f64>) {
    let (t, y) = system.start();
    // SAFETY: a live system.
    let count = unsafe { pc_system_parameter_count(system.0.as_ref()) };
    let mut values = vec![0.0; count];
    // SAFETY: a live system and room as said.
    call(|error| unsafe { pc_system_parameters(system.0, values.as_mut_ptr(), count, error) }).unwrap();
    let by = |member: usize, part: f64| 1.0 + part * member as f64;
    let states = (0..members).flat_map(|m| y.iter().map(move |y| y * by(m, 0.01))).collect();
    let parameters = (0..members).flat_map(|m| values.iter().map(move |p| p * by(m, -0.005))).collect();
    (t, states, parameters)
}

#[test]
fn members_are_single_runs_to_the_last_bit_for_any_number_of_threads() {
    let by = |method: pc_method| pc_solver_options { method: method as c_int, ..Default::default() };
    for name in ["heavy-top-lagrange", "bouncing-ball"] {
        for options in [by(pc_method::PC_ADAMS), by(pc_method::PC_BDF)] {
            let system = System::of(name);
            let members = 9;
            let (t, states, parameters) = spread(&system, members);
            let times = vec![0.4, 1.0, 2.0];
            let (states, parameters) = (Some(states), Some(parameters));
            let mut case = Case { system: &system, options, members, t, states, parameters, times };
            let expected: Vec<Seen> = (0..members).map(|member| case.alone(member)).collect();
            assert!(expected.iter().all(|seen| seen.status == PC_OK && seen.times.len() == 3));
            assert_ne!(expected[0], expected[1]);
            for threads in [1, 4, 0] {
                assert_eq!(case.run(threads, usize::MAX), (Ok(()), expected.clone()), "{name} {threads}");
            }
            // From the start of the model, with its current parameters.
            (case.states, case.parameters) = (None, None);
            let alone = case.alone(0);
            assert_eq!(case.run(2, usize::MAX), (Ok(()), vec![alone; members]));
        }
    }
}

/// DOP853, also as the method that is chosen, integrates members without events side by side in
/// vectors, within the tolerance of single runs, 1e-9, which the motion magnifies by at most a few
/// hundred. A member that fails does so alone.
#[test]
fn members_side_by_side_are_single_runs_within_the_tolerance() {
    let dop853 = pc_solver_options { method: pc_method::PC_DOP853 as c_int, ..Default::default() };
    let cases = ["heavy-top-lagrange", "bouncing-ball"];
    for (name, options) in cases.iter().flat_map(|name| [(*name, dop853), (*name, Default::default())]) {
        let system = System::of(name);
        let members = 21;
        let (t, mut states, parameters) = spread(&system, members);
        let has_events = name == "bouncing-ball";
        if !has_events {
            states[4 * system.dim()] = f64::NAN;
        }
        let (states, parameters) = (Some(states), Some(parameters));
        let case =
            Case { system: &system, options, members, t, states, parameters, times: vec![t, 0.4, 2.0] };
        let (outcome, seen) = case.run(1, usize::MAX);
        assert_eq!(outcome, Ok(()));
        for threads in [2, 5] {
            // Only the member that cannot begin has NaNs.
            assert_eq!(
                format!("{:?}", case.run(threads, usize::MAX)),
                format!("{:?}", (Ok::<(), ()>(()), &seen))
            );
        }
        for (member, seen) in seen.iter().enumerate() {
            let alone = case.alone(member);
            assert_eq!(
                (seen.status, &seen.message, &seen.times),
                (alone.status, &alone.message, &alone.times)
            );
            if has_events {
                assert_eq!(seen.states, alone.states);
            }
            for (a, b) in seen.states.iter().zip(&alone.states) {
                assert!((a - b).abs() <= 1e-6 * b.abs().max(1.0), "{name} {member}: {a} {b}");
            }
        }
        assert_eq!(seen.iter().filter(|seen| seen.status != PC_OK).count(), usize::from(!has_events));
    }
}

#[test]
fn a_failing_member_is_reported_and_the_others_continue() {
    let system = System::of("heavy-top-lagrange");
    let members = 8;
    let (t, mut states, mut parameters) = spread(&system, members);
    let (dim, count) = (system.dim(), parameters.len() / members);
    states[3 * dim + 1] = f64::NAN;
    parameters[5 * count] = f64::INFINITY;
    let method = pc_method::PC_ADAMS as c_int; // members are then single runs to the last bit
    let options = pc_solver_options { method, max_steps: 200, ..Default::default() };
    states[6 * dim + 5] = 1e6; // too fast for 200 steps
    let (states, parameters) = (Some(states), Some(parameters));
    let case = Case { system: &system, options, members, t, states, parameters, times: vec![1.0] };
    let (outcome, seen) = case.run(4, usize::MAX);
    assert_eq!(outcome, Ok(()));
    for (member, seen) in seen.iter().enumerate() {
        match member {
            3 | 5 => assert_eq!((seen.status, seen.times.len()), (PC_INVALID_ARGUMENT, 0)),
            6 => assert_eq!(seen.status, PC_INTEGRATION),
            _ => assert_eq!(*seen, case.alone(member)),
        }
        assert_eq!(seen.message.is_some(), seen.status != PC_OK);
    }
    assert_eq!(seen[5].message.as_deref(), Some("a parameter is inf, but must be finite"));
    assert_eq!(seen[6], case.alone(6));
    assert_eq!(case.run(1, usize::MAX).1.len(), members);
    // Each member reports an error that all share.
    let case = Case { times: vec![2.0, 1.0], ..case };
    assert!(case.run(2, usize::MAX).1.iter().all(|seen| seen.status == PC_INVALID_ARGUMENT));
    let case = Case { times: vec![], ..case };
    assert!(case.run(2, usize::MAX).1.iter().all(|seen| seen.status == PC_INVALID_ARGUMENT));
}

#[test]
fn the_observer_stops_the_ensemble() {
    let system = System::of("heavy-top-lagrange");
    let (t, states, _) = spread(&system, 200);
    for method in [pc_method::PC_AUTO, pc_method::PC_ADAMS] {
        let options = pc_solver_options { method: method as c_int, ..Default::default() };
        let states = Some(states.clone());
        let case =
            Case { system: &system, options, members: 200, t, states, parameters: None, times: vec![0.1] };
        for threads in [1, 4] {
            let (outcome, seen) = case.run(threads, 5);
            assert_eq!((outcome, seen.len()), (Err(stopped()), 5));
        }
    }
}

#[test]
fn a_terminal_event_ends_a_member() {
    let text = "[coordinates]\ny = 1.0\n[lagrangian]\nkinetic = \"y'^2/2\"\npotential = \"9.81*y\"\n\
                [events.floor]\nwhen = \"y\"\nterminal = true\n";
    let system = Model::text(text).unwrap().system(pc_form::PC_POINCARE).unwrap();
    let heights: [f64; 3] = [0.1, 1.0, 10.0];
    let states = Some(heights.iter().flat_map(|&h| [h, 0.0]).collect());
    let times = vec![0.05, 0.1, 0.3, 0.9];
    let options = common::sharp();
    let case = Case { system: &system, options, members: 3, t: 0.0, states, parameters: None, times };
    let (outcome, seen) = case.run(2, usize::MAX);
    assert_eq!(outcome, Ok(()));
    for (member, (h, seen)) in heights.iter().zip(&seen).enumerate() {
        assert_eq!(*seen, case.alone(member));
        let lands = (2.0 * h / 9.81).sqrt();
        if lands < 0.9 {
            assert_eq!((seen.status, &seen.message), (PC_EVENT, &None));
            // Far above the tolerance of 1e-13 of a flight.
            assert!((seen.times.last().unwrap() - lands).abs() < 1e-10);
        } else {
            assert_eq!((seen.status, seen.times.len()), (PC_OK, 4));
        }
    }
}

#[test]
fn wrong_calls_are_refused() {
    let system = System::of("euler-top");
    let (no_system, none, user): (*const pc_system, *const f64, *mut c_void) =
        (ptr::null(), ptr::null(), ptr::null_mut());
    let numbers = [1.0; 12];
    let (all, times) = (numbers.as_ptr(), [1.0]);
    let (times, options) = (times.as_ptr(), ptr::null());
    refused! { PC_INVALID_ARGUMENT, "is a null pointer";
        pc_ensemble_run(no_system, options, 2, 0.0, none, 0, none, 0, times, 1, 0, Some(watch), user);
        pc_ensemble_run(system.0, options, 2, 0.0, none, 0, none, 0, none, 1, 0, Some(watch), user);
        pc_ensemble_run(system.0, options, 2, 0.0, none, 0, none, 0, times, 1, 0, None, user);
    }
    refused! { PC_INVALID_ARGUMENT, "states: 5 numbers instead of 6";
        pc_ensemble_run(system.0, options, 2, 0.0, all, 5, none, 0, times, 1, 0, Some(watch), user);
    }
    refused! { PC_INVALID_ARGUMENT, "parameters: 7 numbers instead of 6";
        pc_ensemble_run(system.0, options, 2, 0.0, none, 0, all, 7, times, 1, 0, Some(watch), user);
    }
    // So many members that the length of their states overflows.
    let many = usize::MAX / 2;
    let refused = call(|error| unsafe {
        // SAFETY: the lengths are refused before the arrays are looked at.
        pc_ensemble_run(system.0, options, many, 0.0, all, 12, none, 0, times, 1, 0, Some(watch), user, error)
    });
    assert_eq!(refused.unwrap_err().status, PC_INVALID_ARGUMENT);
    let wrong = pc_solver_options { method: 9, ..Default::default() };
    refused! { PC_INVALID_ARGUMENT, "9 is not a value of pc_method";
        pc_ensemble_run(
            system.0, &raw const wrong, 2, 0.0, none, 0, none, 0, times, 1, 0, Some(watch), user,
        );
    }
    let options = pc_solver_options::default();
    let nobody =
        Case { system: &system, options, members: 0, t: 0.0, states: None, parameters: None, times: vec![] };
    assert_eq!(nobody.run(0, 1), (Ok(()), vec![]));
}

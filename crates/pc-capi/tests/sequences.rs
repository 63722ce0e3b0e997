//! Calls in any order, with any text: no crash, every failure with its message, nothing left behind.
//!
//! `PC_SEQUENCES=1000000 cargo test --release -p pc-capi --test sequences` plays more of them than the few hundred of every day.

#![expect(clippy::unwrap_used, unsafe_code, reason = "tests")]

#[path = "common/calls.rs"]
mod calls;
mod common;

use std::alloc::{GlobalAlloc, Layout, System as Host};
use std::cell::Cell;
use std::ffi::{c_int, c_void};
use std::ptr;

use calls::{Call, Own, calls, destroy, observe_event, observe_member, reset, value};
use common::{Refusal, c, call};
use pc::*;
use proptest::prop_assert;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

/// Counts what a thread has allocated and not yet freed.
struct Counting;

thread_local! {
    static LIVE: Cell<isize> = const { Cell::new(0) };
}

fn count(change: isize) {
    // A thread that ends is past counting.
    let _ = LIVE.try_with(|live| live.set(live.get() + change));
}

// SAFETY: hands over to the allocator of the host.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count(1);
        // SAFETY: as promised to us.
        unsafe { Host.alloc(layout) }
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        count(-1);
        // SAFETY: as promised to us.
        unsafe { Host.dealloc(block, layout) };
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

/// The handles there are, each null at first.
struct Handles {
    model: *mut pc_model,
    system: *mut pc_system,
    solver: *mut pc_solver,
    dense: *mut pc_dense,
    checkpoint: Vec<u8>,
}

extern "C" fn observe(_t: f64, _y: *const f64, _y_length: usize, user: *mut c_void) -> c_int {
    c_int::from(!user.is_null())
}

impl Handles {
    fn put_model(&mut self, model: *mut pc_model) {
        if !model.is_null() {
            // SAFETY: ours, and forgotten.
            unsafe { pc_model_free(std::mem::replace(&mut self.model, model)) };
        }
    }

    fn put_system(&mut self, system: *mut pc_system) {
        if !system.is_null() {
            // SAFETY: ours, and forgotten.
            unsafe { pc_system_free(std::mem::replace(&mut self.system, system)) };
        }
    }

    fn make(&mut self, call_: &Call) -> Result<(), Refusal> {
        let Handles { model, system, solver, dense, .. } = *self;
        // SAFETY: all handles are null or live, all arrays as long as said unless the length is what is refused.
        unsafe {
            match call_ {
                Call::NewModel(name) => {
                    let (name, mut made) = (c(name), ptr::null_mut());
                    let outcome = call(|error| pc_model_new(name.as_ptr(), &raw mut made, error));
                    self.put_model(made);
                    outcome
                }
                Call::Parse(text) => {
                    let mut made = ptr::null_mut();
                    let (data, len) = (text.as_ptr().cast(), text.len());
                    let outcome = call(|error| pc_model_parse(data, len, ptr::null(), &raw mut made, error));
                    self.put_model(made);
                    outcome
                }
                Call::Builtin(index) => {
                    // Short ones, and one with events.
                    let name = pc_builtin_name(usize::from(*index) % 12);
                    let used = if index % 3 == 0 { c"bouncing-ball".as_ptr() } else { name };
                    let mut made = ptr::null_mut();
                    let outcome = call(|error| pc_model_builtin(used, &raw mut made, error));
                    pc_string_free(name);
                    self.put_model(made);
                    outcome
                }
                Call::Say(function, a, b, x) => {
                    let (a, b) = (c(a), c(b));
                    let (a, b) = (a.as_ptr(), b.as_ptr());
                    call(|error| match function % 14 {
                        0 => pc_model_add_parameter(model, a, *x, error),
                        1 => pc_model_add_definition(model, a, b, error),
                        2 | 3 => pc_model_add_coordinate(model, a, *x, error),
                        4 => pc_model_add_quasi_velocity(model, a, b, *x, error),
                        5 => pc_model_set_kinematics(model, a, b, error),
                        6 => pc_model_set_algebra(model, a, error),
                        7 => pc_model_add_constraint(model, a, b, error),
                        8 | 9 => pc_model_set_kinetic(model, b, error),
                        10 => pc_model_set_potential(model, b, error),
                        11 => pc_model_add_force(model, a, b, error),
                        12 => pc_model_keep(model, a, error),
                        _ => pc_model_set(model, a, *x, error),
                    })
                }
                Call::FreeModel => {
                    pc_model_free(std::mem::replace(&mut self.model, ptr::null_mut()));
                    Ok(())
                }
                Call::NewSystem(form) => {
                    let options = pc_system_options { form: c_int::from(*form), ..Default::default() };
                    let mut made = ptr::null_mut();
                    let outcome =
                        call(|error| pc_system_new(model, &raw const options, &raw mut made, error));
                    self.put_system(made);
                    outcome
                }
                Call::CloneSystem => {
                    let mut made = ptr::null_mut();
                    let outcome = call(|error| pc_system_clone(system, &raw mut made, error));
                    self.put_system(made);
                    outcome
                }
                Call::FreeSystem => {
                    pc_system_free(std::mem::replace(&mut self.system, ptr::null_mut()));
                    Ok(())
                }
                Call::Event(function, text, direction) => {
                    let (text, when, direction) = (c(text), c"x'*cos(3*t) - 1/10", c_int::from(*direction));
                    let (name, text, terminal) =
                        (c"hit".as_ptr(), text.as_ptr(), c_int::from(function % 8 == 1));
                    call(|error| match function % 4 {
                        0 => pc_model_add_event(model, text, text, direction, terminal, error),
                        1 => pc_model_add_event(model, name, when.as_ptr(), direction, terminal, error),
                        2 => pc_model_add_event_reset(model, name, c"x'".as_ptr(), c"-x'/2".as_ptr(), error),
                        _ => pc_model_add_event_reset(model, name, text, text, error),
                    })
                }
                Call::Text(function, text) => {
                    let text = [text.as_slice(), &[0]].concat();
                    let (text, name) = (text.as_ptr().cast(), c"x".as_ptr());
                    call(|error| match function % 6 {
                        0 => pc_model_add_definition(model, text, name, error),
                        1 => pc_model_set_potential(model, text, error),
                        2 => pc_model_add_event(model, name, text, 0, 0, error),
                        3 => pc_model_set_kinetic(model, text, error),
                        4 => pc_model_set(model, text, 1.0, error),
                        _ => pc_model_keep(model, text, error),
                    })
                }
                Call::Evaluate(function, length, y) => {
                    let functions: [common::At; 9] = [
                        pc_system_events,
                        pc_system_rhs,
                        pc_system_jacobian,
                        pc_system_observe,
                        pc_system_reactions,
                        pc_system_mass_matrix,
                        pc_system_structure_coefficients,
                        pc_system_to_momenta,
                        pc_system_to_quasi_velocities,
                    ];
                    let function = functions[usize::from(function % 9)];
                    let dim = pc_system_dim(system);
                    let mut y = y.clone();
                    if length % 4 > 0 {
                        y.resize(dim, 0.5);
                    }
                    let mut values =
                        vec![0.0; [dim, dim, dim * dim, usize::from(*length)][usize::from(length % 4)]];
                    let (out, len) = (values.as_mut_ptr(), values.len());
                    call(|error| function(system, 0.5, y.as_ptr(), y.len(), out, len, error))
                }
                Call::Parameter(index, value) => {
                    call(|error| pc_system_set_parameter(system, usize::from(index % 8), *value, error))
                }
                Call::Print(format) => {
                    let mut text = ptr::null_mut();
                    let outcome =
                        call(|error| pc_system_print(system, c_int::from(*format), &raw mut text, error));
                    pc_string_free(text);
                    outcome
                }
                Call::Kernel => {
                    let mut kernel = ptr::null_mut();
                    let outcome = call(|error| pc_kernel_new(system, &raw mut kernel, error));
                    let dim = pc_kernel_dim(kernel);
                    let (y, mut ydot) = (vec![0.3; dim], vec![0.0; dim]);
                    let code = pc_kernel_rhs(0.0, y.as_ptr(), ydot.as_mut_ptr(), kernel.cast());
                    assert!(code == -1 || outcome.is_ok());
                    pc_kernel_free(kernel);
                    outcome
                }
                Call::NewSolver(method, t, y) => {
                    let method = c_int::from(*method);
                    let options = pc_solver_options { method, max_steps: 200, ..Default::default() };
                    let mut made = ptr::null_mut();
                    let data = if y.is_empty() { ptr::null() } else { y.as_ptr() };
                    let outcome = call(|error| {
                        pc_solver_new(system, &raw const options, *t, data, y.len(), &raw mut made, error)
                    });
                    if !made.is_null() {
                        pc_solver_free(std::mem::replace(&mut self.solver, made));
                    }
                    outcome
                }
                Call::Advance(t, length) => {
                    let mut y = vec![0.0; usize::from(*length)];
                    call(|error| pc_solver_advance(solver, *t, y.as_mut_ptr(), y.len(), error))
                }
                Call::Run(times, stop) => {
                    let user = if *stop { (&raw mut *self).cast() } else { ptr::null_mut() };
                    let (data, len) = (times.as_ptr(), times.len());
                    call(|error| pc_solver_run(solver, data, len, Some(observe), user, error))
                }
                Call::Step(towards, length) => {
                    let (mut t, mut y) = (0.0, vec![0.0; usize::from(*length)]);
                    let (out, len) = (y.as_mut_ptr(), y.len());
                    call(|error| pc_solver_step(solver, *towards, &raw mut t, out, len, error))
                }
                Call::AddEvent(direction, function, good) => {
                    let (writes, good) = (function % 4 > 1, usize::from(*good) * 2);
                    let own = Own { calls: 0, good, writes, reset: c_int::from(function % 16 == 15) };
                    let user = Box::into_raw(Box::new(own)).cast();
                    let resets: pc_event_reset = if function % 2 == 0 { Some(reset) } else { None };
                    let name = if function % 32 == 31 { ptr::null() } else { c"\u{301}".as_ptr() };
                    let terminal = c_int::from(function % 8 == 7);
                    let direction = c_int::from(*direction);
                    call(|error| {
                        let (value, destroy): (pc_event_function, _) = (Some(value), Some(destroy as _));
                        pc_solver_add_event(
                            solver, name, direction, terminal, value, resets, user, destroy, error,
                        )
                    })
                }
                Call::Observe(which) => {
                    let user = if which % 2 == 0 { ptr::dangling_mut() } else { ptr::null_mut() };
                    let observer: pc_event_observer = if which % 3 == 0 { None } else { Some(observe_event) };
                    call(|error| pc_solver_observe_events(solver, observer, user, error))
                }
                Call::Occurrences(event, before, after) => {
                    let (mut t, mut number, event) = (0.0, 0, usize::from(*event));
                    let [mut y, mut z] = [before, after].map(|length| vec![0.0; usize::from(*length)]);
                    let (y, n, z, m) = (y.as_mut_ptr(), y.len(), z.as_mut_ptr(), z.len());
                    let _ = call(|error| pc_solver_terminal_event(solver, &raw mut number, error));
                    assert_eq!(
                        pc_solver_event_name(solver, event).is_null(),
                        event >= pc_solver_event_count(solver)
                    );
                    call(|error| pc_solver_last_occurrence(solver, event, &raw mut t, y, n, z, m, error))
                }
                Call::Interpolate(t, length, order) => {
                    let mut y = vec![0.0; usize::from(*length)];
                    let order = if *order > 250 { u32::MAX } else { u32::from(order % 4) };
                    call(|error| pc_solver_interpolate(solver, *t, order, y.as_mut_ptr(), y.len(), error))
                }
                Call::RunDense(t) => {
                    let mut made = ptr::null_mut();
                    let outcome = call(|error| pc_solver_run_dense(solver, *t, &raw mut made, error));
                    if !made.is_null() {
                        pc_dense_free(std::mem::replace(&mut self.dense, made));
                    }
                    outcome
                }
                Call::Eval(t, length) => {
                    let mut y = vec![0.0; usize::from(*length)];
                    call(|error| pc_dense_eval(dense, *t, y.as_mut_ptr(), y.len(), error))
                }
                Call::Checkpoint(label) => {
                    let (label, mut data, mut length) = (c(label), ptr::null_mut(), 0);
                    let (label, data_place, length_place) = (label.as_ptr(), &raw mut data, &raw mut length);
                    call(|error| pc_solver_checkpoint(solver, label, data_place, length_place, error))?;
                    self.checkpoint = std::slice::from_raw_parts(data.cast::<u8>(), length).to_vec();
                    pc_bytes_free(data);
                    Ok(())
                }
                Call::Restore(change, method) => {
                    let mut bytes = self.checkpoint.clone();
                    let place = usize::from(*change) * 7 % bytes.len().max(1);
                    match change % 4 {
                        0 => bytes.truncate(place),
                        1 if !bytes.is_empty() => bytes[place] ^= 1 << (change % 8),
                        _ => {}
                    }
                    let (data, len) = (bytes.as_ptr().cast(), bytes.len());
                    let options =
                        pc_solver_options { method: (*method).into(), max_steps: 200, ..Default::default() };
                    let mut made = ptr::null_mut();
                    let outcome = call(|error| {
                        pc_solver_restore(system, &raw const options, data, len, &raw mut made, error)
                    });
                    assert!(outcome.is_err() || change % 4 > 0);
                    if !made.is_null() {
                        pc_solver_free(std::mem::replace(&mut self.solver, made));
                    }
                    outcome
                }
                Call::Ensemble(function, threads, numbers, members) => {
                    let (members, dim) = (usize::from(*members), pc_system_dim(system));
                    let states: Vec<f64> = numbers.iter().copied().cycle().take(members * dim).collect();
                    let states = if numbers.is_empty() { &numbers[..] } else { &states };
                    let data = if function % 4 == 0 { ptr::null() } else { states.as_ptr() };
                    let length = states.len() + usize::from(function % 8 == 1);
                    let times = [0.25, numbers.first().copied().unwrap_or(1.0)];
                    let user = if function % 2 == 0 { ptr::dangling_mut() } else { ptr::null_mut() };
                    let options = pc_solver_options { max_steps: 100, ..Default::default() };
                    let observer: pc_member_observer = Some(observe_member);
                    call(|error| {
                        let (none, times, threads) =
                            (ptr::null(), times.as_ptr(), usize::from(threads % 3) + 1);
                        let options = &raw const options;
                        pc_ensemble_run(
                            system, options, members, 0.0, data, length, none, 0, times, 2, threads,
                            observer, user, error,
                        )
                    })
                }
                Call::FreeSolver => {
                    pc_solver_free(std::mem::replace(&mut self.solver, ptr::null_mut()));
                    Ok(())
                }
            }
        }
    }
}

/// Makes the calls and frees what is left; how many succeeded.
fn play(calls: &[Call]) -> usize {
    let (model, system, solver) = (ptr::null_mut(), ptr::null_mut(), ptr::null_mut());
    let mut handles = Handles { model, system, solver, dense: ptr::null_mut(), checkpoint: Vec::new() };
    let mut succeeded = 0;
    for call in calls {
        match handles.make(call) {
            Ok(()) => succeeded += 1,
            Err(refusal) => assert_ne!(refusal.status, pc_status::PC_INTERNAL, "{}", refusal.message),
        }
    }
    // SAFETY: null or live, and forgotten.
    unsafe {
        pc_model_free(handles.model);
        pc_system_free(handles.system);
        pc_solver_free(handles.solver);
        pc_dense_free(handles.dense);
    }
    succeeded
}

#[test]
fn any_sequence_of_calls_is_survived_and_leaves_nothing_behind() {
    let cases = std::env::var("PC_SEQUENCES").map_or(300, |number| number.parse().unwrap());
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[7; 32]);
    let mut runner =
        TestRunner::new_with_rng(Config { cases, failure_persistence: None, ..Config::default() }, rng);
    let succeeded = Cell::new(0);
    let outcome = runner.run(&calls(), |calls| {
        play(&calls); // what is made once, such as the table of the host's functions, is made now
        let before = LIVE.get();
        let count = play(&calls);
        let left = LIVE.get() - before;
        // What the threads of an ensemble allocate and free is not counted here.
        let threads = calls.iter().any(|call| matches!(call, Call::Ensemble(..)));
        prop_assert!(threads || left == 0, "{} allocations left behind", left);
        succeeded.set(succeeded.get() + count);
        Ok(())
    });
    outcome.unwrap();
    assert!(3 * succeeded.get() > 10 * cases as usize, "only {} calls did something", succeeded.get());
}

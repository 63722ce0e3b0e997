//! Calls in any order, with any text: no crash, every failure with its message, nothing left behind.

#![expect(clippy::unwrap_used, unsafe_code, reason = "tests")]

mod common;

use std::alloc::{GlobalAlloc, Layout, System as Host};
use std::cell::Cell;
use std::ffi::{c_int, c_void};
use std::ptr;
use std::sync::atomic::{AtomicIsize, Ordering};

use common::{Refusal, c, call};
use pc::*;
use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

/// Counts what is allocated and not yet freed.
struct Counting;

static LIVE: AtomicIsize = AtomicIsize::new(0);

// SAFETY: hands over to the allocator of the host.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        LIVE.fetch_add(1, Ordering::Relaxed);
        // SAFETY: as promised to us.
        unsafe { Host.alloc(layout) }
    }

    unsafe fn dealloc(&self, block: *mut u8, layout: Layout) {
        LIVE.fetch_sub(1, Ordering::Relaxed);
        // SAFETY: as promised to us.
        unsafe { Host.dealloc(block, layout) };
    }
}

#[global_allocator]
static COUNTING: Counting = Counting;

/// A call; numbers choose among what there is.
#[derive(Clone, Debug)]
enum Call {
    NewModel(String),
    Parse(Vec<u8>),
    Builtin(u8),
    Say(u8, String, String, f64),
    FreeModel,
    NewSystem(i8),
    CloneSystem,
    FreeSystem,
    Evaluate(u8, u8, Vec<f64>),
    Parameter(u8, f64),
    Print(i8),
    Kernel,
    NewSolver(i8, f64, Vec<f64>),
    Advance(f64, u8),
    Run(Vec<f64>, bool),
    FreeSolver,
}

fn texts() -> impl Strategy<Value = String> {
    prop_oneof![
        3 => "[a-cxyω]'?",
        3 => "[a-cx0-9ω'(*+/^) -]{0,12}",
        1 => "[^\u{0}]{0,20}",
        1 => Just("x^2/2".to_owned()),
        1 => Just("x'^2/2".to_owned()),
        1 => Just("so3".to_owned()),
    ]
}

fn numbers() -> impl Strategy<Value = f64> {
    prop_oneof![4 => -3.0..3.0, 1 => any::<f64>(), 1 => Just(0.0)]
}

fn calls() -> impl Strategy<Value = Vec<Call>> {
    let state = || prop::collection::vec(numbers(), 0..8);
    let one = prop_oneof![
        2 => texts().prop_map(Call::NewModel),
        1 => prop::collection::vec(any::<u8>(), 0..60).prop_map(Call::Parse),
        3 => any::<u8>().prop_map(Call::Builtin),
        9 => (any::<u8>(), texts(), texts(), numbers()).prop_map(|(f, a, b, x)| Call::Say(f, a, b, x)),
        1 => Just(Call::FreeModel),
        3 => (-1i8..3).prop_map(Call::NewSystem),
        1 => Just(Call::CloneSystem),
        1 => Just(Call::FreeSystem),
        6 => (any::<u8>(), any::<u8>(), state()).prop_map(|(f, n, y)| Call::Evaluate(f, n, y)),
        2 => (any::<u8>(), numbers()).prop_map(|(i, x)| Call::Parameter(i, x)),
        1 => (-1i8..3).prop_map(Call::Print),
        1 => Just(Call::Kernel),
        2 => (-1i8..3, numbers(), state()).prop_map(|(m, t, y)| Call::NewSolver(m, t, y)),
        3 => (numbers(), 0u8..8).prop_map(|(t, n)| Call::Advance(t, n)),
        2 => (prop::collection::vec(numbers(), 0..4), any::<bool>()).prop_map(|(t, s)| Call::Run(t, s)),
        1 => Just(Call::FreeSolver),
    ];
    prop::collection::vec(one, 1..30)
}

/// The handles there are, each null at first.
struct Handles {
    model: *mut pc_model,
    system: *mut pc_system,
    solver: *mut pc_solver,
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
        let Handles { model, system, solver } = *self;
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
                    let name = pc_builtin_name(usize::from(*index) % 12);
                    let mut made = ptr::null_mut();
                    let outcome = call(|error| pc_model_builtin(name, &raw mut made, error));
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
                Call::Evaluate(function, length, y) => {
                    let functions: [common::At; 8] = [
                        pc_system_rhs,
                        pc_system_jacobian,
                        pc_system_observe,
                        pc_system_reactions,
                        pc_system_mass_matrix,
                        pc_system_structure_coefficients,
                        pc_system_to_momenta,
                        pc_system_to_quasi_velocities,
                    ];
                    let function = functions[usize::from(function % 8)];
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
    let mut handles = Handles { model: ptr::null_mut(), system: ptr::null_mut(), solver: ptr::null_mut() };
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
    }
    succeeded
}

#[test]
fn any_sequence_of_calls_is_survived_and_leaves_nothing_behind() {
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &[7; 32]);
    let mut runner =
        TestRunner::new_with_rng(Config { cases: 300, failure_persistence: None, ..Config::default() }, rng);
    let succeeded = Cell::new(0);
    let outcome = runner.run(&calls(), |calls| {
        play(&calls); // what is made once, such as the table of the host's functions, is made now
        let before = LIVE.load(Ordering::Relaxed);
        let count = play(&calls);
        let left = LIVE.load(Ordering::Relaxed) - before;
        prop_assert_eq!(left, 0, "allocations left behind");
        succeeded.set(succeeded.get() + count);
        Ok(())
    });
    outcome.unwrap();
    assert!(succeeded.get() > 1000, "only {} calls did something", succeeded.get());
}

//! Handles on many threads.

use std::ffi::{c_int, c_void};
use std::mem::ManuallyDrop;
use std::ptr;
use std::sync::mpsc::{self, Receiver, Sender};
use std::thread;
use std::time::Duration;

use crate::common::{Model, System, call};
use pc::*;

/// A handle that goes to another thread, as the preamble allows.
struct Sent<T>(*mut T);

// SAFETY: the handles may be used by any thread.
unsafe impl<T> Send for Sent<T> {}
// SAFETY: a second call at the same time is refused.
unsafe impl<T> Sync for Sent<T> {}

#[test]
fn clones_and_kernels_compute_the_same_on_all_threads() {
    let system = System::of("heavy-top-lagrange");
    let ((t, y), dim) = (system.start(), system.dim());
    let expected = system.at(pc_system_rhs, t, &y, dim).unwrap();
    let copies: Vec<(Sent<pc_system>, Sent<pc_kernel>)> = (0..4)
        .map(|_| {
            let (mut copy, mut kernel) = (ptr::null_mut(), ptr::null_mut());
            // SAFETY: a live system and places for handles.
            unsafe {
                call(|error| pc_system_clone(system.0, &raw mut copy, error)).unwrap();
                call(|error| pc_kernel_new(copy, &raw mut kernel, error)).unwrap();
            }
            (Sent(copy), Sent(kernel))
        })
        .collect();
    drop(system);
    thread::scope(|scope| {
        for copy in copies {
            let (y, expected) = (&y, &expected);
            scope.spawn(move || {
                let (Sent(copy), Sent(kernel)) = { copy };
                let copy = System(copy);
                let mut ydot = vec![0.0; dim];
                for _ in 0..1000 {
                    assert_eq!(copy.at(pc_system_rhs, t, y, dim).unwrap(), *expected);
                    // SAFETY: a kernel of this thread's, and arrays of its dimension.
                    let code = unsafe { pc_kernel_rhs(t, y.as_ptr(), ydot.as_mut_ptr(), kernel.cast()) };
                    assert_eq!((code, &ydot), (0, expected));
                }
                // SAFETY: ours, freed once.
                unsafe { pc_kernel_free(kernel) };
            });
        }
    });
}

/// A rotor in metres, kilograms and seconds: pivots of M vary with the state, and differ greatly in
/// size.
const MOLECULE: &str = r#"
[parameters]
m = 5e-26
J = 2e-46
[coordinates]
x = 0
theta = 0.4
phi = 0
[quasi_velocities]
"x'" = 500
"theta'" = 1e12
"phi'" = 1e12
[lagrangian]
kinetic = "(m*x'^2 + J*(theta'^2 + sin(theta)^2*phi'^2))/2"
"#;

/// Systems whose f is machine code alone: with constant M, with pivots that are checked, and with
/// long equations.
fn of_machine_code() -> Vec<System> {
    let molecule = Model::text(MOLECULE).unwrap().system(pc_form::PC_POINCARE).unwrap();
    let named = ["heavy-top-lagrange", "snakeboard", "pendulum-chain"].map(System::of);
    named.into_iter().chain([molecule, with_many_parameters()]).collect()
}

#[test]
fn many_threads_evaluate_one_system_at_the_same_time() {
    for system in of_machine_code() {
        let ((t, y), dim) = (system.start(), system.dim());
        let y: Vec<f64> = y.iter().enumerate().map(|(i, y)| y + 0.01 * (i + 1) as f64).collect();
        let expected = system.at(pc_system_rhs, t, &y, dim).unwrap();
        let mut copy = ptr::null_mut();
        // SAFETY: a live system and a place for the handle.
        call(|error| unsafe { pc_system_clone(system.0, &raw mut copy, error) }).unwrap();
        for system in [system, System(copy)] {
            let handle = Sent(system.0);
            thread::scope(|scope| {
                for _ in 0..3 {
                    scope.spawn(|| {
                        let system = ManuallyDrop::new(System({ &handle }.0));
                        for _ in 0..5_000 {
                            assert_eq!(system.at(pc_system_rhs, t, &y, dim).unwrap(), expected);
                        }
                    });
                }
            });
        }
    }
}

/// A point in a potential p_0 (sin x + …) + p_1 (sin 31 x + …) + …: evaluation takes so long that
/// parameters can be set before all of them are read.
fn with_many_parameters() -> System {
    let parameters = (0..60).map(|k| format!("p_{k} = 1"));
    let terms = (0..60).map(|k| {
        let waves: Vec<String> = (1..=30).map(|j| format!("sin({}*x)", 30 * k + j)).collect();
        format!("p_{k}*({})", waves.join(" + "))
    });
    let text = format!(
        "[parameters]\n{}\n[coordinates]\nx = 0.5\n[quasi_velocities]\n\"x'\" = 1\n[lagrangian]\n\
         kinetic = \"x'^2/2\"\npotential = \"{}\"\n",
        parameters.collect::<Vec<_>>().join("\n"),
        terms.collect::<Vec<_>>().join(" + "),
    );
    Model::text(&text).unwrap().system(pc_form::PC_POINCARE).unwrap()
}

#[test]
fn rates_are_of_the_parameters_before_or_after_a_change() {
    let system = with_many_parameters();
    let (t, y) = system.start();
    let sets = [vec![1.0; 60], vec![-1.0; 60]];
    let rates = [&sets[0], &sets[1]].map(|parameters| {
        system.set_parameters(parameters).unwrap();
        system.at(pc_system_rhs, t, &y, 2).unwrap()
    });
    assert_eq!(rates[0][1], -rates[1][1]);
    let handle = Sent(system.0);
    thread::scope(|scope| {
        let evaluations = scope.spawn(|| {
            let system = ManuallyDrop::new(System({ &handle }.0));
            for _ in 0..10_000 {
                match system.at(pc_system_rhs, t, &y, 2) {
                    Ok(ydot) => assert!(rates.contains(&ydot), "{ydot:?} is of neither"),
                    Err(refused) => assert_eq!(refused.status, pc_status::PC_BUSY),
                }
            }
        });
        for parameters in sets.iter().cycle().take_while(|_| !evaluations.is_finished()) {
            let set = system.set_parameters(parameters);
            assert!(set.is_ok() || set.is_err_and(|refused| refused.status == pc_status::PC_BUSY));
        }
    });
}

#[test]
fn parameters_that_make_m_singular_are_detected_after_a_change() {
    let text = "[parameters]\nm = 2\nr = 0\n[coordinates]\nx = 0.5\nz = 0\n[quasi_velocities]\n\"x'\" = 1\n\
                [lagrangian]\nkinetic = \"(m*x'^2 + (1 + r*x^2)*z'^2)/2\"\npotential = \"3*x\"\n";
    let system = Model::text(text).unwrap().system(pc_form::PC_POINCARE).unwrap();
    let (t, y) = system.start();
    let rates = |parameters: &[f64]| {
        system.set_parameters(parameters).unwrap();
        system.at(pc_system_rhs, t, &y, 4)
    };
    for _ in 0..2 {
        assert_eq!(rates(&[2.0, 0.0]).unwrap(), [1.0, 0.0, -1.5, 0.0]);
        assert_eq!(rates(&[2.0, -1.0]).unwrap(), [1.0, 0.0, -1.5, 0.0]);
        for singular in [[0.0, 0.0], [2.0, -4.0]] {
            let refused = rates(&singular).unwrap_err();
            assert_eq!(refused.status, pc_status::PC_EVALUATION, "{}", refused.message);
            assert!(refused.message.contains("pivot"), "{}", refused.message);
        }
    }
}

/// More than a thread that does not hang waits for another one.
const PATIENCE: Duration = Duration::from_secs(60);

/// What an observer tells the other thread, and what it hears from it.
struct Line {
    observes: Sender<()>,
    refused: Receiver<()>,
}

extern "C" fn wait(_t: f64, _y: *const f64, _length: usize, user: *mut c_void) -> c_int {
    // SAFETY: the line that `a_handle_in_use_is_busy_for_others` passes, which this thread alone has.
    let line = unsafe { &*user.cast::<Line>() };
    let met = line.observes.send(()).is_ok() && line.refused.recv_timeout(PATIENCE).is_ok();
    c_int::from(!met)
}

#[test]
fn a_handle_in_use_is_busy_for_others() {
    let system = System::of("euler-top");
    let mut solver = ptr::null_mut();
    // SAFETY: a live system and a place for the handle.
    let new =
        |error| unsafe { pc_solver_new(system.0, ptr::null(), 0.0, ptr::null(), 0, &raw mut solver, error) };
    call(new).unwrap();
    let solver = Sent(solver);
    thread::scope(|scope| {
        let solver = &solver;
        let (observes, observed) = mpsc::channel();
        let (refuse, refused) = mpsc::channel();
        let line = Line { observes, refused };
        scope.spawn(move || {
            let user = ptr::from_ref(&line).cast_mut().cast();
            // SAFETY: a live solver, one time, and what the observer expects.
            let run = |error| unsafe { pc_solver_run(solver.0, [1.0].as_ptr(), 1, Some(wait), user, error) };
            call(run).unwrap();
        });
        observed.recv_timeout(PATIENCE).expect("the observer is called");
        let mut y = [0.0; 3];
        // SAFETY: a live solver and room as said.
        let refused =
            call(|error| unsafe { pc_solver_advance(solver.0, 2.0, y.as_mut_ptr(), 3, error) }).unwrap_err();
        assert_eq!(refused.status, pc_status::PC_BUSY);
        refuse.send(()).expect("the observer waits");
    });
    let mut y = [0.0; 3];
    // SAFETY: a live solver and room as said; it is freed once.
    unsafe {
        call(|error| pc_solver_advance(solver.0, 2.0, y.as_mut_ptr(), 3, error)).unwrap();
        pc_solver_free(solver.0);
    }
}

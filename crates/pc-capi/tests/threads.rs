//! Handles on many threads.

#![expect(clippy::unwrap_used, unsafe_code, reason = "tests")]

mod common;

use std::ffi::{c_int, c_void};
use std::ptr;
use std::sync::Barrier;
use std::thread;

use common::{System, call};
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

extern "C" fn wait(_t: f64, _y: *const f64, _length: usize, user: *mut c_void) -> c_int {
    // SAFETY: the barrier that `a_handle_in_use_is_busy_for_others` passes.
    let barrier = unsafe { &*user.cast::<Barrier>() };
    barrier.wait(); // the other thread calls now
    barrier.wait(); // … and has been refused
    0
}

#[test]
fn a_handle_in_use_is_busy_for_others() {
    let system = System::of("euler-top");
    let (mut solver, barrier) = (ptr::null_mut(), Barrier::new(2));
    // SAFETY: a live system and a place for the handle.
    let new =
        |error| unsafe { pc_solver_new(system.0, ptr::null(), 0.0, ptr::null(), 0, &raw mut solver, error) };
    call(new).unwrap();
    let solver = Sent(solver);
    thread::scope(|scope| {
        let (solver, barrier) = (&solver, &barrier);
        scope.spawn(move || {
            let user = ptr::from_ref(barrier).cast_mut().cast();
            // SAFETY: a live solver, one time, and what the observer expects.
            let run = |error| unsafe { pc_solver_run(solver.0, [1.0].as_ptr(), 1, Some(wait), user, error) };
            call(run).unwrap();
        });
        barrier.wait();
        let mut y = [0.0; 3];
        // SAFETY: a live solver and room as said.
        let refused =
            call(|error| unsafe { pc_solver_advance(solver.0, 2.0, y.as_mut_ptr(), 3, error) }).unwrap_err();
        assert_eq!(refused.status, pc_status::PC_BUSY);
        barrier.wait();
    });
    let mut y = [0.0; 3];
    // SAFETY: a live solver and room as said; it is freed once.
    unsafe {
        call(|error| pc_solver_advance(solver.0, 2.0, y.as_mut_ptr(), 3, error)).unwrap();
        pc_solver_free(solver.0);
    }
}

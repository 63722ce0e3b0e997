//! Functions that compute forces: where they fail, how long their data live, what they may call, and on which threads.

use std::ffi::{c_int, c_void};
use std::ptr;
use std::sync::atomic::{AtomicUsize, Ordering::SeqCst};

use crate::common::{System, call};
use crate::laws::{
    Law, Write, advance, assert_close, constant, destroy, force, forced, reached, solver, written,
};
use pc::pc_form::PC_POINCARE;
use pc::pc_status::*;
use pc::*;

/// Returns 1 at the first call after t = 1, so that the step is tried again.
#[test]
fn a_recoverable_failure_of_a_force_shortens_the_step() {
    static FAILED: AtomicUsize = AtomicUsize::new(0);
    let system = forced("pendulum", &["θ"], PC_POINCARE);
    let law = Law::new(|t, _, q, _| {
        q[0] = t;
        c_int::from(t > 1.0 && FAILED.fetch_add(1, SeqCst) == 0)
    });
    law.set(&system).unwrap();
    let (solver_, expected) =
        (solver(&system, pc_method::PC_ADAMS).unwrap(), written("pendulum", &[("θ", "t")], PC_POINCARE));
    let found = advance(solver_, 2.0, 2).unwrap();
    assert!(FAILED.load(SeqCst) > 1);
    let whole = solver(&expected, pc_method::PC_ADAMS).unwrap();
    assert_close(&found, &advance(whole, 2.0, 2).unwrap(), 1e-8, "the step tried again");
    // SAFETY: ours, freed once.
    unsafe {
        pc_solver_free(solver_);
        pc_solver_free(whole);
    }
}

#[test]
fn a_force_that_gives_up_leaves_the_state_reached() {
    /// Returns `code` after t = 1, and no force before.
    fn after_one(t: f64, q: &mut [f64], code: c_int) -> c_int {
        q[0] = 0.0;
        if t > 1.0 { code } else { 0 }
    }
    let laws: [(Write, &str); 3] = [
        (|t, _, q, _| after_one(t, q, -2), "its function returned -2"),
        (|t, _, q, _| after_one(t, q, 3), "its function returned 3"),
        (
            |t, _, q, _| {
                q[0] = if t > 1.0 { f64::NAN } else { 0.0 };
                0
            },
            "the external force on `θ'` is NaN",
        ),
    ];
    for (write, said) in laws {
        let system = forced("pendulum", &["θ"], PC_POINCARE);
        let law = Law::new(write);
        law.set(&system).unwrap();
        let solver = solver(&system, pc_method::PC_ADAMS).unwrap();
        let refusal = advance(solver, 3.0, 2).unwrap_err();
        assert_eq!(refusal.status, PC_INTEGRATION, "{said}");
        assert!(refusal.message.contains(said), "{}", refusal.message);
        // A fatal code ends it within a step; a recoverable one only once steps are as short as
        // possible.
        let t = reached(solver);
        assert!(t <= 1.0 && t > 0.8, "{said}: {t}");
        // SAFETY: ours, freed once.
        unsafe { pc_solver_free(solver) };
    }
    // A force that is not written is NaN.
    let (system, law) = (forced("pendulum", &["θ"], PC_POINCARE), Law::new(|_, _, _, _| 0));
    law.set(&system).unwrap();
    let refusal = system.at(pc_system_rhs, 0.0, &[0.1, 0.2], 2).unwrap_err();
    let said = "the external force on `θ'` is NaN at t = 0, θ = 0.1, θ' = 0.2";
    assert_eq!((refusal.status, refusal.message.as_str()), (PC_EVALUATION, said));
    let mut kernel = ptr::null_mut();
    let (y, mut ydot) = ([0.1, 0.2], [0.0; 2]);
    // SAFETY: a live system, a place for the kernel, arrays of its dimension; freed once.
    unsafe {
        call(|error| pc_kernel_new(system.0, &raw mut kernel, error)).unwrap();
        assert_eq!(pc_kernel_rhs(0.0, y.as_ptr(), ydot.as_mut_ptr(), kernel.cast()), 1);
        pc_kernel_free(kernel);
    }
}

#[test]
fn user_data_of_a_force_is_freed_once() {
    let system = forced("pendulum", &["θ"], PC_POINCARE);
    let (first, second) = (Law::new(constant), Law::new(constant));
    first.set(&system).unwrap();
    let (mut copy, mut kernel) = (ptr::null_mut(), ptr::null_mut());
    // SAFETY: a live system and places for handles.
    call(|error| unsafe { pc_system_clone(system.0, &raw mut copy, error) }).unwrap();
    // SAFETY: a live system and a place for the handle.
    call(|error| unsafe { pc_kernel_new(system.0, &raw mut kernel, error) }).unwrap();
    let solver = solver(&system, pc_method::PC_ADAMS).unwrap();
    second.set(&system).unwrap();
    assert_eq!((first.destroyed(), second.destroyed()), (0, 0));
    drop(system);
    assert_eq!((first.destroyed(), second.destroyed()), (0, 1));
    let (y, mut ydot) = ([0.0, 0.0], [0.0; 2]);
    // SAFETY: live handles, freed once each.
    unsafe {
        pc_system_free(copy);
        advance(solver, 0.1, 2).unwrap();
        pc_solver_free(solver);
        assert_eq!(first.destroyed(), 0);
        assert_eq!(pc_kernel_rhs(0.0, y.as_ptr(), ydot.as_mut_ptr(), kernel.cast()), 0);
        assert_eq!(ydot, [0.0, 0.5]);
        pc_kernel_free(kernel);
    }
    assert_eq!((first.destroyed(), second.destroyed()), (1, 1));
}

#[test]
fn user_data_of_a_refused_force_is_freed_too() {
    let (unforced, system) = (System::of("euler-top"), forced("pendulum", &["θ"], PC_POINCARE));
    let law = Law::new(constant);
    let refusal = law.set(&unforced).unwrap_err();
    let said = "an external force is not available for this system: the model declares none; \
                pc_model_add_external_force does";
    assert_eq!((refusal.status, refusal.message.as_str(), law.destroyed()), (PC_UNSUPPORTED, said, 1));
    // SAFETY: null, or a live system; functions that take the law.
    let refused = |system: *mut pc_system, function: pc_force_function| unsafe {
        call(|error| pc_system_set_force(system, function, None, law.user(), Some(destroy), error))
            .unwrap_err()
    };
    assert_eq!(refused(ptr::null_mut(), Some(force)).message, "system is a null pointer");
    assert_eq!(refused(system.0, None).message, "function is a null pointer");
    assert_eq!(law.destroyed(), 3);
    // Without `destroy` nothing is freed, and `user` may be null.
    unsafe extern "C" fn zero(
        _: f64,
        _: *const f64,
        _: usize,
        q: *mut f64,
        _: usize,
        _: *mut c_void,
    ) -> c_int {
        // SAFETY: room for one number.
        unsafe { q.write(0.0) };
        0
    }
    // SAFETY: a live system and a function that does not look at its user.
    call(|error| unsafe { pc_system_set_force(system.0, Some(zero), None, ptr::null_mut(), None, error) })
        .unwrap();
    system.at(pc_system_rhs, 0.0, &[0.0, 0.0], 2).unwrap();
}

/// Data of a function that uses its own system and a copy.
struct Inside {
    own: *mut pc_system,
    copy: *mut pc_system,
    statuses: std::sync::Mutex<Vec<pc_status>>,
    law: Law,
}

unsafe extern "C" fn look(
    t: f64,
    y: *const f64,
    n: usize,
    q: *mut f64,
    _: usize,
    user: *mut c_void,
) -> c_int {
    let (mut energy, mut ydot) = (f64::NAN, [0.0; 2]);
    // SAFETY: what the test made.
    unsafe {
        let inside = &*user.cast::<Inside>();
        let statuses = [
            pc_system_rhs(inside.own, t, y, n, ydot.as_mut_ptr(), 2, ptr::null_mut()),
            pc_system_set_force(
                inside.own,
                Some(force),
                None,
                inside.law.user(),
                Some(destroy),
                ptr::null_mut(),
            ),
            pc_system_energy(inside.copy, t, y, n, &raw mut energy, ptr::null_mut()),
        ];
        pc_system_free(inside.own); // has no effect, since the system is in use
        inside.statuses.lock().unwrap().extend(statuses);
        q.write(energy);
    }
    0
}

#[test]
fn a_function_may_use_other_handles() {
    let system = forced("pendulum", &["θ"], PC_POINCARE);
    let mut copy = ptr::null_mut();
    let statuses = std::sync::Mutex::new(Vec::new());
    let mut inside = Inside { own: system.0, copy, statuses, law: Law::new(constant) };
    let user = (&raw mut inside).cast::<c_void>();
    // SAFETY: live systems, functions that take what they are given.
    unsafe {
        call(|error| pc_system_set_force(system.0, Some(look), None, user, None, error)).unwrap();
        // The copy has the same function, but its energy does not call it.
        call(|error| pc_system_clone(system.0, &raw mut copy, error)).unwrap();
        (*user.cast::<Inside>()).copy = copy;
    }
    let rates = system.at(pc_system_rhs, 0.0, &[0.0, 1.0], 2).unwrap();
    assert_eq!(rates, [1.0, (2.0 - 10.0) / 4.0]); // E = 2 θ'² − 10 cos θ
    assert_eq!(*inside.statuses.lock().unwrap(), [PC_BUSY, PC_BUSY, PC_OK]);
    assert_eq!(inside.law.destroyed(), 1);
    // SAFETY: ours, freed once.
    unsafe { pc_system_free(copy) };
}

#[test]
fn copies_share_a_function_on_several_threads() {
    struct Handle(*mut pc_system);
    // SAFETY: a handle may go from thread to thread.
    unsafe impl Send for Handle {}
    let (system, law) = (forced("pendulum", &["θ"], PC_POINCARE), Law::new(constant));
    law.set(&system).unwrap();
    let copies: Vec<Handle> = (0..4)
        .map(|_| {
            let mut copy = ptr::null_mut();
            // SAFETY: a live system and a place for the copy.
            call(|error| unsafe { pc_system_clone(system.0, &raw mut copy, error) }).unwrap();
            Handle(copy)
        })
        .collect();
    drop(system);
    std::thread::scope(|scope| {
        for handle in copies {
            scope.spawn(move || {
                let Handle(copy) = { handle };
                let system = System(copy);
                for i in 0..1000 {
                    let rates = system.at(pc_system_rhs, 0.0, &[0.0, f64::from(i)], 2).unwrap();
                    assert_eq!(rates, [f64::from(i), 0.5]);
                }
            });
        }
    });
    assert_eq!((law.calls.load(SeqCst), law.destroyed()), (4000, 1));
}

//! Functions of the program that succeed, fail or write nothing, as requested.

use std::ffi::{c_int, c_void};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::{ptr, slice};

use pc::*;

/// What a function does; freed with the handle that calls it.
pub(crate) struct Own {
    pub(crate) calls: AtomicUsize,
    /// The number of calls after which it fails with `code` or, if this is 0, writes nothing.
    pub(crate) good: usize,
    pub(crate) code: c_int,
}

impl Own {
    pub(crate) fn boxed(good: usize, code: c_int) -> *mut c_void {
        Box::into_raw(Box::new(Own { calls: AtomicUsize::new(0), good, code })).cast()
    }

    fn succeeds(&self) -> bool {
        self.calls.fetch_add(1, Ordering::Relaxed) < self.good
    }
}

pub(crate) extern "C" fn destroy(user: *mut c_void) {
    // SAFETY: made by `Own::boxed`, and destroyed once.
    drop(unsafe { Box::from_raw(user.cast::<Own>()) });
}

pub(crate) extern "C" fn value(
    t: f64,
    y: *const f64,
    y_length: usize,
    value: *mut f64,
    user: *mut c_void,
) -> c_int {
    // SAFETY: made by `Own::boxed`; the state is as long as said.
    unsafe {
        let own = &*user.cast::<Own>();
        if own.succeeds() {
            value.write(slice::from_raw_parts(y, y_length).iter().sum::<f64>() + (5.0 * t).sin());
            return 0;
        }
        own.code
    }
}

pub(crate) extern "C" fn reset(_t: f64, y: *mut f64, y_length: usize, user: *mut c_void) -> c_int {
    // SAFETY: made by `Own::boxed`; the state is as long as said.
    unsafe {
        slice::from_raw_parts_mut(y, y_length).iter_mut().for_each(|y| *y *= -0.9);
        (*user.cast::<Own>()).code / 2
    }
}

/// q_i = cos t − y_i, and its derivatives.
pub(crate) extern "C" fn force(
    t: f64,
    y: *const f64,
    y_length: usize,
    q: *mut f64,
    q_length: usize,
    user: *mut c_void,
) -> c_int {
    assert!(q_length > 0 && q_length <= y_length);
    // SAFETY: made by `Own::boxed`; both arrays are as long as said.
    unsafe {
        let own = &*user.cast::<Own>();
        if !own.succeeds() {
            return own.code;
        }
        for i in 0..q_length {
            q.add(i).write(t.cos() - *y.add(i));
        }
    }
    0
}

pub(crate) extern "C" fn force_jacobian(
    _t: f64,
    _y: *const f64,
    y_length: usize,
    dq: *mut f64,
    dq_length: usize,
    user: *mut c_void,
) -> c_int {
    // SAFETY: made by `Own::boxed`; the array is as long as said.
    unsafe {
        let own = &*user.cast::<Own>();
        if !own.succeeds() {
            return own.code;
        }
        let forces = dq_length / y_length;
        for place in 0..dq_length {
            dq.add(place).write(if place % forces == place / forces { -1.0 } else { 0.0 });
        }
    }
    0
}

/// Data of the observer of a run.
pub(crate) struct Watch {
    pub(crate) solver: *mut pc_solver,
    pub(crate) stop: bool,
}

/// Calls back into the solver that calls it, which is busy.
pub(crate) extern "C" fn observe(_t: f64, y: *const f64, y_length: usize, user: *mut c_void) -> c_int {
    assert!(!y.is_null() && y_length > 0);
    // SAFETY: a watch, whose solver is live and in use.
    unsafe {
        let watch = &*user.cast::<Watch>();
        let (mut t, mut error) = (0.0, ptr::null_mut());
        assert_eq!(pc_solver_time(watch.solver, &raw mut t, &raw mut error), pc_status::PC_BUSY);
        assert_eq!(pc_error_status(error.as_ref()), pc_status::PC_BUSY);
        pc_error_free(error);
        pc_solver_free(watch.solver);
        assert!(
            pc_solver_event_name(watch.solver.as_ref(), pc_solver_event_count(watch.solver.as_ref()))
                .is_null()
        );
        watch.stop.into()
    }
}

pub(crate) extern "C" fn observe_event(
    event: usize,
    _t: f64,
    before: *const f64,
    after: *const f64,
    y_length: usize,
    user: *mut c_void,
) -> c_int {
    assert!(!before.is_null() && !after.is_null() && y_length > 0);
    c_int::from(!user.is_null() && event == 1)
}

pub(crate) extern "C" fn follow(
    t: f64,
    y: *const f64,
    y_length: usize,
    order: c_int,
    step: f64,
    user: *mut c_void,
) -> c_int {
    assert!(t.is_finite() && !y.is_null() && y_length > 0 && order >= 0 && step.is_finite());
    // SAFETY: made by `Own::boxed`.
    let own = unsafe { &*user.cast::<Own>() };
    if own.succeeds() { 0 } else { own.code }
}

pub(crate) extern "C" fn observe_member(member: *const pc_member, user: *mut c_void) -> c_int {
    // SAFETY: as documented.
    let member = unsafe { &*member };
    assert_eq!(member.message.is_null(), matches!(member.status, pc_status::PC_OK | pc_status::PC_EVENT));
    assert_ne!(member.status, pc_status::PC_INTERNAL);
    c_int::from(!user.is_null() && member.number == 1)
}

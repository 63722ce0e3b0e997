//! An observer of events whose argument the solver owns.

use std::cell::Cell;
use std::ffi::{c_int, c_void};
use std::ptr;

use crate::common::{Refusal, Solver, System, call};
use pc::*;

/// How often the observer was called and destroyed.
#[derive(Default)]
struct Count {
    told: Cell<u32>,
    destroyed: Cell<u32>,
}

unsafe extern "C" fn tell(
    _: usize,
    _: f64,
    _: *const f64,
    _: *const f64,
    _: usize,
    user: *mut c_void,
) -> c_int {
    // SAFETY: what `set` was given.
    let count = unsafe { &*user.cast::<Count>() };
    assert_eq!(count.destroyed.get(), 0);
    count.told.set(count.told.get() + 1);
    0
}

unsafe extern "C" fn destroy(user: *mut c_void) {
    // SAFETY: what `set` was given.
    let count = unsafe { &*user.cast::<Count>() };
    count.destroyed.set(count.destroyed.get() + 1);
}

fn set(solver: *mut pc_solver, observer: pc_event_observer, count: &Count) -> Result<(), Refusal> {
    let user = ptr::from_ref(count).cast_mut().cast();
    // SAFETY: null or a live solver; the count outlives it.
    call(|error| unsafe { pc_solver_set_event_observer(solver, observer, user, Some(destroy), error) })
}

#[test]
fn user_data_of_an_observer_is_destroyed_once() {
    let (first, second, third) = (Count::default(), Count::default(), Count::default());
    let destroyed = || [&first, &second, &third].map(|count| count.destroyed.get());
    let solver = Solver::of(&System::of("bouncing-ball"), &pc_solver_options::default());
    set(solver.0, Some(tell), &first).unwrap();
    solver.advance(1.0).0.unwrap();
    let bounces = first.told.get();
    assert!(bounces > 0 && u64::from(bounces) == solver.occurrences(0));
    assert_eq!(destroyed(), [0, 0, 0]);
    // Another observer replaces it.
    set(solver.0, Some(tell), &second).unwrap();
    assert_eq!(destroyed(), [1, 0, 0]);
    solver.advance(2.0).0.unwrap();
    assert!(second.told.get() > 0 && first.told.get() == bounces);
    // A call that fails, and one without an observer, which removes the former one.
    assert_eq!(set(ptr::null_mut(), Some(tell), &third).unwrap_err().status, pc_status::PC_INVALID_ARGUMENT);
    assert_eq!(destroyed(), [1, 0, 1]);
    set(solver.0, None, &third).unwrap();
    assert_eq!(destroyed(), [1, 1, 2]);
    // The solver is freed.
    set(solver.0, Some(tell), &first).unwrap();
    drop(solver);
    assert_eq!(destroyed(), [2, 1, 2]);
}

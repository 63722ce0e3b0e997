//! Limits of derivations and integrations, and their cancellation.

use std::ffi::{c_int, c_void};
use std::ptr;
use std::time::{Duration, Instant};

use crate::common::{self, Model, Refusal, Solver, System, call};
use pc::*;

/// Coordinates in a dense frame: every quasi-velocity contains all velocities, each with a cosine.
fn dense(n: usize) -> Model {
    let list = |entry: &dyn Fn(usize) -> String| (0..n).map(entry).collect::<Vec<_>>();
    let velocity = |i: usize| {
        let terms = list(&|j| format!("cos({}*x{j} + {}*x{})*w{j}", i + 2, j + 1, (i + j) % n));
        format!("x{i} = \"{}*w{i} + {}\"", 2 * n, terms.join(" + "))
    };
    let text = format!(
        "[coordinates]\n{}\n[quasi_velocities]\n{}\n[kinematics]\n{}\n[lagrangian]\nkinetic = \"{}\"\n",
        list(&|i| format!("x{i} = 0.{}", i + 1)).join("\n"),
        list(&|i| format!("w{i} = 0.0")).join("\n"),
        list(&velocity).join("\n"),
        list(&|i| format!("w{i}^2/2")).join(" + "),
    );
    Model::text(&text).unwrap()
}

fn derive(model: &Model, options: &pc_system_options) -> Result<System, Refusal> {
    let mut system = ptr::null_mut();
    // SAFETY: live objects.
    call(|error| unsafe { pc_system_new(model.0, options, &raw mut system, error) })?;
    Ok(System(system))
}

fn refused(model: &Model, options: &pc_system_options) -> Refusal {
    derive(model, options).map(|_| ()).unwrap_err()
}

#[test]
fn memory_is_limited_for_each_derivation() {
    let model = Model::named("heavy-top-lagrange");
    let options = pc_system_options { memory_limit: 10_000, ..Default::default() };
    let refusal = refused(&model, &options);
    assert_eq!(refusal.status, pc_status::PC_LIMIT);
    assert!(refusal.message.contains("than the limit of 9.8 KiB"), "{}", refusal.message);
    // Each derivation has the whole limit.
    let options = pc_system_options { memory_limit: 8 << 20, ..Default::default() };
    let system = derive(&model, &options).unwrap();
    let (t, y) = system.start();
    for _ in 0..20 {
        let mut text = ptr::null_mut();
        // SAFETY: a live system and a place for a text.
        call(|error| unsafe { pc_system_print(system.0, 0, &raw mut text, error) }).unwrap();
        assert!(common::taken(text).contains("ω1"));
    }
    assert_eq!(system.at(pc_system_mass_matrix, t, &y, 9).unwrap().len(), 9);
}

#[test]
fn time_is_limited() {
    let options = pc_system_options { time_limit: 0.05, ..Default::default() };
    let refusal = refused(&dense(9), &options);
    assert_eq!(refusal.status, pc_status::PC_LIMIT, "{}", refusal.message);
    assert!(refusal.message.contains("than the limit of 0.05 s"), "{}", refusal.message);
    // Each derivation has its own time limit.
    let options = pc_system_options { time_limit: 3600.0, ..Default::default() };
    derive(&Model::named("euler-top"), &options).unwrap();
}

#[test]
fn another_thread_cancels() {
    let mut cancel = ptr::null_mut();
    // SAFETY: a place for a handle.
    call(|error| unsafe { pc_cancel_new(&raw mut cancel, error) }).unwrap();
    // SAFETY: a live handle.
    assert_eq!(unsafe { pc_cancel_is_requested(cancel.as_ref()) }, 0);
    struct Shared(*mut pc_cancel);
    // SAFETY: any number of threads may use the handle, as its documentation says.
    unsafe impl Send for Shared {}
    let shared = Shared(cancel);
    let elsewhere = std::thread::spawn(move || {
        let Shared(cancel) = { shared };
        std::thread::sleep(Duration::from_millis(20));
        // SAFETY: a live handle, freed after this thread has ended.
        unsafe { pc_cancel_request(cancel.as_ref()) };
        Instant::now()
    });
    let model = dense(9);
    let options = pc_system_options { cancel, ..Default::default() };
    let refusal = refused(&model, &options);
    let (ended, requested) = (Instant::now(), elsewhere.join().unwrap());
    assert_eq!(refusal.status, pc_status::PC_LIMIT, "{}", refusal.message);
    assert!(refusal.message.contains("cancelled"), "{}", refusal.message);
    assert!(ended.saturating_duration_since(requested) < Duration::from_secs(60));
    // SAFETY: a live handle.
    assert_eq!(unsafe { pc_cancel_is_requested(cancel.as_ref()) }, 1);
    // A later derivation does not begin.
    assert_eq!(refused(&Model::named("euler-top"), &options).status, pc_status::PC_LIMIT);
    // SAFETY: ours, freed once; null is allowed.
    unsafe {
        pc_cancel_free(cancel);
        pc_cancel_free(ptr::null_mut());
        pc_cancel_request(None);
        assert_eq!(pc_cancel_is_requested(None), 0);
    }
}

#[test]
fn systems_continue_without_the_cancel_handle() {
    let mut cancel = ptr::null_mut();
    // SAFETY: a place for a handle.
    call(|error| unsafe { pc_cancel_new(&raw mut cancel, error) }).unwrap();
    let options = pc_system_options { cancel, ..Default::default() };
    let system = derive(&Model::named("euler-top"), &options).unwrap();
    // SAFETY: ours, freed once.
    unsafe { pc_cancel_free(cancel) };
    let (t, y) = system.start();
    assert_eq!(system.at(pc_system_mass_matrix, t, &y, 9).unwrap().len(), 9);
}

/// A heavy top, with a solver that would take hours to reach the time `HOURS`.
fn endless(options: &pc_system_options) -> (System, Solver) {
    let system = derive(&Model::named("heavy-top-lagrange"), options).unwrap();
    let options = pc_solver_options { max_steps: 100_000_000, ..Default::default() };
    let solver = Solver::of(&system, &options);
    (system, solver)
}

const HOURS: f64 = 1e12;

#[test]
fn time_of_integrations_is_limited_call_by_call() {
    let begun = Instant::now();
    drop(endless(&pc_system_options::default()));
    // The derivation has the same limit, and is far from it.
    let time_limit = (20.0 * begun.elapsed().as_secs_f64()).ceil().max(1.0);
    let (system, solver) = endless(&pc_system_options { time_limit, ..Default::default() });
    let n = system.dim();
    let mut y = vec![0.0; n];
    // SAFETY: a live solver and room as said.
    let mut advance =
        |t: f64| call(|error| unsafe { pc_solver_advance(solver.0, t, y.as_mut_ptr(), n, error) });
    let refusal = advance(HOURS).unwrap_err();
    assert_eq!(refusal.status, pc_status::PC_LIMIT);
    let said = format!("more time would be needed than the limit of {time_limit} s, after reaching t = ");
    assert!(refusal.message.starts_with(&said), "{}", refusal.message);
    let mut t = f64::NAN;
    // SAFETY: a live solver and a place for a number.
    call(|error| unsafe { pc_solver_time(solver.0, &raw mut t, error) }).unwrap();
    assert!(t > 0.0 && t < HOURS);
    advance(t + 1.0).unwrap();
}

#[test]
fn integrations_are_cancelled() {
    let mut cancel = ptr::null_mut();
    // SAFETY: a place for a handle.
    call(|error| unsafe { pc_cancel_new(&raw mut cancel, error) }).unwrap();
    let (system, solver) = endless(&pc_system_options { cancel, ..Default::default() });
    let n = system.dim();
    extern "C" fn request(t: f64, _: *const f64, _: usize, cancel: *mut c_void) -> c_int {
        if t >= 2.0 {
            // SAFETY: the handle of the test.
            unsafe { pc_cancel_request(cancel.cast::<pc_cancel>().as_ref()) };
        }
        0
    }
    let times: Vec<f64> = (1..1000).map(f64::from).collect();
    // SAFETY: a live solver, numbers as said, a function of that type.
    let refusal = call(|error| unsafe {
        pc_solver_run(solver.0, times.as_ptr(), times.len(), Some(request), cancel.cast(), error)
    });
    let refusal = refusal.unwrap_err();
    assert_eq!(refusal.status, pc_status::PC_LIMIT);
    assert!(refusal.message.starts_with("cancelled, after reaching t = "), "{}", refusal.message);
    let (mut t, mut y) = (f64::NAN, vec![0.0; n]);
    // SAFETY: a live solver and room as said.
    let refusal =
        call(|error| unsafe { pc_solver_step(solver.0, HOURS, &raw mut t, y.as_mut_ptr(), n, error) });
    assert_eq!(refusal.unwrap_err().status, pc_status::PC_LIMIT);
    // SAFETY: a live solver and room as said.
    unsafe {
        call(|error| pc_solver_time(solver.0, &raw mut t, error)).unwrap();
        call(|error| pc_solver_state(solver.0, y.as_mut_ptr(), n, error)).unwrap();
    }
    assert!((2.0..5.0).contains(&t) && y.iter().all(|y| y.is_finite()), "{t}");
    // SAFETY: ours, freed once.
    unsafe { pc_cancel_free(cancel) };
}

#[test]
fn a_cancelled_ensemble_has_its_finished_members() {
    let mut cancel = ptr::null_mut();
    // SAFETY: a place for a handle.
    call(|error| unsafe { pc_cancel_new(&raw mut cancel, error) }).unwrap();
    let system =
        derive(&Model::named("euler-top"), &pc_system_options { cancel, ..Default::default() }).unwrap();
    extern "C" fn request(member: *const pc_member, cancel: *mut c_void) -> c_int {
        // SAFETY: a member, and the handle of the test.
        unsafe {
            assert_eq!((*member).status, pc_status::PC_OK);
            if (*member).number == 3 {
                pc_cancel_request(cancel.cast::<pc_cancel>().as_ref());
            }
        }
        0
    }
    let times = [100.0];
    let run = || {
        // SAFETY: a live system, numbers as said, a function of that type.
        call(|error| unsafe {
            let (none, length) = (ptr::null(), times.len());
            let times = times.as_ptr();
            let user = cancel.cast();
            pc_ensemble_run(
                system.0,
                ptr::null(),
                100_000,
                0.0,
                none,
                0,
                none,
                0,
                times,
                length,
                2,
                Some(request),
                user,
                error,
            )
        })
    };
    let refusal = run().unwrap_err();
    assert_eq!((refusal.status, refusal.message.as_str()), (pc_status::PC_LIMIT, "cancelled"));
    assert_eq!(run().unwrap_err().status, pc_status::PC_LIMIT);
    // SAFETY: ours, freed once.
    unsafe { pc_cancel_free(cancel) };
}

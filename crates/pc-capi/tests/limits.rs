//! What a derivation may take, and ending it from elsewhere.

#![expect(clippy::unwrap_used, unsafe_code, reason = "tests")]

mod common;

use std::ptr;
use std::time::{Duration, Instant};

use common::{Model, Refusal, System, call};
use pc::*;

/// Coordinates in a frame that is dense: every quasi-velocity is made of all velocities, with a cosine each.
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
    // As much as one derivation takes is there for each.
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
    let begun = Instant::now();
    let refusal = refused(&dense(9), &options);
    assert_eq!(refusal.status, pc_status::PC_LIMIT, "{}", refusal.message);
    assert!(refusal.message.contains("than the limit of 0.05 s"), "{}", refusal.message);
    // Without a limit it takes seconds; on a busy machine some tenths of one may go by.
    assert!(begun.elapsed() < Duration::from_secs(1), "{:?}", begun.elapsed());
    // The time of a derivation is its own.
    let options = pc_system_options { time_limit: 5.0, ..Default::default() };
    derive(&Model::named("euler-top"), &options).unwrap();
}

#[test]
fn another_thread_cancels() {
    let mut cancel = ptr::null_mut();
    // SAFETY: a place for a handle.
    call(|error| unsafe { pc_cancel_new(&raw mut cancel, error) }).unwrap();
    // SAFETY: a live handle.
    assert_eq!(unsafe { pc_cancel_is_requested(cancel) }, 0);
    struct Shared(*mut pc_cancel);
    // SAFETY: any number of threads may use the handle, as its documentation says.
    unsafe impl Send for Shared {}
    let shared = Shared(cancel);
    let elsewhere = std::thread::spawn(move || {
        let Shared(cancel) = { shared };
        std::thread::sleep(Duration::from_millis(100));
        // SAFETY: a live handle, freed after this thread has ended.
        unsafe { pc_cancel_request(cancel) };
        Instant::now()
    });
    let model = dense(9);
    let options = pc_system_options { cancel, ..Default::default() };
    let refusal = refused(&model, &options);
    let (ended, requested) = (Instant::now(), elsewhere.join().unwrap());
    assert_eq!(refusal.status, pc_status::PC_LIMIT, "{}", refusal.message);
    assert!(refusal.message.contains("cancelled"), "{}", refusal.message);
    assert!(ended.saturating_duration_since(requested) < Duration::from_secs(1));
    // SAFETY: a live handle.
    assert_eq!(unsafe { pc_cancel_is_requested(cancel) }, 1);
    // It does not begin again.
    assert_eq!(refused(&Model::named("euler-top"), &options).status, pc_status::PC_LIMIT);
    // SAFETY: ours, freed once; null is allowed.
    unsafe {
        pc_cancel_free(cancel);
        pc_cancel_free(ptr::null_mut());
        pc_cancel_request(ptr::null());
        assert_eq!(pc_cancel_is_requested(ptr::null()), 0);
    }
}

#[test]
fn what_is_derived_goes_on_without_the_handle() {
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

//! Calls in any order, with any text: no crash, every failure with its message, nothing left behind.
//!
//! `PC_SEQUENCES=1000000 cargo test --release -p pc-capi --test sequences` plays many more than the
//! usual few hundred, on all cores.

#![expect(clippy::unwrap_used, unsafe_code, reason = "tests")]

mod callbacks;
mod calls;
#[path = "../it/common/mod.rs"]
mod common;
mod counting;
mod handles;
mod models;
mod solvers;
mod systems;

use std::cell::Cell;
use std::sync::atomic::{AtomicU32, AtomicUsize, Ordering};
use std::thread;

use calls::{Call, calls};
use handles::Handles;
use proptest::prelude::any;
use proptest::prop_assert;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};

/// Makes the calls and frees the handles; returns how many calls succeeded, and how many
/// allocations were not freed.
fn play(calls: &[Call], quiet: bool) -> (usize, isize) {
    let before = counting::live();
    let mut handles = Handles::none(quiet);
    let succeeded = calls.iter().filter(|call| handles.make(call).is_ok()).count();
    drop(handles);
    (succeeded, counting::live() - before)
}

/// Plays `cases` sequences, different ones for each batch; returns how many of their calls
/// succeeded.
fn play_all(cases: u32, batch: u32) -> usize {
    let seed = batch.to_le_bytes().repeat(8);
    let rng = TestRng::from_seed(RngAlgorithm::ChaCha, &seed);
    let config = Config { cases, failure_persistence: None, ..Config::default() };
    let succeeded = Cell::new(0);
    let outcome = TestRunner::new_with_rng(config, rng).run(&(calls(), any::<bool>()), |(calls, quiet)| {
        let (count, mut left) = play(&calls, quiet);
        // What the threads of an ensemble allocate and free is not counted here.
        let threads = calls.iter().any(|call| matches!(call, Call::Ensemble { .. }));
        if left != 0 && !threads {
            // Some allocations are made only once, such as the table of the host's functions.
            left = play(&calls, quiet).1;
        }
        prop_assert!(threads || left == 0, "{} allocations left behind", left);
        succeeded.set(succeeded.get() + count);
        Ok(())
    });
    outcome.unwrap();
    succeeded.get()
}

/// Sequences in a batch, after which a long play reports its progress.
const BATCH: u32 = 5000;

#[test]
fn any_sequence_of_calls_is_safe_and_leaks_nothing() {
    let cases: u32 = std::env::var("PC_SEQUENCES").map_or(300, |number| number.parse().unwrap());
    let batches = cases.div_ceil(BATCH);
    let workers = thread::available_parallelism().map_or(1, |n| n.get() as u32).min(batches);
    let (next, succeeded, played) = (AtomicU32::new(0), AtomicUsize::new(0), AtomicU32::new(0));
    let work = || {
        while let Some(batch) = Some(next.fetch_add(1, Ordering::Relaxed)).filter(|&batch| batch < batches) {
            let count = BATCH.min(cases - batch * BATCH);
            succeeded.fetch_add(play_all(count, batch), Ordering::Relaxed);
            let played = played.fetch_add(count, Ordering::Relaxed) + count;
            println!("{played} sequences");
        }
    };
    thread::scope(|scope| {
        let workers: Vec<_> = (0..workers).map(|_| scope.spawn(work)).collect();
        workers.into_iter().for_each(|worker| worker.join().unwrap());
    });
    let succeeded = succeeded.into_inner();
    println!("{cases} sequences, {succeeded} calls succeeded");
    assert!(3 * succeeded > 10 * cases as usize, "only {succeeded} calls did something");
}

#[test]
fn every_function_of_the_header_is_among_the_calls() {
    let sources = [
        include_str!("models.rs"),
        include_str!("systems.rs"),
        include_str!("solvers.rs"),
        include_str!("handles.rs"),
    ]
    .concat();
    let words: Vec<&str> = sources.split(|c: char| !(c.is_alphanumeric() || c == '_')).collect();
    let interface = include_str!("../../abi/interface.txt");
    let functions = interface
        .lines()
        .filter(|line| !line.starts_with("callback"))
        .filter_map(|line| line.split_once('(')?.0.rsplit([' ', '*']).next());
    let (called, missing): (Vec<&str>, Vec<&str>) = functions.partition(|name| words.contains(name));
    assert!(called.len() > 100);
    assert_eq!(missing, [""; 0]);
}

//! The results of many threads in the order of the members, held in bounded memory.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::atomic::Ordering;
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;

use crate::ensemble::stop::Stop;

/// Hands members out in order, receives their results in any order, and delivers the results in
/// order. No member that has begun is `window` or more ahead of the one to be delivered next.
pub(super) struct Queue<'a, T> {
    end: u64,
    window: u64,
    stop: &'a Stop<'a>,
    state: Mutex<State<T>>,
    /// Signals that a result has arrived, or that a thread has ended.
    finished: Condvar,
    /// Signals that a result was taken, or that no more will be taken.
    taken: Condvar,
}

struct State<T> {
    /// The member to begin next.
    next: u64,
    /// The member to deliver next.
    wanted: u64,
    /// Results that wait for an earlier one.
    results: BTreeMap<u64, T>,
    /// Whether a worker panicked: the results of the members it had begun will not come.
    broken: bool,
}

impl<'a, T> Queue<'a, T> {
    pub(super) fn new(members: Range<u64>, window: u64, stop: &'a Stop<'a>) -> Self {
        let state =
            State { next: members.start, wanted: members.start, results: BTreeMap::new(), broken: false };
        let state = Mutex::new(state);
        Queue { end: members.end, window, stop, state, finished: Condvar::new(), taken: Condvar::new() }
    }

    /// Waits until the window has room and returns the next member; none if all have been begun, or
    /// if a stop is requested.
    pub(super) fn begin(&self) -> Option<u64> {
        let mut state = self.state();
        let full = |state: &State<T>| state.next < self.end && state.next - state.wanted >= self.window;
        while full(&state) && !self.stop.requested() {
            state = self.taken.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        self.hand_out(&mut state)
    }

    /// The same without waiting: the result is also none if the window has no room.
    pub(super) fn begin_if_room(&self) -> Option<u64> {
        let mut state = self.state();
        if state.next < self.end && state.next - state.wanted >= self.window {
            return None;
        }
        self.hand_out(&mut state)
    }

    fn hand_out(&self, state: &mut State<T>) -> Option<u64> {
        if state.next >= self.end || self.stop.requested() {
            self.finished.notify_all();
            return None;
        }
        state.next += 1;
        Some(state.next - 1)
    }

    /// Receives the result of a member that was begun.
    pub(super) fn finish(&self, member: u64, result: T) {
        self.state().results.insert(member, result);
        self.finished.notify_all();
    }

    /// Announces that a thread ends: what [`take`](Queue::take) waits for may no longer come.
    pub(super) fn leave(&self) {
        let state = self.state();
        self.finished.notify_all();
        drop(state);
    }

    /// Waits for the result of the member that comes next; none if that result will never come.
    pub(super) fn take(&self, member: u64) -> Option<T> {
        let mut state = self.state();
        loop {
            if let Some(result) = state.results.remove(&member) {
                state.wanted = member + 1;
                self.taken.notify_all();
                return Some(result);
            }
            if state.broken || self.stop.requested() && state.next <= member {
                return None;
            }
            state = self.finished.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
    }

    /// A guard that stops everything when it is dropped.
    pub(super) fn closing(&self) -> Closing<'_, 'a, T> {
        Closing(self)
    }

    /// A guard that stops everything if it is dropped by a panic of this worker thread.
    pub(super) fn breaking(&self) -> Breaking<'_, 'a, T> {
        Breaking(self)
    }

    fn close(&self, state: MutexGuard<'_, State<T>>) {
        self.stop.own.store(true, Ordering::Relaxed);
        self.taken.notify_all();
        drop(state);
    }

    fn state(&self) -> MutexGuard<'_, State<T>> {
        // No foreign code runs while it is locked, so a poisoned lock is sound.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

pub(super) struct Closing<'q, 'a, T>(&'q Queue<'a, T>);

impl<T> Drop for Closing<'_, '_, T> {
    fn drop(&mut self) {
        self.0.close(self.0.state());
    }
}

pub(super) struct Breaking<'q, 'a, T>(&'q Queue<'a, T>);

impl<T> Drop for Breaking<'_, '_, T> {
    fn drop(&mut self) {
        if thread::panicking() {
            let mut state = self.0.state();
            state.broken = true;
            self.0.finished.notify_all();
            self.0.close(state);
        }
    }
}

//! Values that only one call may use at a time.

use std::cell::UnsafeCell;
use std::marker::PhantomData;
use std::ops::{Deref, DerefMut};
use std::sync::atomic::{AtomicU8, AtomicU32, Ordering};

use crate::ffi::call_error::CallError;

const FREE: u8 = 0;
const IN_USE: u8 = 1;
const BROKEN: u8 = 2;

/// A value that one call at a time may use, and that no call may use after one has panicked.
///
/// Like a mutex for which nobody waits; releasing it takes no atomic exchange, whose cost would be
/// noticeable in an evaluation that takes a few nanoseconds.
pub(crate) struct Exclusive<T> {
    state: AtomicU8,
    /// The calls that keep the value from being dropped, whether they use it or not.
    keepers: AtomicU32,
    value: UnsafeCell<T>,
}

// SAFETY: the value goes from thread to thread, and only one has it at a time.
unsafe impl<T: Send> Sync for Exclusive<T> {}

/// Access to the value, until this is dropped.
pub(crate) struct Use<'a, T>(&'a Exclusive<T>, PhantomData<&'a mut T>);

/// Keeps the value from being dropped, until this is dropped; others may use it meanwhile.
pub(crate) struct Kept<'a>(&'a AtomicU32);

impl<T> Exclusive<T> {
    pub(crate) fn new(value: T) -> Exclusive<T> {
        Exclusive { state: AtomicU8::new(FREE), keepers: AtomicU32::new(0), value: UnsafeCell::new(value) }
    }

    /// Gives access to the value, if nobody else is using it.
    #[inline]
    pub(crate) fn take(&self) -> Result<Use<'_, T>, CallError> {
        match self.state.compare_exchange(FREE, IN_USE, Ordering::Acquire, Ordering::Relaxed) {
            Ok(_) => Ok(Use(self, PhantomData)),
            Err(BROKEN) => Err(CallError::Broken),
            Err(_) => Err(CallError::Busy),
        }
    }

    /// Keeps the value from being dropped during a call that others interrupt.
    pub(crate) fn keep(&self) -> Kept<'_> {
        self.keepers.fetch_add(1, Ordering::Relaxed);
        Kept(&self.keepers)
    }

    /// Refuses all further use of the value, so that it can be dropped; returns false if a call is
    /// using or keeping it now.
    pub(crate) fn close(&self) -> bool {
        // Nobody begins to keep what is being freed, so that the number does not rise meanwhile.
        self.keepers.load(Ordering::Acquire) == 0 && self.state.swap(IN_USE, Ordering::Acquire) != IN_USE
    }
}

impl Drop for Kept<'_> {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::Release);
    }
}

impl<T> Deref for Use<'_, T> {
    type Target = T;

    fn deref(&self) -> &T {
        // SAFETY: `take` gives the value to one at a time.
        unsafe { &*self.0.value.get() }
    }
}

impl<T> DerefMut for Use<'_, T> {
    fn deref_mut(&mut self) -> &mut T {
        // SAFETY: `take` gives the value to one at a time, which borrows it exclusively.
        unsafe { &mut *self.0.value.get() }
    }
}

impl<T> Drop for Use<'_, T> {
    #[inline]
    fn drop(&mut self) {
        // What a panic leaves half done is not used again; nor is a value used during another
        // panic.
        let state = if std::thread::panicking() { BROKEN } else { FREE };
        self.0.state.store(state, Ordering::Release);
    }
}

//! Ending an ensemble early.

use std::sync::atomic::{AtomicBool, Ordering};

/// A request to end an ensemble early.
#[derive(Debug, Clone, Copy)]
pub struct Stop<'a> {
    pub(super) own: &'a AtomicBool,
    pub(super) flag: Option<&'a AtomicBool>,
}

impl Stop<'_> {
    /// Whether to end now: the consumer has stopped, or the flag of
    /// [`Ensemble::stopped_by`](crate::Ensemble::stopped_by) is set.
    pub fn requested(&self) -> bool {
        self.own.load(Ordering::Relaxed) || self.flag.is_some_and(|flag| flag.load(Ordering::Relaxed))
    }
}

//! What the answers have in common: the text with which the page began, limits, and what is kept.

use std::time::Duration;

use pc_expr::{Cancel, Limits};
use tokio::sync::Semaphore;

use crate::live::kept::Kept;
use crate::live::original::Original;

/// Computations and commands at a time: the last one of the page, and the one that it has given up, which may still be ending.
const AT_A_TIME: usize = 3;

/// The text with which a page began, limits, and what is kept between requests.
pub(crate) struct Desk {
    pub(super) original: Original,
    /// Bytes for the expressions of one computation.
    pub(super) memory: u64,
    /// The time for one computation.
    pub(super) time: Duration,
    pub(super) kept: Kept,
    /// Whoever computes holds one of these.
    pub(super) places: Semaphore,
}

impl Desk {
    /// A desk on which nothing lies but a text.
    pub(crate) fn new(original: Original, memory: u64, time: Duration) -> Desk {
        Desk { original, memory, time, kept: Kept::default(), places: Semaphore::new(AT_A_TIME) }
    }

    /// The limits of one computation, which begins now.
    pub(super) fn limits(&self, cancel: &Cancel) -> Limits {
        Limits { memory: self.memory, time: Some(self.time), cancel: cancel.clone() }
    }
}

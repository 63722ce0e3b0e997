//! Limits on the amount of work.

use std::fmt;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

/// The limits on work with expressions.
#[derive(Clone, Debug)]
pub struct Limits {
    /// Bytes of expressions, estimated from the nodes; 4 GiB by default.
    pub memory: u64,
    /// Time since the [budget](crate::Budget) was made; no limit by default.
    pub time: Option<Duration>,
    /// A handle by which another thread can end the work.
    pub cancel: Cancel,
}

impl Default for Limits {
    fn default() -> Limits {
        Limits { memory: 4 << 30, time: None, cancel: Cancel::default() }
    }
}

/// A handle by which another thread ends work within a [`Budget`](crate::Budget) or until a
/// [`Deadline`](crate::Deadline); clones are the same handle.
#[derive(Clone, Debug, Default)]
pub struct Cancel(Arc<AtomicBool>);

impl Cancel {
    /// Ends the work permanently.
    pub fn cancel(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether the work has been ended.
    pub fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

impl PartialEq for Cancel {
    fn eq(&self, other: &Cancel) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

/// The [limit](Limits) that has been reached.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spent {
    /// The memory.
    Memory {
        /// Bytes.
        limit: u64,
    },
    /// The time.
    Time {
        /// The time that was allowed.
        limit: Duration,
    },
    /// The work was [cancelled](Cancel::cancel).
    Cancelled,
}

impl fmt::Display for Spent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Spent::Memory { limit } => {
                let (amount, unit) = match *limit {
                    bytes if bytes >= 1 << 30 => (bytes as f64 / f64::from(1 << 30), "GiB"),
                    bytes if bytes >= 1 << 20 => (bytes as f64 / f64::from(1 << 20), "MiB"),
                    bytes => (bytes as f64 / 1024.0, "KiB"),
                };
                write!(
                    f,
                    "more memory would be needed than the limit of {} {unit}",
                    (amount * 10.0).round() / 10.0
                )
            }
            Spent::Time { limit } => {
                write!(f, "more time would be needed than the limit of {} s", limit.as_secs_f64())
            }
            Spent::Cancelled => write!(f, "cancelled"),
        }
    }
}

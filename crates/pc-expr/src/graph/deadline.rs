//! When work must end.

use std::time::{Duration, Instant};

use crate::graph::limits::{Cancel, Limits, Spent};

/// When work must end: after some time, or when it is [cancelled](Cancel). Work that creates no
/// expressions, and so takes nothing from a [`Budget`](crate::Budget), checks a deadline occasionally.
///
/// ```
/// use std::time::Duration;
/// use pc_expr::{Cancel, Deadline, Limits, Spent};
/// let cancel = Cancel::default();
/// let limits = Limits { time: Some(Duration::from_secs(3600)), cancel: cancel.clone(), ..Limits::default() };
/// let deadline = Deadline::new(&limits);
/// assert_eq!(deadline.passed(), None);
/// cancel.cancel();
/// assert_eq!(deadline.passed(), Some(Spent::Cancelled));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Deadline {
    /// The time allowed and the instant at which it is over, `None` if that is beyond the range of the clock.
    time: Option<(Duration, Instant)>,
    cancel: Cancel,
}

impl Deadline {
    /// The deadline for work that begins now within these limits.
    pub fn new(limits: &Limits) -> Deadline {
        let end = |time: Duration| Some((time, Instant::now().checked_add(time)?));
        Deadline { time: limits.time.and_then(end), cancel: limits.cancel.clone() }
    }

    /// Allows the full time again, from now on.
    pub fn renew(&mut self) {
        if let Some((time, end)) = &mut self.time
            && let Some(later) = Instant::now().checked_add(*time)
        {
            *end = later;
        }
    }

    /// Why work must end now, if it must.
    pub fn passed(&self) -> Option<Spent> {
        if self.cancel.is_cancelled() {
            return Some(Spent::Cancelled);
        }
        let (limit, end) = self.time?;
        (Instant::now() > end).then_some(Spent::Time { limit })
    }
}

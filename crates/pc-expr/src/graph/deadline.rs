//! When work has to end.

use std::time::{Duration, Instant};

use crate::graph::limits::{Cancel, Limits, Spent};

/// When work has to end: after some time, or when somebody [says so](Cancel). What makes no expressions, and so takes nothing from
/// a [`Budget`](crate::Budget), looks at it now and then.
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
    /// How much time there was, and when it is over; none where that is beyond what a clock shows.
    time: Option<(Duration, Instant)>,
    cancel: Cancel,
}

impl Deadline {
    /// The end of what begins now within these limits.
    pub fn new(limits: &Limits) -> Deadline {
        let end = |time: Duration| Some((time, Instant::now().checked_add(time)?));
        Deadline { time: limits.time.and_then(end), cancel: limits.cancel.clone() }
    }

    /// Gives as much time as there was at first, from now on.
    pub fn renew(&mut self) {
        if let Some((time, end)) = &mut self.time
            && let Some(later) = Instant::now().checked_add(*time)
        {
            *end = later;
        }
    }

    /// Why work has to end by now, if it has.
    pub fn passed(&self) -> Option<Spent> {
        if self.cancel.is_cancelled() {
            return Some(Spent::Cancelled);
        }
        let (limit, end) = self.time?;
        (Instant::now() > end).then_some(Spent::Time { limit })
    }
}

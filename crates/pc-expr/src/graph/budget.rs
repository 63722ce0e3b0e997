//! What making expressions may take.

use std::fmt;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};

/// What work on expressions may take.
#[derive(Clone, Debug)]
pub struct Limits {
    /// Bytes of expressions, as they are estimated from the nodes; 4 GiB by default.
    pub memory: u64,
    /// From when the [budget](Budget::new) is made; no limit by default.
    pub time: Option<Duration>,
    /// Ends the work from elsewhere.
    pub cancel: Cancel,
}

impl Default for Limits {
    fn default() -> Limits {
        Limits { memory: 4 << 30, time: None, cancel: Cancel::default() }
    }
}

/// What is left of the limits; clones are the same budget, and graphs that are [within](crate::Graph::within) it take from it
/// together. Once it is spent no graph makes expressions any more, and what is derived in them ends in
/// [`ExprError::Spent`](crate::ExprError::Spent).
///
/// ```
/// use pc_expr::{Budget, ExprError, Graph, Limits, Spent};
/// let graph = Graph::new().within(&Budget::new(Limits { memory: 1 << 16, ..Limits::default() }));
/// let x = graph.symbol("x");
/// let tower = |graph: &Graph| graph.check(&[(0..10_000).fold(x, |y, _| (y + 1.0).sin())]);
/// let error = graph.stage("a tower of sines", || tower(&graph)).unwrap_err();
/// assert!(matches!(error, ExprError::Spent { what: Spent::Memory { .. }, stage: "a tower of sines", .. }));
/// ```
#[derive(Clone, Debug)]
pub struct Budget(Arc<Meter>);

impl Budget {
    /// A budget of which nothing is spent yet; its time begins to run.
    pub fn new(limits: Limits) -> Budget {
        Budget(Arc::new(Meter::new(limits)))
    }

    /// What there was.
    pub fn limits(&self) -> &Limits {
        &self.0.limits
    }

    /// What is spent by now, if anything is, and in which stage of the work it was.
    pub fn spent(&self) -> Option<(Spent, &'static str)> {
        self.0.spent()
    }

    pub(crate) fn meter(&self) -> Arc<Meter> {
        Arc::clone(&self.0)
    }
}

impl Default for Budget {
    fn default() -> Budget {
        Budget::new(Limits::default())
    }
}

/// A handle by which another thread ends what works within a [`Budget`]; clones are the same handle.
#[derive(Clone, Debug, Default)]
pub struct Cancel(Arc<AtomicBool>);

impl Cancel {
    /// Ends the work. It does not begin again.
    pub fn cancel(&self) {
        self.0.store(true, Ordering::Relaxed);
    }

    /// Whether the work has been ended.
    pub fn is_cancelled(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// Which of the [limits](Limits) is reached.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spent {
    /// The memory.
    Memory {
        /// Bytes.
        limit: u64,
    },
    /// The time.
    Time {
        /// All there was.
        limit: Duration,
    },
    /// Somebody [cancelled](Cancel::cancel) the work.
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

/// A node with its values and its places in tables, in bytes.
const NODE: usize = 256;
/// An operand of a sum or of a product, or a term of a value with roots.
const OPERAND: usize = 64;

/// What is left of a budget; graphs that work for one another share it.
#[derive(Debug)]
pub(crate) struct Meter {
    limits: Limits,
    deadline: Option<Instant>,
    used: AtomicU64,
    stage: Mutex<&'static str>,
    /// What was spent first, and in which stage.
    spent: OnceLock<(Spent, &'static str)>,
}

impl Meter {
    fn new(limits: Limits) -> Meter {
        Meter {
            deadline: limits.time.and_then(|time| Instant::now().checked_add(time)),
            used: AtomicU64::new(0),
            stage: Mutex::new("the expressions"),
            spent: OnceLock::new(),
            limits,
        }
    }

    /// Names the stage of the work; answers with the one before.
    pub(crate) fn enter(&self, stage: &'static str) -> &'static str {
        std::mem::replace(&mut *self.stage.lock().unwrap_or_else(PoisonError::into_inner), stage)
    }

    /// Takes a node of so many operands and terms from what is left; answers with its bytes.
    pub(crate) fn take(&self, operands: usize) -> u64 {
        let bytes = (NODE + OPERAND * operands) as u64;
        let used = self.used.fetch_add(bytes, Ordering::Relaxed) + bytes;
        if used > self.limits.memory {
            self.spend(Spent::Memory { limit: self.limits.memory });
        }
        bytes
    }

    /// Gives back the bytes of nodes that are no more.
    pub(crate) fn give_back(&self, bytes: u64) {
        self.used.fetch_sub(bytes, Ordering::Relaxed);
    }

    /// Whether there is nothing left; of the clock and the handle as far as was seen when they were last looked at.
    pub(crate) fn is_spent(&self, looks: bool) -> bool {
        if looks {
            self.look();
        }
        self.spent.get().is_some()
    }

    fn look(&self) {
        if self.limits.cancel.is_cancelled() {
            self.spend(Spent::Cancelled);
        }
        if self.deadline.is_some_and(|deadline| Instant::now() > deadline) {
            self.spend(Spent::Time { limit: self.limits.time.unwrap_or_default() });
        }
    }

    fn spend(&self, what: Spent) {
        let stage = *self.stage.lock().unwrap_or_else(PoisonError::into_inner);
        self.spent.get_or_init(|| (what, stage));
    }

    /// What is spent by now, if anything is, and in which stage it was.
    fn spent(&self) -> Option<(Spent, &'static str)> {
        self.look();
        self.spent.get().copied()
    }
}

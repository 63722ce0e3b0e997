//! The budget of memory and time for building expressions.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use crate::graph::deadline::Deadline;
use crate::graph::limits::{Limits, Spent};

/// The memory and time that remain within the given limits. Clones share one budget, as do graphs
/// [within](crate::Graph::within) it. Once the budget is spent, no graph that shares it creates further
/// expressions, and derivations in these graphs end in [`ExprError::Spent`](crate::ExprError::Spent).
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
    /// A new budget, whose time begins now.
    pub fn new(limits: Limits) -> Budget {
        let deadline = Deadline::new(&limits);
        Budget(Arc::new(Meter::new(limits, deadline)))
    }

    /// A new budget with the same memory limit, which ends when this one does.
    pub fn beside(&self) -> Budget {
        Budget(Arc::new(Meter::new(self.0.limits.clone(), self.0.deadline.clone())))
    }

    /// The limits with which this budget was made.
    pub fn limits(&self) -> &Limits {
        &self.0.limits
    }

    /// Its deadline.
    pub fn deadline(&self) -> &Deadline {
        &self.0.deadline
    }

    /// The limit that has been reached, if any, and the stage of the work at that moment.
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

/// The number of bytes of a node, including its values and its entries in tables.
const NODE: usize = 256;
/// The number of bytes of an operand of a sum or product, or of a term of a value with roots.
const OPERAND: usize = 64;

/// The remainder of a budget, shared by graphs that work together.
#[derive(Debug)]
pub(crate) struct Meter {
    limits: Limits,
    deadline: Deadline,
    used: AtomicU64,
    stage: Mutex<&'static str>,
    /// The limit that was reached first, and the stage of the work at that moment.
    spent: OnceLock<(Spent, &'static str)>,
}

impl Meter {
    fn new(limits: Limits, deadline: Deadline) -> Meter {
        Meter {
            deadline,
            used: AtomicU64::new(0),
            stage: Mutex::new("the expressions"),
            spent: OnceLock::new(),
            limits,
        }
    }

    /// Names the stage of the work and returns the previous one.
    pub(crate) fn enter(&self, stage: &'static str) -> &'static str {
        std::mem::replace(&mut *self.stage.lock().unwrap_or_else(PoisonError::into_inner), stage)
    }

    /// Takes the bytes of a node with this many operands and terms from the remainder, and returns them.
    pub(crate) fn take(&self, operands: usize) -> u64 {
        let bytes = (NODE + OPERAND * operands) as u64;
        self.charge(bytes);
        bytes
    }

    /// Takes bytes from the remainder.
    pub(crate) fn charge(&self, bytes: u64) {
        let used = self.used.fetch_add(bytes, Ordering::Relaxed) + bytes;
        if used > self.limits.memory {
            self.spend(Spent::Memory { limit: self.limits.memory });
        }
    }

    /// Gives back the bytes of dropped nodes.
    pub(crate) fn give_back(&self, bytes: u64) {
        self.used.fetch_sub(bytes, Ordering::Relaxed);
    }

    /// Whether the budget is spent; the clock and the handle are read only if `looks` is true.
    pub(crate) fn is_spent(&self, looks: bool) -> bool {
        if looks {
            self.look();
        }
        self.spent.get().is_some()
    }

    fn look(&self) {
        if let Some(what) = self.deadline.passed() {
            self.spend(what);
        }
    }

    fn spend(&self, what: Spent) {
        let stage = *self.stage.lock().unwrap_or_else(PoisonError::into_inner);
        self.spent.get_or_init(|| (what, stage));
    }

    /// The limit that has been reached by now, if any, and the stage at that moment.
    fn spent(&self) -> Option<(Spent, &'static str)> {
        self.look();
        self.spent.get().copied()
    }
}

//! The graph, which owns the nodes.

use std::cell::{RefCell, RefMut};
use std::fmt;

use crate::error::ExprError;
use crate::graph::budget::Budget;
use crate::graph::dag::Dag;
use crate::graph::node::Folding;

/// An arena of interned expressions.
///
/// Expressions that are written alike are the same node; so are expressions of equal value, unless this is
/// switched off with [`Folding::Structural`]: each node carries its value at two random points of a prime field,
/// so sin²x + cos²x is 1 and a structure coefficient that is a constant in disguise is that constant. The field
/// only tests identity; values are always computed in `f64`.
///
/// ```
/// use pc_expr::Graph;
/// let graph = Graph::new();
/// let x = graph.symbol("x");
/// assert_eq!(x.sin() * x.sin() + x.cos() * x.cos(), 1.0.into());
/// assert_eq!(((x + 1.0) * (x - 1.0)).derivative(x), 2.0 * x);
/// ```
pub struct Graph {
    dag: RefCell<Dag>,
    budget: Budget,
    /// The names of functions of time, each with that of its derivative.
    rates: RefCell<Vec<(String, String)>>,
}

impl Default for Graph {
    fn default() -> Graph {
        Graph::new()
    }
}

impl fmt::Debug for Graph {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Graph({} nodes)", self.len())
    }
}

impl Graph {
    /// An empty graph that merges expressions of equal value.
    pub fn new() -> Graph {
        Graph::with_folding(Folding::ByValue)
    }

    /// An empty graph with the given rule for merging.
    pub fn with_folding(folding: Folding) -> Graph {
        Graph::of(folding, Budget::default())
    }

    fn of(folding: Folding, budget: Budget) -> Graph {
        let dag = RefCell::new(Dag::new(folding, Some(budget.meter())));
        Graph { dag, budget, rates: RefCell::default() }
    }

    /// An empty graph with the same folding as this one; it draws on a budget that others may share.
    #[must_use]
    pub fn within(self, budget: &Budget) -> Graph {
        Graph { rates: self.rates.clone(), ..Graph::of(self.folding(), budget.clone()) }
    }

    /// An empty graph that draws on the same budget as this one.
    pub fn page(&self, folding: Folding) -> Graph {
        Graph { rates: self.rates.clone(), ..Graph::of(folding, self.budget.clone()) }
    }

    /// Runs a named stage of work in this graph. If its budget is spent before or during the work, the
    /// incomplete result is replaced by an error that names the stage.
    ///
    /// # Errors
    /// [`ExprError::Spent`], and any error of the work itself.
    pub fn stage<T, E: From<ExprError>>(
        &self,
        name: &'static str,
        work: impl FnOnce() -> Result<T, E>,
    ) -> Result<T, E> {
        let before = self.budget.meter().enter(name);
        let result = self.check_budget().map_err(E::from).and_then(|()| work());
        let result = self.check_budget().map_err(E::from).and(result);
        self.budget.meter().enter(before);
        result
    }

    /// The budget on which this graph draws.
    pub fn budget(&self) -> &Budget {
        &self.budget
    }

    /// Takes the bytes of something that is kept beside the expressions from the budget.
    pub fn charge(&self, bytes: usize) {
        self.with(|dag| dag.charge(bytes as u64));
    }

    /// # Errors
    /// [`ExprError::Spent`] if the budget is spent.
    pub fn check_budget(&self) -> Result<(), ExprError> {
        match self.budget.spent() {
            None => Ok(()),
            Some((what, stage)) => Err(ExprError::Spent { what, stage, nodes: self.len() }),
        }
    }

    /// The rule for merging.
    pub fn folding(&self) -> Folding {
        self.with(|dag| dag.folding())
    }

    /// Number of nodes created so far.
    pub fn len(&self) -> usize {
        self.with(|dag| dag.len())
    }

    /// Whether no node has been created.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of divisions so far by an expression that is identically zero.
    pub fn zero_divisions(&self) -> usize {
        self.with(|dag| dag.zero_divisions().len())
    }

    pub(super) fn rates_mut(&self) -> RefMut<'_, Vec<(String, String)>> {
        self.rates.borrow_mut()
    }

    pub(crate) fn with<R>(&self, f: impl FnOnce(&mut Dag) -> R) -> R {
        f(&mut self.dag.borrow_mut())
    }
}

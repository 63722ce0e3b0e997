//! The graph that owns the nodes, and the questions that are asked of whole expressions.

use std::cell::RefCell;
use std::fmt;

use rustc_hash::FxHashSet;

use crate::error::ExprError;
use crate::graph::dag::{Atom, Dag, Folding, Node, NodeId};
use crate::graph::evaluate::{Scalar, evaluate};
use crate::graph::expr::Expr;
use crate::graph::function::Function;
use crate::graph::number::Number;
use crate::graph::subgraph::Cone;

/// An arena of interned expressions.
///
/// Expressions that are written alike are the same node; so are, unless switched off with
/// [`Folding::Structural`], expressions that *are* alike: each node carries its value at two random points of a
/// prime field, so sin²x + cos²x is 1 and a structure coefficient that is a constant in disguise is that constant.
/// The field only tests identity, values are always computed in `f64`.
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
        Graph { dag: RefCell::new(Dag::new(folding)) }
    }

    /// The rule for merging.
    pub fn folding(&self) -> Folding {
        self.with(|dag| dag.folding())
    }

    /// The symbol of that name; the same name is always the same symbol.
    pub fn symbol(&self, name: &str) -> Expr<'_> {
        let node = self.with(|dag| dag.symbol(name));
        self.expr(Atom::Node(node))
    }

    /// The symbols of those names.
    pub fn symbols<const N: usize>(&self, names: [&str; N]) -> [Expr<'_>; N] {
        names.map(|name| self.symbol(name))
    }

    /// Number of nodes made so far.
    pub fn len(&self) -> usize {
        self.with(|dag| dag.len())
    }

    /// Whether no node has been made.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of divisions so far by an expression that is identically zero.
    pub fn zero_divisions(&self) -> usize {
        self.with(|dag| dag.zero_divisions().len())
    }

    /// Whether all expressions are defined.
    ///
    /// # Errors
    /// If not, [`ExprError::DivisionByZero`] with the dividend of the first division by an expression that is
    /// identically zero, or [`ExprError::Undefined`] if there was none.
    pub fn check<'g>(&'g self, expressions: &[Expr<'g>]) -> Result<(), ExprError> {
        if !expressions.iter().any(|x| x.is_undefined()) {
            return Ok(());
        }
        match self.with(|dag| dag.zero_divisions().first().copied()) {
            None => Err(ExprError::Undefined),
            Some(atom) => Err(ExprError::DivisionByZero { dividend: self.expr(atom).to_string() }),
        }
    }

    /// Σ xᵢ as one n-ary sum.
    pub fn sum<'g>(&'g self, terms: impl IntoIterator<Item = Expr<'g>>) -> Expr<'g> {
        let atoms: Vec<(Atom, Number)> = terms.into_iter().map(|x| (x.atom_in(self), Number::ONE)).collect();
        self.build(|dag| dag.sum_of(&atoms))
    }

    /// Σ xᵢ yᵢ as one n-ary sum.
    ///
    /// The longer of the two sequences is cut to the length of the other.
    pub fn dot<'g>(
        &'g self,
        x: impl IntoIterator<Item = Expr<'g>>,
        y: impl IntoIterator<Item = Expr<'g>>,
    ) -> Expr<'g> {
        self.sum(x.into_iter().zip(y).map(|(x, y)| x * y))
    }

    /// ∂`output`/∂`symbol` for each of `symbols`, by one reverse sweep.
    ///
    /// # Panics
    /// If one of `symbols` is not a symbol.
    pub fn gradient<'g>(&'g self, output: Expr<'g>, symbols: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let nodes: Vec<NodeId> = symbols.iter().map(|s| s.symbol_in(self)).collect();
        let output = output.atom_in(self);
        self.build_all(|dag| dag.gradient(output, &nodes))
    }

    /// The rates of change of `outputs` when each symbol of `rates` changes at the rate beside it: one forward sweep.
    ///
    /// # Panics
    /// If the first of a pair is not a symbol.
    pub fn directional<'g>(&'g self, outputs: &[Expr<'g>], rates: &[(Expr<'g>, Expr<'g>)]) -> Vec<Expr<'g>> {
        let seeds: Vec<(NodeId, Atom)> =
            rates.iter().map(|(symbol, rate)| (symbol.symbol_in(self), rate.atom_in(self))).collect();
        let outputs: Vec<Atom> = outputs.iter().map(|x| x.atom_in(self)).collect();
        self.build_all(|dag| dag.directional(&outputs, &seeds))
    }

    /// `outputs` with each symbol of `replacements` replaced by the expression beside it, all at once.
    ///
    /// A symbol that was replaced is in the results only where it is in the expressions put in.
    ///
    /// # Panics
    /// If the first of a pair is not a symbol.
    pub fn substitute<'g>(
        &'g self,
        outputs: &[Expr<'g>],
        replacements: &[(Expr<'g>, Expr<'g>)],
    ) -> Vec<Expr<'g>> {
        let pairs: Vec<(NodeId, Atom)> = replacements
            .iter()
            .map(|(symbol, value)| (symbol.symbol_in(self), value.atom_in(self)))
            .collect();
        let outputs: Vec<Atom> = outputs.iter().map(|x| x.atom_in(self)).collect();
        let mut results = self.build_all(|dag| dag.substitute(&outputs, &pairs));
        if self.folding() == Folding::ByValue {
            self.drop_returned(&mut results, replacements);
        }
        results
    }

    /// Writes results of a substitution without the symbols that it replaced.
    ///
    /// Such a symbol comes back where it cancels: the result then has the value of an older and cheaper expression
    /// that is written with it.
    fn drop_returned<'g>(&'g self, results: &mut [Expr<'g>], replacements: &[(Expr<'g>, Expr<'g>)]) {
        let mut returned = self.symbols_of(results);
        returned.retain(|symbol| replacements.iter().any(|(replaced, _)| replaced == symbol));
        if returned.is_empty() {
            return;
        }
        let put_in = self.symbols_of(&replacements.iter().map(|&(_, value)| value).collect::<Vec<_>>());
        for symbol in returned.into_iter().filter(|symbol| !put_in.contains(symbol)) {
            for result in results.iter_mut().filter(|result| self.symbols_of(&[**result]).contains(&symbol)) {
                *result = self.without_symbol(*result, symbol);
            }
        }
    }

    /// The names of the symbols that `outputs` contain, in order of their making.
    pub fn symbols_of<'g>(&'g self, outputs: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let atoms: Vec<Atom> = outputs.iter().map(|x| x.atom_in(self)).collect();
        let nodes: Vec<NodeId> = self.with(|dag| {
            let cone = Cone::below(dag, atoms);
            cone.order.into_iter().filter(|&node| matches!(dag.node(node), Node::Symbol(_))).collect()
        });
        nodes.into_iter().map(|node| self.expr(Atom::Node(node))).collect()
    }

    /// Whether a function of which `which` holds is applied to something that is written with one of the `symbols`.
    ///
    /// ```
    /// # use pc_expr::{Function, Graph};
    /// let graph = Graph::new();
    /// let [x, y] = graph.symbols(["x", "y"]);
    /// assert!(graph.applies(x + y.abs(), &[y], |f| !f.is_smooth()));
    /// assert!(!graph.applies(x + y.abs(), &[x], |f| !f.is_smooth()));
    /// ```
    pub fn applies<'g>(
        &'g self,
        value: Expr<'g>,
        symbols: &[Expr<'g>],
        which: impl Fn(Function) -> bool,
    ) -> bool {
        self.finds(
            value,
            symbols,
            |dag, _, node| matches!(dag.node(node), Node::Call { function, .. } if which(function)),
        )
    }

    /// Whether fingerprints decide every identity between the values: no constant in them is rounded, and no function is
    /// applied but sine, cosine and the exponential, circular and hyperbolic.
    ///
    /// ```
    /// # use pc_expr::Graph;
    /// let graph = Graph::new();
    /// let [x, y] = graph.symbols(["x", "y"]);
    /// assert!(graph.is_decidable(&[x.sin() / y + 0.1]));
    /// assert!(!graph.is_decidable(&[x, y.sqrt()]) && !graph.is_decidable(&[2f64.sqrt() * x]));
    /// ```
    pub fn is_decidable<'g>(&'g self, values: &[Expr<'g>]) -> bool {
        let rounded = |c: Number| matches!(c, Number::Real(_));
        let roots: Vec<Atom> = values.iter().map(|value| value.atom_in(self)).collect();
        if roots.iter().any(|root| matches!(root, Atom::Constant(c) if rounded(*c))) {
            return false;
        }
        self.with(|dag| {
            let cone = Cone::below(dag, roots);
            cone.order.iter().all(|&node| match dag.node(node) {
                Node::Constant(c) => !rounded(c),
                Node::Symbol(_) | Node::Product { .. } => true,
                Node::Sum { constant, terms } => {
                    !rounded(constant) && dag.terms(terms).iter().all(|&(_, q)| !rounded(q))
                }
                Node::Call { function, .. } => matches!(
                    function,
                    Function::Sin
                        | Function::Cos
                        | Function::Exp
                        | Function::Sinh
                        | Function::Cosh
                        | Function::Tanh
                ),
            })
        })
    }

    /// Whether something that is written with one of the `symbols` stands in a divisor.
    ///
    /// ```
    /// # use pc_expr::Graph;
    /// let graph = Graph::new();
    /// let [x, y] = graph.symbols(["x", "y"]);
    /// assert!(graph.divides_by(x / (y + 1.0), &[y]));
    /// assert!(!graph.divides_by(x / (y + 1.0), &[x]));
    /// ```
    pub fn divides_by<'g>(&'g self, value: Expr<'g>, symbols: &[Expr<'g>]) -> bool {
        self.finds(value, symbols, |dag, moving, node| {
            let Node::Product { factors } = dag.node(node) else { return false };
            dag.factors(factors).iter().any(|(child, exponent)| *exponent < 0 && moving.contains(child))
        })
    }

    /// Whether a node of the value that depends on one of the symbols is one; it is told all those.
    fn finds<'g>(
        &'g self,
        value: Expr<'g>,
        symbols: &[Expr<'g>],
        is_one: impl Fn(&Dag, &FxHashSet<NodeId>, NodeId) -> bool,
    ) -> bool {
        let root = value.atom_in(self);
        let symbols: Vec<NodeId> = symbols.iter().map(|s| s.symbol_in(self)).collect();
        self.with(|dag| {
            let cone = Cone::below(dag, [root]);
            let moving = cone.depending_on(dag, &symbols);
            cone.order.iter().any(|&node| moving.contains(&node) && is_one(dag, &moving, node))
        })
    }

    /// The values of `outputs`, over any scalar, when the symbols have the values given.
    ///
    /// # Errors
    /// [`ExprError::UnboundSymbol`] for a symbol without a value.
    pub fn evaluate<'g, S: Scalar>(
        &'g self,
        outputs: &[Expr<'g>],
        values: &[(Expr<'g>, S)],
    ) -> Result<Vec<S>, ExprError> {
        let outputs: Vec<Atom> = outputs.iter().map(|x| x.atom_in(self)).collect();
        let values: Vec<(NodeId, S)> = values.iter().map(|(s, value)| (s.symbol_in(self), *value)).collect();
        self.with(|dag| evaluate(dag, &outputs, &values))
    }

    pub(crate) fn with<R>(&self, f: impl FnOnce(&mut Dag) -> R) -> R {
        f(&mut self.dag.borrow_mut())
    }

    pub(crate) fn expr(&self, atom: Atom) -> Expr<'_> {
        Expr::new(self, atom)
    }

    pub(crate) fn build(&self, f: impl FnOnce(&mut Dag) -> Atom) -> Expr<'_> {
        self.expr(self.with(f))
    }

    pub(crate) fn build_all(&self, f: impl FnOnce(&mut Dag) -> Vec<Atom>) -> Vec<Expr<'_>> {
        self.with(f).into_iter().map(|atom| self.expr(atom)).collect()
    }
}

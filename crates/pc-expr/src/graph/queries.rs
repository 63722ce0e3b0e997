//! Questions about whole expressions.

use rustc_hash::FxHashSet;

use crate::error::ExprError;
use crate::graph::dag::Dag;
use crate::graph::expr::Expr;
use crate::graph::function::Function;
use crate::graph::graph::Graph;
use crate::graph::node::{Atom, Node, NodeId};
use crate::graph::number::Number;
use crate::graph::subgraph::Cone;

impl Graph {
    /// Checks that all expressions are defined.
    ///
    /// # Errors
    /// If not, [`ExprError::DivisionByZero`] with the dividend of the first division by an expression that is
    /// identically zero, or [`ExprError::Undefined`] if there was no such division; [`ExprError::Spent`] if
    /// the budget is spent.
    pub fn check<'g>(&'g self, expressions: &[Expr<'g>]) -> Result<(), ExprError> {
        self.check_budget()?;
        if !expressions.iter().any(|x| x.is_undefined()) {
            return Ok(());
        }
        match self.with(|dag| dag.zero_divisions().first().copied()) {
            None => Err(ExprError::Undefined),
            Some(atom) => Err(ExprError::DivisionByZero { dividend: self.expr(atom).to_string() }),
        }
    }

    /// The expression x, kept as a unit in all sums and products made from it from now on. This suits the
    /// result of a step in a recursion if it is to be computed only once. Otherwise a sum of sums becomes
    /// one sum, which is shorter to read but takes longer to compute.
    ///
    /// ```
    /// # use pc_expr::Graph;
    /// let graph = Graph::new();
    /// let [a, b, c] = graph.symbols(["a", "b", "c"]);
    /// let step = graph.keep(a - b);
    /// assert_eq!(graph.size(&[step + c]), 5); // a, b, a − b, c and the sum; without `keep` a sum of three terms
    /// assert_eq!(step + c, a + c - b); // the values are equal nevertheless
    /// ```
    pub fn keep<'g>(&'g self, x: Expr<'g>) -> Expr<'g> {
        let atom = x.atom_in(self);
        self.build(|dag| {
            dag.keep(atom);
            atom
        })
    }

    /// √x, kept as a root if x is a number that is not a square, so that its square is x.
    ///
    /// ```
    /// # use pc_expr::Graph;
    /// let graph = Graph::new();
    /// let root = graph.exact_root(1.02.into());
    /// assert_eq!(root.to_string(), "sqrt(1.02)");
    /// assert_eq!(root * root, 1.02.into());
    /// ```
    pub fn exact_root<'g>(&'g self, x: Expr<'g>) -> Expr<'g> {
        let x = x.atom_in(self);
        self.build(|dag| dag.exact_root(x))
    }

    /// The number of different nodes in the expressions: roughly their length when each node is written once.
    pub fn size<'g>(&'g self, expressions: &[Expr<'g>]) -> usize {
        let roots: Vec<Atom> = expressions.iter().map(|expression| expression.atom_in(self)).collect();
        self.with(|dag| Cone::below(dag, roots).order.len())
    }

    /// The factors of a product with their exponents, without its numerical factor; the expression itself if
    /// it is not a product.
    ///
    /// ```
    /// # use pc_expr::Graph;
    /// let graph = Graph::new();
    /// let [x, m] = graph.symbols(["x", "m"]);
    /// let mut factors = graph.factors(-2.0 * m * (x + m).square());
    /// factors.sort_by_key(|&(_, exponent)| exponent);
    /// assert_eq!(factors, [(m, 1), (x + m, 2)]);
    /// ```
    pub fn factors<'g>(&'g self, product: Expr<'g>) -> Vec<(Expr<'g>, i32)> {
        let product = (product * product.numerical_factor().recip()).atom_in(self);
        let factors = self.with(|dag| match product {
            Atom::Constant(_) => Vec::new(),
            Atom::Node(node) => match dag.node(node) {
                Node::Product { factors } => dag.factors(factors).to_vec(),
                _ => vec![(node, 1)],
            },
        });
        factors.into_iter().map(|(node, exponent)| (self.expr(Atom::Node(node)), exponent)).collect()
    }

    /// The symbols in `outputs`, in order of creation.
    pub fn symbols_of<'g>(&'g self, outputs: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let atoms: Vec<Atom> = outputs.iter().map(|x| x.atom_in(self)).collect();
        let nodes: Vec<NodeId> = self.with(|dag| {
            let cone = Cone::below(dag, atoms);
            cone.order.into_iter().filter(|&node| matches!(dag.node(node), Node::Symbol(_))).collect()
        });
        nodes.into_iter().map(|node| self.expr(Atom::Node(node))).collect()
    }

    /// For each of the expressions, whether it contains no symbols but these; one pass decides this for all
    /// of them.
    ///
    /// ```
    /// # use pc_expr::Graph;
    /// let graph = Graph::new();
    /// let [x, m, l] = graph.symbols(["x", "m", "l"]);
    /// assert_eq!(graph.are_made_of(&[m * l, x - m, 2.into()], &[m, l]), [true, false, true]);
    /// ```
    pub fn are_made_of<'g>(&'g self, expressions: &[Expr<'g>], symbols: &[Expr<'g>]) -> Vec<bool> {
        let roots: Vec<Atom> = expressions.iter().map(|x| x.atom_in(self)).collect();
        let symbols: FxHashSet<NodeId> = symbols.iter().map(|s| s.symbol_in(self)).collect();
        self.with(|dag| {
            let cone = Cone::below(dag, roots.iter().copied());
            let is_other =
                |&node: &NodeId| matches!(dag.node(node), Node::Symbol(_)) && !symbols.contains(&node);
            let others: Vec<NodeId> = cone.order.iter().copied().filter(is_other).collect();
            let moving = cone.depending_on(dag, &others);
            let is_moving = |root: &Atom| matches!(root, Atom::Node(node) if moving.contains(node));
            roots.iter().map(|root| !is_moving(root)).collect()
        })
    }

    /// Whether a function that satisfies `which` is applied to an expression that contains one of the `symbols`.
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

    /// Whether fingerprints decide every identity between the values: no constant in them is rounded, and the
    /// only functions are the exponential and the circular or hyperbolic sine and cosine.
    ///
    /// ```
    /// # use pc_expr::Graph;
    /// let graph = Graph::new();
    /// let [x, y] = graph.symbols(["x", "y"]);
    /// assert!(graph.is_decidable(&[x.sin() / y + 0.1]));
    /// assert!(!graph.is_decidable(&[x, y.sqrt()]) && !graph.is_decidable(&[2f64.sqrt() * x]));
    /// ```
    pub fn is_decidable<'g>(&'g self, values: &[Expr<'g>]) -> bool {
        let rounded = Number::is_rounded;
        let roots: Vec<Atom> = values.iter().map(|value| value.atom_in(self)).collect();
        if roots.iter().any(|root| matches!(root, Atom::Constant(c) if rounded(*c))) {
            return false;
        }
        self.with(|dag| {
            let cone = Cone::below(dag, roots);
            cone.order.iter().all(|&node| match dag.node(node) {
                Node::Constant(c) => !rounded(c),
                Node::Symbol(_) | Node::Product { .. } | Node::Applied { .. } => true,
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

    /// Whether a divisor contains one of the `symbols`.
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

    /// Whether `is_one` holds for some node of the value that depends on one of the symbols; `is_one` is also
    /// passed the set of all such nodes.
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
}

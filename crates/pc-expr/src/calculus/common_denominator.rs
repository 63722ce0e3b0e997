//! The divisors in an expression.

use rustc_hash::FxHashMap;

use crate::graph::dag::Dag;
use crate::graph::expr::Expr;
use crate::graph::graph::Graph;
use crate::graph::node::{Atom, Node, NodeId};
use crate::graph::subgraph::Cone;

/// Divisors with their exponents.
type Powers = FxHashMap<NodeId, i32>;

impl Graph {
    /// A product D of the divisors of e outside the arguments of functions such that e D has no divisors but those
    /// inside these divisors.
    ///
    /// D does not vanish where e has a value.
    ///
    /// ```
    /// use pc_expr::Graph;
    /// let graph = Graph::new();
    /// let [x, y] = graph.symbols(["x", "y"]);
    /// assert_eq!(graph.common_denominator(x * (1.0 / y + y / x.square()) / (x + y)), y * x.square() * (x + y));
    /// ```
    pub fn common_denominator<'g>(&'g self, e: Expr<'g>) -> Expr<'g> {
        let Atom::Node(root) = e.atom_in(self) else { return Expr::ONE };
        let mut divisors: Vec<(NodeId, i32)> =
            self.with(|dag| dag.divisors_below(root)).into_iter().collect();
        divisors.sort_unstable();
        let power = |(node, exponent): (NodeId, i32)| self.expr(Atom::Node(node)).powi(exponent);
        divisors.into_iter().map(power).fold(Expr::ONE, |product, power| product * power)
    }
}

impl Dag {
    fn divisors_below(&self, root: NodeId) -> Powers {
        let mut known: FxHashMap<NodeId, Powers> = FxHashMap::default();
        for &node in &Cone::below(self, [Atom::Node(root)]).order {
            let mut powers = Powers::default();
            match self.node(node) {
                Node::Sum { terms, .. } => {
                    for (child, _) in self.terms(terms) {
                        for (&divisor, &exponent) in known.get(child).into_iter().flatten() {
                            let most = powers.entry(divisor).or_default();
                            *most = exponent.max(*most);
                        }
                    }
                }
                Node::Product { factors } => {
                    for &(child, exponent) in self.factors(factors) {
                        if exponent < 0 {
                            *powers.entry(child).or_default() -= exponent;
                            continue;
                        }
                        for (&divisor, &of) in known.get(&child).into_iter().flatten() {
                            *powers.entry(divisor).or_default() += of * exponent;
                        }
                    }
                }
                Node::Constant(_) | Node::Symbol(_) | Node::Call { .. } | Node::Applied { .. } => {}
            }
            known.insert(node, powers);
        }
        known.remove(&root).unwrap_or_default()
    }
}

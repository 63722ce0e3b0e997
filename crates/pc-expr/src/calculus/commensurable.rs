//! Terms that have the same dimension, whatever the units of the symbols.

use crate::graph::dag::Dag;
use crate::graph::expr::Expr;
use crate::graph::function::Function;
use crate::graph::graph::Graph;
use crate::graph::node::{Atom, Node, NodeId};
use crate::graph::number::Number;
use crate::graph::subgraph::Cone;

impl Graph {
    /// Groups of terms q f, as pairs (q, f), that have the same dimension in any physically meaningful expression: the
    /// terms of each sum, the arguments of `atan2`, `min` and `max`, and the arguments of sines, exponentials, logarithms
    /// and similar functions, each with the number 1.
    ///
    /// If the units are chosen such that the symbols are of order one, the terms of a group have the same
    /// order of magnitude.
    ///
    /// ```
    /// # use pc_expr::{Expr, Graph};
    /// let graph = Graph::new();
    /// let x = graph.symbol("x");
    /// let groups = graph.commensurable(&[(1e7 * x).sin()]);
    /// assert_eq!(groups, [[(1.0, Expr::ONE), (1.0, 1e7 * x)]]);
    /// assert_eq!(graph.commensurable(&[2.0 * x.square() + 3.0]), [[(3.0, Expr::ONE), (2.0, x.square())]]);
    /// ```
    pub fn commensurable<'g>(&'g self, values: &[Expr<'g>]) -> Vec<Vec<(f64, Expr<'g>)>> {
        let roots: Vec<Atom> = values.iter().map(|value| value.atom_in(self)).collect();
        let groups = self.with(|dag| {
            let cone = Cone::below(dag, roots);
            let groups = cone.order.iter().map(|&node| dag.commensurable(node));
            groups.filter(|group| group.len() > 1).collect::<Vec<_>>()
        });
        let term = |(q, atom): (f64, Atom)| (q, self.expr(atom));
        groups.into_iter().map(|group| group.into_iter().map(term).collect()).collect()
    }
}

impl Dag {
    fn commensurable(&self, node: NodeId) -> Vec<(f64, Atom)> {
        let one = (1.0, Atom::Constant(Number::ONE));
        let argument = |node: NodeId| (1.0, Atom::Node(node));
        match self.node(node) {
            Node::Sum { constant, terms } => {
                let number = (!constant.is_zero()).then(|| (constant.to_f64(), one.1));
                let terms = self.terms(terms).iter().map(|&(child, q)| (q.to_f64(), Atom::Node(child)));
                number.into_iter().chain(terms).collect()
            }
            Node::Call { function, ref args } => match function {
                Function::Sqrt | Function::Abs | Function::Sign | Function::Step => Vec::new(),
                Function::Atan2 | Function::Min | Function::Max => {
                    Dag::args(function, args).iter().copied().map(argument).collect()
                }
                Function::Pow => vec![one, argument(args[1])],
                Function::Sin
                | Function::Cos
                | Function::Asin
                | Function::Acos
                | Function::Atan
                | Function::Sinh
                | Function::Cosh
                | Function::Tanh
                | Function::Exp
                | Function::Log => vec![one, argument(args[0])],
            },
            Node::Constant(_) | Node::Symbol(_) | Node::Product { .. } | Node::Applied { .. } => Vec::new(),
        }
    }
}

//! Surfaces on which piecewise functions change from one piece to the next.

use crate::graph::dag::Dag;
use crate::graph::expr::Expr;
use crate::graph::function::Function;
use crate::graph::graph::Graph;
use crate::graph::node::{Atom, Node, NodeId};
use crate::graph::number::Number;
use crate::graph::subgraph::Cone;

/// A surface on which a `step` or a `sign` in an expression changes its value.
#[derive(Clone, Copy, Debug)]
pub struct Break<'g> {
    /// A function that changes sign on the surface.
    pub surface: Expr<'g>,
    /// The form of the expression where this function is positive.
    pub above: Expr<'g>,
    /// The form of the expression where this function is negative.
    pub below: Expr<'g>,
}

impl Graph {
    /// The surfaces on which an expression may jump, except those of `atan2`, whose values are angles.
    ///
    /// ```
    /// # use pc_expr::Graph;
    /// let graph = Graph::new();
    /// let [x, k] = graph.symbols(["x", "k"]);
    /// let stop = (x - 1.0).step(k * (x - 1.0), 0.0); // the force of a spring, from x = 1
    /// let [found] = graph.breaks(x * stop)[..] else { unreachable!("one step") };
    /// assert_eq!([found.surface, found.above, found.below], [x - 1.0, x * (k * (x - 1.0)), 0.0.into()]);
    /// ```
    pub fn breaks<'g>(&'g self, value: Expr<'g>) -> Vec<Break<'g>> {
        let root = value.atom_in(self);
        let found = self.with(|dag| {
            let pieces = |&node: &NodeId| dag.pieces(node).map(|pieces| (node, pieces));
            Cone::below(dag, [root]).order.iter().filter_map(pieces).collect::<Vec<_>>()
        });
        let side = |node: NodeId, piece: Atom| self.build(|dag| dag.substitute(&[root], &[(node, piece)])[0]);
        let side = |(node, [surface, above, below]): (NodeId, [Atom; 3])| Break {
            surface: self.expr(surface),
            above: side(node, above),
            below: side(node, below),
        };
        found.into_iter().map(side).collect()
    }
}

impl Dag {
    /// The surface of a node that has two pieces, followed by the two pieces.
    fn pieces(&self, node: NodeId) -> Option<[Atom; 3]> {
        match self.node(node) {
            Node::Call { function: Function::Step, args } => {
                Some(args.map(|arg| self.constant_of(Atom::Node(arg))))
            }
            Node::Call { function: Function::Sign, args: [surface, ..] } => {
                Some([Atom::Node(surface), Atom::ONE, Atom::Constant(-Number::ONE)])
            }
            _ => None,
        }
    }
}

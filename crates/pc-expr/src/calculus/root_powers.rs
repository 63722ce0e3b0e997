//! Powers of roots, created so that later expressions with the same value are recognised as such powers.

use crate::graph::expr::Expr;
use crate::graph::function::Function;
use crate::graph::graph::Graph;
use crate::graph::node::{Atom, Node};
use crate::graph::number::Number;
use crate::graph::subgraph::Cone;

/// The highest p in the powers w^(p/2).
const HIGHEST: i32 = 6;

impl Graph {
    /// Creates the powers w^(p/2), |p| ≤ 6, of the radicands w of all square roots in the given expressions.
    /// An expression built later with the value of such a power becomes that power, which is the shorter
    /// form. Returns whether the expressions contain square roots.
    ///
    /// ```
    /// # use pc_expr::Graph;
    /// let graph = Graph::new();
    /// let [u, v] = graph.symbols(["u", "v"]);
    /// let w = 1.0 - u.square() - v.square();
    /// assert!(graph.know_root_powers(&[w.sqrt()]));
    /// let hessian = [1.0 / w + u.square() / w.powi(2), u * v / w.powi(2), 1.0 / w + v.square() / w.powi(2)];
    /// assert_eq!(hessian[0] * hessian[2] - hessian[1].square(), w.powi(-3));
    /// ```
    pub fn know_root_powers(&self, expressions: &[Expr<'_>]) -> bool {
        let outputs: Vec<Atom> = expressions.iter().map(|expression| expression.atom_in(self)).collect();
        self.with(|dag| {
            let is_root = |&&node: &&_| matches!(dag.node(node), Node::Call { function: Function::Sqrt, .. });
            let cone = Cone::below(dag, outputs);
            let roots: Vec<_> = cone.order.iter().filter(is_root).copied().collect();
            for &root in &roots {
                for e in 1..=HIGHEST {
                    dag.product(Number::ONE, &[(root, e)]);
                    dag.product(Number::ONE, &[(root, -e)]);
                }
            }
            !roots.is_empty()
        })
    }
}

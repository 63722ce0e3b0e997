//! Where piecewise functions change from one piece to the next.

use crate::graph::dag::Dag;
use crate::graph::expr::Expr;
use crate::graph::function::Function;
use crate::graph::graph::Graph;
use crate::graph::node::{Atom, Node, NodeId};
use crate::graph::subgraph::Cone;

impl Graph {
    /// Functions at whose zeros finite values may jump: those at which `step`, `sign`, `abs`, `min`, `max`,
    /// `atan2` and roots of squares change to another piece, and the divisors inside functions that stay bounded at a
    /// pole, as in atan(1/x). In most cases the values do not jump there: abs(x) does not, but x/abs(x) does.
    ///
    /// ```
    /// # use pc_expr::Graph;
    /// let graph = Graph::new();
    /// let [x, y] = graph.symbols(["x", "y"]);
    /// assert_eq!(graph.seams(&[x.abs() * y, (x - 1.0).step(y, 0.0)]), [x, x - 1.0]);
    /// assert_eq!(graph.seams(&[x / (y + 1.0)]), []);
    /// assert_eq!(graph.seams(&[(x / (y + 1.0)).atan()]), [y + 1.0]);
    /// ```
    pub fn seams<'g>(&'g self, values: &[Expr<'g>]) -> Vec<Expr<'g>> {
        let roots: Vec<Atom> = values.iter().map(|value| value.atom_in(self)).collect();
        let seams = self.with(|dag| {
            let cone = Cone::below(dag, roots);
            let bounded: Vec<Atom> = cone.order.iter().flat_map(|&node| dag.bounded(node)).collect();
            let bounded = Cone::below(dag, bounded);
            let poles = bounded.order.iter().flat_map(|&node| dag.divisors_in(node)).map(Seam::Zero);
            cone.order.iter().flat_map(|&node| dag.seams_of(node)).chain(poles).collect::<Vec<Seam>>()
        });
        let expr = |node: NodeId| self.expr(Atom::Node(node));
        let mut all: Vec<Expr<'g>> = Vec::new();
        for seam in seams {
            let function = match seam {
                Seam::Zero(node) => expr(node),
                Seam::Equal(a, b) => expr(a) - expr(b),
            };
            if function.constant().is_none() && !all.contains(&function) {
                all.push(function);
            }
        }
        all
    }
}

/// Where a node changes to another piece.
enum Seam {
    /// Where an argument vanishes.
    Zero(NodeId),
    /// Where two arguments are equal.
    Equal(NodeId, NodeId),
}

impl Dag {
    fn seams_of(&self, node: NodeId) -> Vec<Seam> {
        let Node::Call { function, args } = self.node(node) else { return Vec::new() };
        match function {
            Function::Step | Function::Sign | Function::Abs | Function::Atan2 => vec![Seam::Zero(args[0])],
            Function::Min | Function::Max => vec![Seam::Equal(args[0], args[1])],
            Function::Sqrt => self.squared(args[0]).into_iter().map(Seam::Zero).collect(),
            _ => Vec::new(),
        }
    }

    /// The factors of a product in which every exponent is even.
    fn squared(&self, node: NodeId) -> Vec<NodeId> {
        let Node::Product { factors } = self.node(node) else { return Vec::new() };
        let factors = self.factors(factors);
        let is_square = factors.iter().all(|(_, exponent)| exponent % 2 == 0);
        factors.iter().filter(|_| is_square).map(|&(factor, _)| factor).collect()
    }

    fn divisors_in(&self, node: NodeId) -> Vec<NodeId> {
        let Node::Product { factors } = self.node(node) else { return Vec::new() };
        let divisors = self.factors(factors).iter().filter(|(_, exponent)| *exponent < 0);
        divisors.map(|&(divisor, _)| divisor).collect()
    }

    /// The arguments of a function that stays finite where its arguments have a pole.
    fn bounded(&self, node: NodeId) -> Vec<Atom> {
        match self.node(node) {
            Node::Call { function: Function::Atan | Function::Tanh | Function::Exp, args } => {
                vec![Atom::Node(args[0])]
            }
            Node::Call { function: Function::Atan2 | Function::Min | Function::Max, args } => {
                vec![Atom::Node(args[0]), Atom::Node(args[1])]
            }
            _ => Vec::new(),
        }
    }
}

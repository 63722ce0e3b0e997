//! Expressions written in another graph.

use std::cell::RefCell;

use rustc_hash::FxHashMap;

use crate::graph::dag::Dag;
use crate::graph::expr::Expr;
use crate::graph::graph::Graph;
use crate::graph::node::{Atom, Node, NodeId};
use crate::graph::number::Number;

/// Writes expressions of one graph in another, with symbols that have the same names.
///
/// The order of operands in a graph, and with it the last digits of values, depends on what was built in
/// the graph before. In an empty graph the order depends only on the expressions and the sequence in which
/// they are written.
///
/// ```
/// # use pc_expr::{Graph, Transcription};
/// let (graph, other) = (Graph::new(), Graph::new());
/// let [a, b] = graph.symbols(["a", "b"]);
/// let copy = Transcription::new(&graph, &other);
/// assert_eq!(copy.write(a - b.sin()).to_string(), "a - sin(b)");
/// ```
#[derive(Debug)]
pub struct Transcription<'g, 'n> {
    from: &'g Graph,
    to: &'n Graph,
    written: RefCell<FxHashMap<NodeId, Atom>>,
}

impl<'g, 'n> Transcription<'g, 'n> {
    /// A transcription from one graph to another.
    ///
    /// # Panics
    /// If both are the same graph.
    pub fn new(from: &'g Graph, to: &'n Graph) -> Transcription<'g, 'n> {
        assert!(!std::ptr::addr_eq(from, to), "two graphs");
        Transcription { from, to, written: RefCell::default() }
    }

    /// The expression in the other graph; nodes [kept](Graph::keep) as units are also kept as units there.
    pub fn write(&self, x: Expr<'g>) -> Expr<'n> {
        let root = match x.atom_in(self.from) {
            constant @ Atom::Constant(_) => return self.to.expr(constant),
            Atom::Node(node) => node,
        };
        let mut written = self.written.borrow_mut();
        let atom = self.from.with(|source| self.to.with(|target| write(source, target, root, &mut written)));
        self.to.expr(atom)
    }
}

/// Writes a node, children first, in an order that does not depend on the indices of the nodes.
fn write(source: &Dag, target: &mut Dag, root: NodeId, written: &mut FxHashMap<NodeId, Atom>) -> Atom {
    let mut open = vec![(root, false)];
    while let Some((node, children_done)) = open.pop() {
        if written.contains_key(&node) {
            continue;
        }
        if children_done {
            let atom = written_node(source, target, node, written);
            if source.is_kept(node) {
                target.keep(atom);
            }
            written.insert(node, atom);
            continue;
        }
        open.push((node, true));
        let first = open.len();
        source.for_each_child(node, |child| open.push((child, false)));
        // The last one is written first. Arguments of a call keep their order in any case.
        open[first..].sort_by_key(|&(child, _)| source.fingerprint(child).up_to_sign());
    }
    written[&root]
}

fn written_node(source: &Dag, target: &mut Dag, node: NodeId, written: &FxHashMap<NodeId, Atom>) -> Atom {
    match source.node(node) {
        Node::Constant(c) => Atom::Constant(c),
        Node::Symbol(index) => Atom::Node(target.symbol(source.symbol_name(index))),
        Node::Call { function, args } => {
            let args: Vec<Atom> = Dag::args(function, &args).iter().map(|arg| written[arg]).collect();
            // A call of numbers is kept: it was not evaluated, on purpose.
            match args.iter().all(|arg| matches!(arg, Atom::Constant(_))) {
                true => target.call_unfolded(function, &args),
                false => target.call(function, &args),
            }
        }
        Node::Applied { function, args } => {
            let args: Vec<Atom> = function.args(&args).iter().map(|arg| written[arg]).collect();
            target.applied_as(source, function, &args)
        }
        Node::Product { factors } => {
            let factors = source.factors(factors).iter();
            let powers: Vec<Atom> = factors.map(|(n, e)| target.powi(written[n], *e)).collect();
            target.product_of(Number::ONE, &powers)
        }
        Node::Sum { constant, terms } => {
            let terms = source.terms(terms).iter().map(|(n, q)| (written[n], *q));
            let terms: Vec<(Atom, Number)> = terms.chain([(Atom::Constant(constant), Number::ONE)]).collect();
            target.sum_of(&terms)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The same expressions, built after others and in another order, become the same nodes of an empty
    /// graph.
    #[test]
    fn transcription_does_not_depend_on_earlier_nodes() {
        let names = ["a", "b", "c", "d"];
        let expressions = |graph: &'_ Graph| {
            let [a, b, c, d] = graph.symbols(names);
            [a * b + c * d.sin() - (a / d).sqrt() / 2.0, (b + 3.0 * c) * (a + d) + graph.keep(a - c) + c]
                .map(|x| Transcription::new(graph, &Graph::new()).write(x).to_string())
        };
        let plain = expressions(&Graph::new());
        let graph = Graph::new();
        let [d, c, b, a] = graph.symbols(["d", "c", "b", "a"]);
        let before = [c * d.sin(), a / d, b * a, a + d, 3.0 * c + b];
        assert_eq!(expressions(&graph), plain);
        assert!(before.iter().all(|x| !x.is_zero()));
    }

    #[test]
    fn kept_nodes_stay_closed() {
        let (graph, other) = (Graph::new(), Graph::new());
        let [a, b, c] = graph.symbols(["a", "b", "c"]);
        let sum = graph.keep(a - b) + c;
        assert_eq!(other.size(&[Transcription::new(&graph, &other).write(sum)]), graph.size(&[sum]));
        assert_eq!(graph.size(&[sum]), 5);
    }
}

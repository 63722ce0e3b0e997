//! The approximate length of printed expressions.

use rustc_hash::FxHashMap;

use crate::graph::dag::Dag;
use crate::graph::node::{Atom, Node, NodeId};
use crate::graph::number::Number;

/// A subexpression at this depth is counted as a single name.
const DEPTH: u32 = 5;
const NAME: usize = 3;

impl Dag {
    /// The approximate number of columns of a printed expression.
    pub(super) fn columns(&self, atom: Atom) -> usize {
        match atom {
            Atom::Constant(c) => c.to_string().len(),
            Atom::Node(node) => Columns { dag: self, known: FxHashMap::default() }.of(node, DEPTH),
        }
    }
}

/// The number of columns of each node at each depth: a node that occurs many times is measured once for each
/// depth.
struct Columns<'d> {
    dag: &'d Dag,
    known: FxHashMap<(NodeId, u32), usize>,
}

impl Columns<'_> {
    fn of(&mut self, node: NodeId, depth: u32) -> usize {
        if depth == 0 {
            return NAME;
        }
        if let Some(known) = self.known.get(&(node, depth)) {
            return *known;
        }
        let columns = self.counted(node, depth);
        self.known.insert((node, depth), columns);
        columns
    }

    fn counted(&mut self, node: NodeId, depth: u32) -> usize {
        let dag = self.dag;
        let is_sum = |node: NodeId| matches!(dag.node(node), Node::Sum { .. });
        match dag.node(node) {
            Node::Constant(c) => c.to_string().len(),
            Node::Symbol(index) => dag.symbol_name(index).chars().count(),
            Node::Call { function, args } => {
                let args = Dag::args(function, &args).iter();
                function.name().len() + args.map(|&arg| self.of(arg, depth - 1) + 2).sum::<usize>()
            }
            Node::Applied { function, args } => {
                let name = function.text(dag.function_name(function), &[]).chars().count();
                let args = function.args(&args).iter();
                name + args.map(|&arg| self.of(arg, depth - 1) + 2).sum::<usize>()
            }
            Node::Product { factors } => {
                let factor = |&(node, e): &(NodeId, i32)| {
                    let brackets = if is_sum(node) { 2 } else { 0 };
                    self.of(node, depth - 1) + 1 + brackets + usize::from(e.unsigned_abs() > 1)
                };
                dag.factors(factors).iter().map(factor).sum()
            }
            Node::Sum { constant, terms } => {
                let term = |&(node, q): &(NodeId, Number)| {
                    let coefficient = match q.abs().is_one() {
                        true => 0,
                        false => q.abs().to_string().len() + if is_sum(node) { 3 } else { 1 },
                    };
                    self.of(node, depth - 1) + coefficient + 3
                };
                let constant = if constant.is_zero() { 0 } else { constant.to_string().len() + 3 };
                dag.terms(terms).iter().map(term).sum::<usize>() + constant
            }
        }
    }
}

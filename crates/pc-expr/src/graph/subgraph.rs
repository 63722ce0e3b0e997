//! The nodes that some expressions depend on, in topological order.

use rustc_hash::{FxHashMap, FxHashSet};

use crate::graph::dag::Dag;
use crate::graph::node::{Atom, NodeId};

/// The sub-graph below some roots: children before parents.
pub(crate) struct Cone {
    pub(crate) order: Vec<NodeId>,
}

impl Dag {
    /// The nodes below `roots`, each counted as work; `None` once the budget is spent.
    pub(crate) fn cone_within_budget(&mut self, roots: impl IntoIterator<Item = Atom>) -> Option<Cone> {
        if self.is_spent(1) {
            return None;
        }
        let cone = Cone::below(self, roots);
        (!self.is_spent(cone.order.len())).then_some(cone)
    }
}

impl Cone {
    /// All nodes below `roots`, found without recursion, so that no depth of nesting overflows the stack.
    pub(crate) fn below(dag: &Dag, roots: impl IntoIterator<Item = Atom>) -> Cone {
        // One bit for each node of the graph is cheaper than a hash set.
        let mut seen = vec![0_u64; dag.len() / 64 + 1];
        let mut open: Vec<NodeId> = Vec::new();
        let mut order = Vec::new();
        let mut reach = |node: NodeId, open: &mut Vec<NodeId>| {
            let (word, bit) = (&mut seen[node.index() / 64], 1 << (node.index() % 64));
            if *word & bit == 0 {
                *word |= bit;
                open.push(node);
                order.push(node);
            }
        };
        for root in roots {
            if let Atom::Node(node) = root {
                reach(node, &mut open);
            }
        }
        while let Some(node) = open.pop() {
            dag.for_each_child(node, |child| reach(child, &mut open));
        }
        order.sort_unstable(); // children have smaller indices
        Cone { order }
    }

    /// The nodes of the cone that depend on one of `symbols`.
    pub(crate) fn depending_on(&self, dag: &Dag, symbols: &[NodeId]) -> FxHashSet<NodeId> {
        let mut active: FxHashSet<NodeId> = symbols.iter().copied().collect();
        for &node in &self.order {
            let mut depends = false;
            dag.for_each_child(node, |child| depends |= active.contains(&child));
            if depends {
                active.insert(node);
            }
        }
        active
    }

    /// The nodes that `one` picks and that lie above no other such node, with its results for them.
    pub(crate) fn innermost<T>(&self, dag: &Dag, one: impl Fn(NodeId) -> Option<T>) -> Vec<(NodeId, T)> {
        let mut above: FxHashSet<NodeId> = FxHashSet::default();
        let mut found = Vec::new();
        for &node in &self.order {
            let mut is_above = false;
            dag.for_each_child(node, |child| is_above |= above.contains(&child));
            if is_above {
                above.insert(node);
            } else if let Some(what) = one(node) {
                above.insert(node);
                found.push((node, what));
            }
        }
        found
    }
}

/// Values attached to the nodes of a cone; a node without one stands for itself.
#[derive(Default)]
pub(crate) struct Assignment(FxHashMap<NodeId, Atom>);

impl Assignment {
    pub(crate) fn from_pairs(pairs: &[(NodeId, Atom)]) -> Assignment {
        Assignment(pairs.iter().copied().collect())
    }

    pub(crate) fn contains(&self, node: NodeId) -> bool {
        self.0.contains_key(&node)
    }

    pub(crate) fn set(&mut self, node: NodeId, value: Atom) {
        self.0.insert(node, value);
    }

    pub(crate) fn get(&self, node: NodeId) -> Option<Atom> {
        self.0.get(&node).copied()
    }

    pub(crate) fn node(&self, node: NodeId) -> Atom {
        self.get(node).unwrap_or(Atom::Node(node))
    }

    pub(crate) fn atom(&self, atom: Atom) -> Atom {
        match atom {
            Atom::Constant(_) => atom,
            Atom::Node(node) => self.node(node),
        }
    }
}

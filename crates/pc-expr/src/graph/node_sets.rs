//! Sets of nodes: of divisors, of limits, of symbols.

use rustc_hash::FxHashMap;

use crate::graph::node::NodeId;

/// A set of nodes, by its index.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct NodeSet(u32);

impl NodeSet {
    pub(crate) const NONE: NodeSet = NodeSet(0);
    /// A set too large to be kept, taken to hold every node.
    pub(super) const ALL: NodeSet = NodeSet(u32::MAX);
}

/// The sets that occur, each kept once.
#[derive(Debug)]
pub(crate) struct NodeSets {
    /// A set of more nodes counts as the set of all.
    most: usize,
    sets: Vec<Vec<NodeId>>,
    known: FxHashMap<Vec<NodeId>, NodeSet>,
    unions: FxHashMap<(NodeSet, NodeSet), NodeSet>,
}

impl NodeSets {
    /// Sets of up to so many nodes.
    pub(super) fn up_to(most: usize) -> NodeSets {
        NodeSets { most, sets: vec![Vec::new()], known: FxHashMap::default(), unions: FxHashMap::default() }
    }

    pub(super) fn get(&self, set: NodeSet) -> &[NodeId] {
        &self.sets[set.0 as usize]
    }

    /// The set of these nodes, in ascending order and each once.
    pub(super) fn intern(&mut self, nodes: Vec<NodeId>) -> NodeSet {
        if nodes.len() > self.most {
            return NodeSet::ALL;
        }
        let sets = &mut self.sets;
        *self.known.entry(nodes).or_insert_with_key(|nodes| {
            sets.push(nodes.clone());
            NodeSet(sets.len() as u32 - 1)
        })
    }

    pub(super) fn union(&mut self, a: NodeSet, b: NodeSet) -> NodeSet {
        let (a, b) = (a.min(b), a.max(b));
        if a == NodeSet::NONE || b == NodeSet::ALL || a == b {
            return b;
        }
        if let Some(&union) = self.unions.get(&(a, b)) {
            return union;
        }
        let mut nodes = [self.get(a), self.get(b)].concat();
        nodes.sort_unstable();
        nodes.dedup();
        let union = self.intern(nodes);
        self.unions.insert((a, b), union);
        union
    }

    /// Whether each node of the first set is known to be in the second.
    pub(super) fn is_subset(&self, some: NodeSet, others: NodeSet) -> bool {
        if some == NodeSet::NONE {
            return true;
        }
        if some == NodeSet::ALL || others == NodeSet::ALL {
            return false;
        }
        let others = self.get(others);
        self.get(some).iter().all(|node| others.binary_search(node).is_ok())
    }
}

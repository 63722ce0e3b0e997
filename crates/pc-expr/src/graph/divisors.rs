//! Sets of divisors.

use rustc_hash::FxHashMap;

use crate::graph::node::NodeId;

/// A set with more divisors than this counts as the set of all divisors.
const MOST: usize = 64;

/// The index of a set of divisors.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct Divisors(u32);

impl Divisors {
    pub(crate) const NONE: Divisors = Divisors(0);
    /// A set too large to be stored, which is taken to contain every divisor.
    pub(super) const ALL: Divisors = Divisors(u32::MAX);
}

/// The sets that occur, each stored once.
#[derive(Debug)]
pub(crate) struct DivisorSets {
    sets: Vec<Vec<NodeId>>,
    known: FxHashMap<Vec<NodeId>, Divisors>,
    unions: FxHashMap<(Divisors, Divisors), Divisors>,
}

impl Default for DivisorSets {
    fn default() -> DivisorSets {
        DivisorSets { sets: vec![Vec::new()], known: FxHashMap::default(), unions: FxHashMap::default() }
    }
}

impl DivisorSets {
    pub(super) fn get(&self, set: Divisors) -> &[NodeId] {
        &self.sets[set.0 as usize]
    }

    /// The set of these nodes, which are listed in ascending order without repetition.
    pub(super) fn intern(&mut self, nodes: Vec<NodeId>) -> Divisors {
        if nodes.len() > MOST {
            return Divisors::ALL;
        }
        let sets = &mut self.sets;
        *self.known.entry(nodes).or_insert_with_key(|nodes| {
            sets.push(nodes.clone());
            Divisors(sets.len() as u32 - 1)
        })
    }

    pub(super) fn union(&mut self, a: Divisors, b: Divisors) -> Divisors {
        let (a, b) = (a.min(b), a.max(b));
        if a == Divisors::NONE || b == Divisors::ALL || a == b {
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
}

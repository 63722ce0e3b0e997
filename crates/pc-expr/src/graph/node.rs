//! Nodes: the parts of expressions.

use std::hash::{Hash, Hasher};

use rustc_hash::FxHasher;

use crate::graph::function::Function;
use crate::graph::number::Number;
use crate::graph::undetermined::Undetermined;

/// Index of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(crate) struct NodeId(pub(crate) u32);

impl NodeId {
    pub(super) const NONE: NodeId = NodeId(u32::MAX);

    pub(crate) fn index(self) -> usize {
        self.0 as usize
    }
}

/// An expression: a constant, or a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Atom {
    Constant(Number),
    Node(NodeId),
}

impl Atom {
    pub(crate) const ZERO: Atom = Atom::Constant(Number::ZERO);
    pub(crate) const ONE: Atom = Atom::Constant(Number::ONE);

    pub(crate) fn is_zero(self) -> bool {
        matches!(self, Atom::Constant(c) if c.is_zero())
    }
}

/// A range of one of the operand pools.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slice {
    pub(super) start: u32,
    pub(super) len: u32,
}

impl Slice {
    pub(crate) fn range(self) -> std::ops::Range<usize> {
        self.start as usize..(self.start + self.len) as usize
    }
}

#[derive(Clone, Copy, Debug)]
pub(crate) enum Node {
    /// A constant, which is a node only as an argument of a call.
    Constant(Number),
    /// A symbol, given by its index into the names.
    Symbol(u32),
    Sum {
        constant: Number,
        terms: Slice,
    },
    Product {
        factors: Slice,
    },
    Call {
        function: Function,
        args: [NodeId; 3],
    },
    /// An undetermined function, or one of its partial derivatives, at its arguments.
    Applied {
        function: Undetermined,
        args: [NodeId; 3],
    },
}

/// The description of a node, which may or may not exist yet.
#[derive(Clone, Copy)]
pub(crate) enum Candidate<'a> {
    Constant(Number),
    Symbol(&'a str),
    Sum(Number, &'a [(NodeId, Number)]),
    Product(&'a [(NodeId, i32)]),
    Call(Function, [NodeId; 3]),
    Applied(Undetermined, [NodeId; 3]),
}

impl Candidate<'_> {
    pub(super) fn hash(&self) -> u64 {
        match self {
            Candidate::Constant(c) => hash_of(&(0u8, c)),
            Candidate::Symbol(name) => hash_of(&(1u8, name)),
            Candidate::Sum(c, terms) => hash_of(&(2u8, c, terms)),
            Candidate::Product(factors) => hash_of(&(3u8, factors)),
            Candidate::Call(function, args) => hash_of(&(4u8, function, args)),
            Candidate::Applied(function, args) => hash_of(&(5u8, function, args)),
        }
    }
}

/// Whether nodes of equal value are merged, or only nodes that are written alike.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Folding {
    /// Merge nodes whose fingerprints agree; see [`Graph`](crate::Graph).
    #[default]
    ByValue,
    /// Merge only expressions that are written alike.
    Structural,
}

pub(super) fn hash_of(value: &impl Hash) -> u64 {
    let mut hasher = FxHasher::default();
    value.hash(&mut hasher);
    hasher.finish()
}

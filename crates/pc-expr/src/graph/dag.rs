//! The arena of interned nodes.
//!
//! Children always have smaller indices than their parents, so ascending index order is a topological order.

use std::sync::Arc;

use hashbrown::HashTable;
use rustc_hash::{FxHashMap, FxHashSet};

use crate::graph::budget::Meter;
use crate::graph::divisors::{DivisorSets, Divisors};
use crate::graph::function::Function;
use crate::graph::node::{Atom, Candidate, Folding, Node, NodeId, Slice, hash_of};
use crate::graph::number::Number;
use crate::graph::undetermined::Undetermined;
use crate::identity::fingerprint::Fingerprint;
use crate::identity::roots::{Roots, Terms, Value};

/// The bit shared by all symbols that are confined to the expressions made with them.
const CONFINED: u64 = 1 << 63;

/// The clock is read once for so many operands: a fraction of a millisecond's work.
const LOOKS: usize = 256;

#[derive(Debug)]
pub(crate) struct Dag {
    pub(super) folding: Folding,
    /// `None` if constants are combined without a graph.
    meter: Option<Arc<Meter>>,
    /// Bytes taken from the meter.
    taken: u64,
    /// Counts the operands since the clock and the handle for cancelling were read.
    worked: usize,
    nodes: Vec<Node>,
    fingerprints: Vec<Fingerprint>,
    /// The values of nodes with roots, as sums of products of roots.
    expansions: FxHashMap<NodeId, Terms>,
    /// The values of the logarithms of nodes.
    pub(super) logarithms: FxHashMap<NodeId, Value>,
    roots: Roots,
    /// Whether the node is known not to be negative where it has a value.
    pub(super) nonnegative: Vec<bool>,
    /// The number of operations of the node written out as a tree, saturating: it decides which of two nodes of
    /// equal value is kept.
    costs: Vec<u32>,
    /// A bit for each symbol in the node; symbols 63 apart share a bit, and [confined](CONFINED) ones have the last bit.
    symbols: Vec<u64>,
    /// Nodes that are kept as units in the sums and products above them.
    kept: FxHashSet<NodeId>,
    /// The divisors in the node.
    pub(super) divisors: Vec<Divisors>,
    /// The arguments of roots and the like in the node, which bound the region where it has a value.
    pub(super) limits: Vec<Divisors>,
    pub(super) divisor_sets: DivisorSets,
    /// The node that replaces this one, if a better one with the same value (up to sign) was found later.
    successor: Vec<Option<(NodeId, Number)>>,
    terms: Vec<(NodeId, Number)>,
    factors: Vec<(NodeId, i32)>,
    names: Vec<String>,
    /// The names of undetermined functions.
    functions: Vec<String>,
    by_structure: HashTable<NodeId>,
    pub(super) by_value: HashTable<NodeId>,
    /// The numerators of all divisions by zero so far.
    pub(super) zero_divisions: Vec<Atom>,
}

impl Drop for Dag {
    fn drop(&mut self) {
        if let Some(meter) = &self.meter {
            meter.give_back(self.taken);
        }
    }
}

impl Dag {
    pub(crate) fn new(folding: Folding, meter: Option<Arc<Meter>>) -> Dag {
        Dag {
            folding,
            meter,
            taken: 0,
            worked: 0,
            nodes: Vec::new(),
            fingerprints: Vec::new(),
            expansions: FxHashMap::default(),
            logarithms: FxHashMap::default(),
            roots: Roots::default(),
            nonnegative: Vec::new(),
            costs: Vec::new(),
            symbols: Vec::new(),
            kept: FxHashSet::default(),
            divisors: Vec::new(),
            limits: Vec::new(),
            divisor_sets: DivisorSets::default(),
            successor: Vec::new(),
            terms: Vec::new(),
            factors: Vec::new(),
            names: Vec::new(),
            functions: Vec::new(),
            by_structure: HashTable::new(),
            by_value: HashTable::new(),
            zero_divisions: Vec::new(),
        }
    }

    pub(crate) fn folding(&self) -> Folding {
        self.folding
    }

    pub(crate) fn len(&self) -> usize {
        self.nodes.len()
    }

    pub(crate) fn node(&self, id: NodeId) -> Node {
        self.nodes[id.index()]
    }

    pub(crate) fn fingerprint(&self, id: NodeId) -> Fingerprint {
        self.fingerprints[id.index()]
    }

    /// Whether the value of a node is free of roots.
    pub(crate) fn is_plain(&self, id: NodeId) -> bool {
        self.expansions.is_empty() || !self.expansions.contains_key(&id)
    }

    pub(crate) fn value(&self, id: NodeId) -> Value {
        Value::new(self.fingerprint(id), self.expansions.get(&id).cloned())
    }

    pub(crate) fn roots_mut(&mut self) -> &mut Roots {
        &mut self.roots
    }

    pub(crate) fn cost(&self, id: NodeId) -> u32 {
        self.costs[id.index()]
    }

    pub(crate) fn terms(&self, slice: Slice) -> &[(NodeId, Number)] {
        &self.terms[slice.range()]
    }

    pub(crate) fn factors(&self, slice: Slice) -> &[(NodeId, i32)] {
        &self.factors[slice.range()]
    }

    pub(crate) fn symbol_name(&self, index: u32) -> &str {
        &self.names[index as usize]
    }

    /// The index of the undetermined function with that name, listed if it is new.
    pub(crate) fn function(&mut self, name: &str) -> u32 {
        let known = self.functions.iter().position(|function| function == name);
        let place = known.unwrap_or_else(|| {
            self.functions.push(name.to_owned());
            self.functions.len() - 1
        });
        place as u32
    }

    /// Whether there are undetermined functions.
    pub(crate) fn has_functions(&self) -> bool {
        !self.functions.is_empty()
    }

    /// The name of an undetermined function, without the orders of differentiation.
    pub(crate) fn function_name(&self, function: Undetermined) -> &str {
        &self.functions[function.name as usize]
    }

    pub(crate) fn zero_divisions(&self) -> &[Atom] {
        &self.zero_divisions
    }

    /// Forgets the divisions by zero after the first `kept`: those of a trial whose result is not used.
    pub(crate) fn forget_zero_divisions(&mut self, kept: usize) {
        self.zero_divisions.truncate(kept);
    }

    /// The arguments of a call.
    pub(crate) fn args(function: Function, args: &[NodeId; 3]) -> &[NodeId] {
        &args[..function.arity()]
    }

    /// Calls `visit` with each child of a node.
    pub(crate) fn for_each_child(&self, id: NodeId, mut visit: impl FnMut(NodeId)) {
        match self.node(id) {
            Node::Constant(_) | Node::Symbol(_) => {}
            Node::Sum { terms, .. } => self.terms(terms).iter().for_each(|&(n, _)| visit(n)),
            Node::Product { factors } => self.factors(factors).iter().for_each(|&(n, _)| visit(n)),
            Node::Call { function, args } => Dag::args(function, &args).iter().for_each(|&n| visit(n)),
            Node::Applied { function, args } => function.args(&args).iter().for_each(|&n| visit(n)),
        }
    }

    /// The symbol with that name, created if it is new.
    pub(crate) fn symbol(&mut self, name: &str) -> NodeId {
        let candidate = Candidate::Symbol(name);
        self.find(&candidate).unwrap_or_else(|| {
            let id = self.push(&candidate, Fingerprint::symbol(name).into());
            self.register(id);
            id
        })
    }

    /// Keeps this node as a unit in sums and products built from now on.
    pub(crate) fn keep(&mut self, atom: Atom) {
        if let Atom::Node(node) = atom {
            let (node, _) = self.split_coefficient(node, Number::ONE);
            self.kept.insert(node);
        }
    }

    pub(super) fn is_kept(&self, node: NodeId) -> bool {
        !self.kept.is_empty() && self.kept.contains(&node)
    }

    /// Whether two expressions are the same node, or have the same value if folding by value is on.
    pub(crate) fn same(&self, a: Atom, b: Atom) -> bool {
        match (a, b) {
            (Atom::Node(a), Atom::Node(b)) => {
                let equal = self.folding == Folding::ByValue && self.fingerprint(a) == self.fingerprint(b);
                equal || self.split_coefficient(a, Number::ONE) == self.split_coefficient(b, Number::ONE)
            }
            _ => a == b,
        }
    }

    /// The best node known to have this node's value up to sign, with that sign.
    pub(super) fn representative(&self, mut node: NodeId) -> (NodeId, Number) {
        let mut sign = Number::ONE;
        while let Some((next, s)) = self.successor[node.index()] {
            (node, sign) = (next, sign * s);
        }
        (node, sign)
    }

    /// Counts work, in operands, and returns whether the budget is spent, for which the clock is read now and then.
    pub(crate) fn is_spent(&mut self, operands: usize) -> bool {
        self.worked += operands;
        let looks = self.worked >= LOOKS;
        if looks {
            self.worked = 0;
        }
        self.meter.as_ref().is_some_and(|meter| meter.is_spent(looks))
    }

    /// Whether the budget is spent by now.
    pub(crate) fn has_spent(&self) -> bool {
        self.meter.as_ref().is_some_and(|meter| meter.is_spent(true))
    }

    /// Takes the bytes of something that is kept as long as the expressions from the budget.
    pub(crate) fn charge(&mut self, bytes: u64) {
        if let Some(meter) = &self.meter {
            meter.charge(bytes);
            self.taken += bytes;
        }
    }

    /// Interns a candidate. If folding by value is on, constants are recognised, and an existing node of
    /// equal value up to sign is returned if it is at least as good.
    ///
    /// Of two forms of one function, the better one has fewer divisors (x + 1 has a value at x = 1, where
    /// (x² − 1)/(x − 1) has none) and fewer roots ((√x − 1)² + 2√x is undefined below 0); if neither is
    /// worse, the shorter one is better. Two forms, each with a divisor that the other lacks, stay separate
    /// nodes; so do two forms if one contains a [confined](Dag::confine) symbol.
    ///
    /// Once the budget is spent, the result is undefined, so that the work ends soon.
    pub(super) fn admit(&mut self, candidate: &Candidate<'_>) -> Atom {
        if self.is_spent(1) {
            return Atom::Constant(Number::UNDEFINED);
        }
        if self.folding == Folding::Structural {
            return self.intern(candidate);
        }
        if let Some(known) = self.find(candidate) {
            let (node, sign) = self.representative(known);
            return self.signed(node, sign);
        }
        let value = self.value_of(candidate);
        let fingerprint = value.fingerprint;
        if let Some((p, q)) = fingerprint.small_rational() {
            return Atom::Constant(Number::ratio(p, q));
        }
        let key = fingerprint.up_to_sign();
        let hash = hash_of(&key);
        let Some(&equal) = self.by_value.find(hash, |&id| self.fingerprint(id).up_to_sign() == key) else {
            let id = self.push(candidate, value);
            self.register(id);
            return Atom::Node(id);
        };
        let is_confined = |symbols: u64| symbols & CONFINED != 0;
        let (ours_are, theirs_are) =
            (is_confined(self.symbols_of(candidate)), is_confined(self.symbols[equal.index()]));
        if ours_are != theirs_are {
            let id = self.push(candidate, value);
            if theirs_are && let Some(slot) = self.by_value.find_mut(hash, |&known| known == equal) {
                *slot = id;
            }
            return Atom::Node(id);
        }
        let sign = if self.fingerprint(equal) == fingerprint { Number::ONE } else { Number::MINUS_ONE };
        let (ours, theirs) = (self.divisors_of(candidate), self.divisors[equal.index()]);
        let (bounds, their_bounds) = (self.limits_of(candidate), self.limits[equal.index()]);
        let regular = self.are_within(theirs, ours) && self.are_among(their_bounds, bounds);
        let replaceable = self.are_within(ours, theirs) && self.are_among(bounds, their_bounds);
        if regular && !(replaceable && self.is_shorter(candidate, equal)) {
            return self.signed(equal, sign);
        }
        let id = self.push(candidate, value);
        if replaceable {
            self.successor[equal.index()] = Some((id, sign));
            if let Some(slot) = self.by_value.find_mut(hash, |&known| known == equal) {
                *slot = id;
            }
        }
        Atom::Node(id)
    }

    /// Confines a symbol: if it cancels from an expression, that expression does not replace others.
    pub(crate) fn confine(&mut self, symbol: NodeId) {
        self.symbols[symbol.index()] = CONFINED;
    }

    /// Makes a node findable by its value.
    fn register(&mut self, id: NodeId) {
        let Dag { by_value, fingerprints, .. } = self;
        let hash = |id: &NodeId| hash_of(&fingerprints[id.index()].up_to_sign());
        by_value.insert_unique(hash(&id), id, hash);
    }

    /// ±n; a negative node is interned by its structure, without computing its value again.
    pub(super) fn signed(&mut self, node: NodeId, sign: Number) -> Atom {
        if sign.is_one() {
            return Atom::Node(node);
        }
        match self.split_coefficient(node, sign) {
            (child, q) if q.is_one() => Atom::Node(child),
            (child, q) => self.intern(&Candidate::Sum(Number::ZERO, &[(child, q)])),
        }
    }

    /// Interns a candidate by its structure alone.
    pub(super) fn intern(&mut self, candidate: &Candidate<'_>) -> Atom {
        let id = self.find(candidate).unwrap_or_else(|| {
            let value = self.value_of(candidate);
            self.push(candidate, value)
        });
        Atom::Node(id)
    }

    pub(super) fn find(&self, candidate: &Candidate<'_>) -> Option<NodeId> {
        self.by_structure.find(candidate.hash(), |&id| self.is(id, candidate)).copied()
    }

    fn is(&self, id: NodeId, candidate: &Candidate<'_>) -> bool {
        match (self.node(id), candidate) {
            (Node::Constant(a), Candidate::Constant(b)) => a == *b,
            (Node::Symbol(index), Candidate::Symbol(name)) => self.symbol_name(index) == *name,
            (Node::Sum { constant, terms }, Candidate::Sum(c, t)) => {
                constant == *c && self.terms(terms) == *t
            }
            (Node::Product { factors }, Candidate::Product(f)) => self.factors(factors) == *f,
            (Node::Call { function, args }, Candidate::Call(f, a)) => function == *f && args == *a,
            (Node::Applied { function, args }, Candidate::Applied(f, a)) => function == *f && args == *a,
            _ => false,
        }
    }

    pub(super) fn push(&mut self, candidate: &Candidate<'_>, value: Value) -> NodeId {
        let (cost, symbols) = (self.cost_of(candidate), self.symbols_of(candidate));
        let (divisors, limits) = (self.divisors_of(candidate), self.limits_of(candidate));
        let nonnegative = self.is_candidate_nonnegative(candidate);
        let node = match *candidate {
            Candidate::Constant(c) => Node::Constant(c),
            Candidate::Symbol(name) => {
                self.names.push(name.to_owned());
                Node::Symbol(self.names.len() as u32 - 1)
            }
            Candidate::Sum(constant, terms) => {
                let start = self.terms.len() as u32;
                self.terms.extend_from_slice(terms);
                Node::Sum { constant, terms: Slice { start, len: terms.len() as u32 } }
            }
            Candidate::Product(factors) => {
                let start = self.factors.len() as u32;
                self.factors.extend_from_slice(factors);
                Node::Product { factors: Slice { start, len: factors.len() as u32 } }
            }
            Candidate::Call(function, args) => Node::Call { function, args },
            Candidate::Applied(function, args) => Node::Applied { function, args },
        };
        let operands = match node {
            Node::Sum { terms: slice, .. } | Node::Product { factors: slice } => slice.range().len(),
            _ => 0,
        };
        let terms = operands + value.own_terms();
        self.worked += terms;
        if let Some(meter) = &self.meter {
            self.taken += meter.take(terms);
        }
        let id = NodeId(self.nodes.len() as u32);
        self.nodes.push(node);
        self.fingerprints.push(value.fingerprint);
        if let Some(terms) = value.into_terms() {
            self.expansions.insert(id, terms);
        }
        self.nonnegative.push(nonnegative);
        self.costs.push(cost);
        self.symbols.push(symbols);
        self.divisors.push(divisors);
        self.limits.push(limits);
        self.successor.push(None);
        let hash = candidate.hash();
        let Dag { by_structure, nodes, names, terms: term_pool, factors: factor_pool, .. } = self;
        by_structure.insert_unique(hash, id, |&other| {
            match nodes[other.index()] {
                Node::Constant(c) => Candidate::Constant(c),
                Node::Symbol(index) => Candidate::Symbol(&names[index as usize]),
                Node::Sum { constant, terms } => Candidate::Sum(constant, &term_pool[terms.range()]),
                Node::Product { factors } => Candidate::Product(&factor_pool[factors.range()]),
                Node::Call { function, args } => Candidate::Call(function, args),
                Node::Applied { function, args } => Candidate::Applied(function, args),
            }
            .hash()
        });
        id
    }

    /// Whether a candidate costs less than a node, or costs the same but contains fewer symbols.
    fn is_shorter(&self, candidate: &Candidate<'_>, node: NodeId) -> bool {
        let (ours, theirs) = (self.symbols_of(candidate), self.symbols[node.index()]);
        let without = ours & theirs == ours && ours != theirs;
        let (cost, known) = (self.cost_of(candidate), self.cost(node));
        cost < known || cost == known && without
    }

    fn symbols_of(&self, candidate: &Candidate<'_>) -> u64 {
        let with = |bits: u64, node: NodeId| bits | self.symbols[node.index()];
        match *candidate {
            Candidate::Constant(_) => 0,
            Candidate::Symbol(_) => 1 << (self.names.len() % 63),
            Candidate::Sum(_, terms) => terms.iter().fold(0, |bits, &(node, _)| with(bits, node)),
            Candidate::Product(factors) => factors.iter().fold(0, |bits, &(node, _)| with(bits, node)),
            Candidate::Call(function, args) => {
                Dag::args(function, &args).iter().fold(0, |bits, &node| with(bits, node))
            }
            Candidate::Applied(function, args) => {
                function.args(&args).iter().fold(0, |bits, &node| with(bits, node))
            }
        }
    }

    /// The number of operations of a candidate written out as a tree: n − 1 additions or multiplications
    /// for n operands, plus the operations for coefficients and powers; a division counts as four operations,
    /// a call as ten.
    fn cost_of(&self, candidate: &Candidate<'_>) -> u32 {
        let sum = |costs: &mut dyn Iterator<Item = u32>| costs.fold(0u32, u32::saturating_add);
        match *candidate {
            Candidate::Constant(_) | Candidate::Symbol(_) => 0,
            Candidate::Sum(constant, terms) => {
                let scaling = |q: Number| u32::from(!q.abs().is_one());
                let operands = terms.len() as u32 + u32::from(!constant.is_zero());
                sum(&mut terms.iter().map(|&(n, q)| self.cost(n).saturating_add(scaling(q))))
                    .saturating_add(operands - 1)
            }
            Candidate::Product(factors) => {
                let power = |e: u32| e.ilog2() + e.count_ones() - 1;
                let division = if factors.iter().any(|&(_, e)| e < 0) { 3 } else { 0 };
                sum(&mut factors.iter().map(|&(n, e)| self.cost(n).saturating_add(power(e.unsigned_abs()))))
                    .saturating_add(factors.len() as u32 - 1 + division)
            }
            Candidate::Call(function, args) => {
                sum(&mut Dag::args(function, &args).iter().map(|&n| self.cost(n))).saturating_add(10)
            }
            Candidate::Applied(function, args) => {
                sum(&mut function.args(&args).iter().map(|&n| self.cost(n))).saturating_add(10)
            }
        }
    }
}

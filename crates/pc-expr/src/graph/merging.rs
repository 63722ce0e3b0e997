//! Nodes of equal value: which of them stands for the others.

use crate::graph::dag::Dag;
use crate::graph::node::{Atom, Candidate, Folding, NodeId, hash_of};
use crate::graph::number::Number;
use crate::identity::fingerprint::Fingerprint;

/// A node beside a candidate of equal value.
#[derive(Clone, Copy, Debug)]
struct Comparison {
    /// Whether it contains no symbol that the candidate lacks.
    adds_no_symbol: bool,
    /// Whether it contains each symbol of the candidate.
    lacks_no_symbol: bool,
    /// Whether it has a value wherever the candidate has one.
    is_regular: bool,
    /// Whether it has no value where the candidate has none.
    is_limited: bool,
    /// Whether it costs more than the candidate, or as much with more symbols.
    is_longer: bool,
}

impl Dag {
    /// The best node known to have this node's value up to the sign that is returned with it.
    pub(super) fn representative(&self, mut node: NodeId) -> (NodeId, Number) {
        let mut sign = Number::ONE;
        while let Some((next, s)) = self.successor[node.index()] {
            (node, sign) = (next, sign * s);
        }
        (node, sign)
    }

    /// Interns a candidate. Where folding by value is on, constants are recognised, and an existing node of
    /// equal value up to sign is returned if it is at least as good.
    ///
    /// Of two forms of one function the better one divides by less, as x + 1 has a value at x = 1 and (x² −
    /// 1)/(x − 1) has none, and takes fewer roots, as (√x − 1)² + 2√x is undefined below 0; where neither is
    /// worse, the shorter one is better. Two forms each with a divisor that the other lacks stay separate
    /// nodes. No form stands for one without all of its symbols: an expression contains those alone of which
    /// it is made, however much shorter it would be with one that cancels.
    ///
    /// Once the budget is spent the result is undefined, so that the work ends soon.
    pub(super) fn admit(&mut self, candidate: &Candidate<'_>) -> Atom {
        self.asked = self.asked.wrapping_add(1);
        let looks = self.asked == 0;
        if self.meter.as_ref().is_some_and(|meter| meter.is_spent(looks)) {
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
        let equal = self.of_value(fingerprint);
        if equal.is_empty() {
            let id = self.push(candidate, value);
            self.register(id);
            return Atom::Node(id);
        }
        let sign_of = |dag: &Dag, node: NodeId| match dag.fingerprint(node) == fingerprint {
            true => Number::ONE,
            false => Number::MINUS_ONE,
        };
        let comparisons: Vec<(NodeId, Comparison)> =
            equal.into_iter().map(|node| (node, self.compare(candidate, node))).collect();
        let good_enough = comparisons.iter().filter(|(_, with)| {
            with.adds_no_symbol && with.is_regular && !(with.is_limited && with.is_longer)
        });
        if let Some(&(node, _)) = good_enough.min_by_key(|(node, _)| (self.cost(*node), *node)) {
            return self.signed(node, sign_of(self, node));
        }
        let id = self.push(candidate, value);
        let mut is_best = comparisons.iter().all(|(_, with)| with.is_limited || !with.adds_no_symbol);
        for (node, with) in comparisons {
            if with.lacks_no_symbol && with.is_limited && (with.is_longer || !with.is_regular) {
                self.successor[node.index()] = Some((id, sign_of(self, node)));
                self.unregister(node);
                is_best = true;
            }
        }
        if is_best {
            self.register(id);
        }
        Atom::Node(id)
    }

    /// The registered nodes of a value up to sign.
    fn of_value(&self, fingerprint: Fingerprint) -> Vec<NodeId> {
        let key = fingerprint.up_to_sign();
        let alike = |id: &&NodeId| self.fingerprint(**id).up_to_sign() == key;
        self.by_value.iter_hash(hash_of(&key)).filter(alike).copied().collect()
    }

    fn compare(&mut self, candidate: &Candidate<'_>, node: NodeId) -> Comparison {
        let (ours, theirs) = (self.symbols_of(candidate), self.symbols[node.index()]);
        let (divisors, their_divisors) = (self.divisors_of(candidate), self.divisors[node.index()]);
        let (limits, their_limits) = (self.limits_of(candidate), self.limits[node.index()]);
        let adds_no_symbol = self.symbol_sets.is_subset(theirs, ours);
        let lacks_no_symbol = self.symbol_sets.is_subset(ours, theirs);
        let (cost, known) = (self.cost_of(candidate), self.cost(node));
        Comparison {
            adds_no_symbol,
            lacks_no_symbol,
            is_regular: self.are_within(their_divisors, divisors) && self.are_among(their_limits, limits),
            is_limited: self.are_within(divisors, their_divisors) && self.are_among(limits, their_limits),
            is_longer: cost < known || cost == known && lacks_no_symbol && !adds_no_symbol,
        }
    }

    /// Makes a node findable by its value.
    pub(super) fn register(&mut self, id: NodeId) {
        let Dag { by_value, fingerprints, .. } = self;
        let hash = |id: &NodeId| hash_of(&fingerprints[id.index()].up_to_sign());
        by_value.insert_unique(hash(&id), id, hash);
    }

    fn unregister(&mut self, id: NodeId) {
        let hash = hash_of(&self.fingerprint(id).up_to_sign());
        if let Ok(entry) = self.by_value.find_entry(hash, |&known| known == id) {
            entry.remove();
        }
    }
}

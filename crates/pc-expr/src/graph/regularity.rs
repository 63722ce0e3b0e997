//! The divisors of nodes as written: two forms of one function differ at points where a divisor vanishes.

use rustc_hash::FxHashSet;

use crate::graph::dag::Dag;
use crate::graph::divisors::Divisors;
use crate::graph::function::Function;
use crate::graph::node::{Atom, Candidate, Folding, Node, NodeId, hash_of};
use crate::graph::number::Number;
use crate::identity::fingerprint::Fingerprint;

impl Dag {
    /// The divisors of a candidate, both its own and those of the nodes below it; none if nodes are merged by
    /// structure alone.
    pub(crate) fn divisors_of(&mut self, candidate: &Candidate<'_>) -> Divisors {
        if self.folding == Folding::Structural {
            return Divisors::NONE;
        }
        let mut all = Divisors::NONE;
        let mut add = |dag: &mut Dag, node: NodeId| {
            all = dag.divisor_sets.union(all, dag.divisors[node.index()]);
        };
        match *candidate {
            Candidate::Constant(_) | Candidate::Symbol(_) => {}
            Candidate::Applied(function, args) => {
                function.args(&args).iter().for_each(|&node| add(self, node));
            }
            Candidate::Sum(_, terms) => terms.iter().for_each(|&(node, _)| add(self, node)),
            Candidate::Call(function, args) => {
                Dag::args(function, &args).iter().for_each(|&node| add(self, node));
            }
            Candidate::Product(factors) => {
                factors.iter().for_each(|&(node, _)| add(self, node));
                for &(node, e) in factors {
                    if e < 0 && self.may_vanish(node) {
                        let own = self.divisor_sets.intern(vec![node]);
                        all = self.divisor_sets.union(all, own);
                    }
                }
            }
        }
        all
    }

    /// The arguments that bound the region where a candidate has a value, both its own and those of the nodes
    /// below it; none if nodes are merged by structure alone.
    pub(crate) fn limits_of(&mut self, candidate: &Candidate<'_>) -> Divisors {
        if self.folding == Folding::Structural {
            return Divisors::NONE;
        }
        let mut all = Divisors::NONE;
        let mut add = |dag: &mut Dag, node: NodeId| {
            all = dag.divisor_sets.union(all, dag.limits[node.index()]);
        };
        match *candidate {
            Candidate::Constant(_) | Candidate::Symbol(_) => {}
            Candidate::Applied(function, args) => {
                function.args(&args).iter().for_each(|&node| add(self, node));
            }
            Candidate::Sum(_, terms) => terms.iter().for_each(|&(node, _)| add(self, node)),
            Candidate::Product(factors) => factors.iter().for_each(|&(node, _)| add(self, node)),
            Candidate::Call(function, args) => {
                Dag::args(function, &args).iter().for_each(|&node| add(self, node));
                let bounded = match function {
                    Function::Sqrt => !self.is_nonnegative(args[0]),
                    Function::Pow | Function::Asin | Function::Acos => true,
                    Function::Log => self.may_vanish(args[0]),
                    _ => false,
                };
                if bounded {
                    let own = self.divisor_sets.intern(vec![args[0]]);
                    all = self.divisor_sets.union(all, own);
                }
            }
        }
        all
    }

    /// Whether each limit of the first set also belongs to the second.
    pub(crate) fn are_among(&self, some: Divisors, others: Divisors) -> bool {
        if some == others || some == Divisors::NONE || others == Divisors::ALL {
            return true;
        }
        if some == Divisors::ALL || others == Divisors::NONE {
            return false;
        }
        let others = self.divisor_sets.get(others);
        self.divisor_sets.get(some).iter().all(|&limit| {
            others.iter().any(|&other| other == limit || self.fingerprint(other) == self.fingerprint(limit))
        })
    }

    /// Whether each divisor of the first expression vanishes only where one of the second does.
    pub(crate) fn is_as_regular(&self, some: Atom, other: Atom) -> bool {
        let divisors = |atom| match atom {
            Atom::Constant(_) => Divisors::NONE,
            Atom::Node(node) => self.divisors[node.index()],
        };
        self.are_within(divisors(some), divisors(other))
    }

    /// Whether each divisor of the first set vanishes only where one of the second does, judged by their
    /// factors.
    pub(crate) fn are_within(&self, some: Divisors, others: Divisors) -> bool {
        if some == others || some == Divisors::NONE || others == Divisors::ALL {
            return true;
        }
        if some == Divisors::ALL || others == Divisors::NONE {
            return false;
        }
        let others = self.irreducible(others);
        let is_within = |&divisor: &Fingerprint| {
            others.contains(&divisor) || others.iter().any(|&other| self.divides(divisor, other))
        };
        self.irreducible(some).iter().all(is_within)
    }

    /// Whether the first of two values is a factor of the second: the quotient is a constant, or known
    /// without division.
    fn divides(&self, factor: Fingerprint, product: Fingerprint) -> bool {
        let quotient = product.times(factor.powi(-1)).up_to_sign();
        if quotient.small_rational().is_some() {
            return true;
        }
        let known =
            self.by_value.find(hash_of(&quotient), |&id| self.fingerprint(id).up_to_sign() == quotient);
        known.is_some_and(|id| self.divisors[id.index()] == Divisors::NONE)
    }

    /// The values, up to sign, of the factors of the given divisors; a root vanishes where its radicand does.
    fn irreducible(&self, divisors: Divisors) -> Vec<Fingerprint> {
        let mut open = self.divisor_sets.get(divisors).to_vec();
        let mut values = Vec::with_capacity(open.len());
        // In a tower of roots, each contains all those below it.
        let mut known = FxHashSet::default();
        while let Some(node) = open.pop() {
            let (node, _) = self.split_coefficient(node, Number::ONE);
            if !known.insert(node) {
                continue;
            }
            match self.node(node) {
                Node::Product { factors } => {
                    open.extend(
                        self.factors(factors).iter().filter(|(_, e)| *e > 0).map(|&(factor, _)| factor),
                    );
                }
                Node::Call { function: Function::Sqrt | Function::Abs, args } => open.push(args[0]),
                _ if self.may_vanish(node) => values.push(self.fingerprint(node).up_to_sign()),
                _ => {}
            }
        }
        values
    }

    /// Whether a node may be zero: false if it is positive everywhere.
    fn may_vanish(&self, node: NodeId) -> bool {
        !matches!(self.node(node), Node::Call { function: Function::Exp | Function::Cosh, .. })
    }
}

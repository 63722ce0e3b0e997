//! Which nodes are known, from their form, to be nonnegative wherever they have a value.

use crate::graph::dag::Dag;
use crate::graph::function::Function;
use crate::graph::node::{Candidate, Node, NodeId};
use crate::graph::number::Number;

impl Dag {
    /// Whether a node is known to be nonnegative where it has a value.
    pub(crate) fn is_nonnegative(&self, id: NodeId) -> bool {
        self.nonnegative[id.index()]
    }

    /// Whether a node is known to be zero or negative where it has a value.
    pub(crate) fn is_nonpositive(&self, id: NodeId) -> bool {
        let Node::Sum { constant, terms } = self.node(id) else { return false };
        self.is_sum_nonnegative(-constant, self.terms(terms).iter().map(|&(node, q)| (node, -q)))
    }

    pub(crate) fn is_candidate_nonnegative(&self, candidate: &Candidate<'_>) -> bool {
        match *candidate {
            Candidate::Constant(c) => !c.is_negative(),
            Candidate::Symbol(_) | Candidate::Applied(..) => false,
            Candidate::Sum(constant, terms) => self.is_sum_nonnegative(constant, terms.iter().copied()),
            Candidate::Product(factors) => {
                factors.iter().all(|&(node, e)| e % 2 == 0 || self.is_nonnegative(node))
            }
            Candidate::Call(function, args) => self.is_call_nonnegative(function, &args),
        }
    }

    /// Whether c + Σ q n is known to be nonnegative: c outweighs the terms that may be negative, in which
    /// the size of n is at most 1, and all other terms have q > 0 and a nonnegative n.
    fn is_sum_nonnegative(&self, constant: Number, terms: impl Iterator<Item = (NodeId, Number)>) -> bool {
        let mut least = constant;
        for (node, q) in terms {
            if q.is_negative() || !self.is_nonnegative(node) {
                if !self.is_at_most_one(node) {
                    return false;
                }
                least = least + -q.abs();
            }
        }
        // A rounded sum proves nothing.
        matches!(least, Number::Rational { .. }) && !least.is_negative()
    }

    /// Whether |n| ≤ 1 is known.
    fn is_at_most_one(&self, node: NodeId) -> bool {
        let is_bounded = |node: NodeId| {
            matches!(
                self.node(node),
                Node::Call { function: Function::Sin | Function::Cos | Function::Tanh | Function::Sign, .. }
            )
        };
        match self.node(node) {
            Node::Product { factors } => {
                self.factors(factors).iter().all(|&(node, e)| e > 0 && is_bounded(node))
            }
            _ => is_bounded(node),
        }
    }

    fn is_call_nonnegative(&self, function: Function, args: &[NodeId; 3]) -> bool {
        let known = |i: usize| self.is_nonnegative(args[i]);
        match function {
            Function::Exp | Function::Cosh | Function::Sqrt | Function::Abs | Function::Acos => true,
            Function::Asin | Function::Atan | Function::Sinh | Function::Tanh | Function::Sign => known(0),
            Function::Max => known(0) || known(1),
            Function::Min => known(0) && known(1),
            Function::Step => known(1) && known(2),
            // A power with a fractional exponent has no value below 0.
            Function::Pow => {
                let is_fraction =
                    matches!(self.node(args[1]), Node::Constant(Number::Rational { den, .. }) if den != 1);
                known(0) || is_fraction
            }
            Function::Sin | Function::Cos | Function::Log | Function::Atan2 => false,
        }
    }
}

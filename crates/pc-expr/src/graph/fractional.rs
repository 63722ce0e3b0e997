//! Powers with fractional exponents, which are real only where their base is not negative.

use crate::graph::dag::Dag;
use crate::graph::function::Function;
use crate::graph::node::{Atom, Node, NodeId};
use crate::graph::number::Number;

/// From here on all numbers are whole: 2⁵³.
const WHOLE: f64 = 2.0 / f64::EPSILON;

impl Dag {
    /// b and r r′ for (bʳ)^r′, if r and r r′ are fractional: both powers are real for b ≥ 0 only, where they are equal. So they are
    /// if r r′ is too large for a number to have a fraction.
    /// In this way a tower of powers over powers is one power, and not products of roots of products of roots.
    pub(crate) fn power_of_power(&self, x: Atom, exponent: Number) -> Option<(Atom, Number)> {
        let Atom::Node(mut base) = x else { return None };
        let (mut product, mut found) = (exponent, None);
        while let Some((inner, r)) = self.fractional_power(base) {
            (base, product) = (inner, product * r);
            if is_fractional(product) || product.is_finite() && product.abs().to_f64() >= WHOLE {
                found = Some((Atom::Node(base), product));
            }
        }
        found
    }

    /// b and r, if the node is bʳ with a fractional r: a root, a power, or a product of such powers of one base.
    fn fractional_power(&self, node: NodeId) -> Option<(NodeId, Number)> {
        match self.node(node) {
            Node::Call { .. } => self.called_power(node),
            Node::Product { factors } => {
                let power = |&(factor, e): &(NodeId, i32)| {
                    let (base, r) = self.called_power(factor).unwrap_or((factor, Number::ONE));
                    (base, r * Number::integer(e))
                };
                let mut powers = self.factors(factors).iter().map(power);
                let (base, first) = powers.next()?;
                let sum = powers.try_fold(first, |sum, (other, r)| (other == base).then(|| sum + r))?;
                is_fractional(sum).then_some((base, sum))
            }
            _ => None,
        }
    }

    /// The same for a single root or power.
    fn called_power(&self, node: NodeId) -> Option<(NodeId, Number)> {
        let Node::Call { function, args } = self.node(node) else { return None };
        match function {
            Function::Sqrt => Some((args[0], Number::ratio(1, 2))),
            Function::Pow => match self.node(args[1]) {
                Node::Constant(r) if is_fractional(r) => Some((args[0], r)),
                _ => None,
            },
            _ => None,
        }
    }
}

/// Whether x^r is real for x ≥ 0 only.
fn is_fractional(r: Number) -> bool {
    r.is_finite() && r.to_f64().fract() != 0.0
}

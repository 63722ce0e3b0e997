//! The rules by which sums and products are normalised as they are built.
//!
//! A sum is a linear combination c + Σ qᵢ nᵢ with rational coefficients, and a product is of the form Π nᵢ^eᵢ
//! with integer exponents; rational factors of products are kept in the sum around them.

use crate::graph::dag::Dag;
use crate::graph::function::Function;
use crate::graph::node::{Atom, Candidate, Folding, Node, NodeId};
use crate::graph::number::Number;

/// Sums of at most this many terms are merged into the sums that contain them. The bound keeps an
/// accumulation `s = s + x` of n terms from costing n² memory.
const MERGED_TERMS: usize = 24;
/// The same bound for the factors of products.
const MERGED_FACTORS: usize = 64;
/// Nested sums below one operand are flattened up to this many terms, and so are nested products.
const GATHERED: usize = 1024;
/// Powers with integer exponents larger than this remain calls of `pow`.
pub(super) const MAX_EXPONENT: u32 = 1 << 16;

impl Dag {
    /// c + Σ qᵢ nᵢ
    pub(crate) fn sum(&mut self, mut constant: Number, terms: &[(NodeId, Number)]) -> Atom {
        let mut gathered = Vec::with_capacity(terms.len() + 4);
        for &(node, coefficient) in terms {
            self.gather_terms(node, coefficient, &mut gathered, &mut constant);
        }
        let spent = self.is_spent(gathered.len());
        if spent || !constant.is_finite() || gathered.iter().any(|(_, q)| !q.is_finite()) {
            return Atom::Constant(Number::UNDEFINED);
        }
        gathered.sort_unstable_by_key(|&(node, _)| node);
        gathered.dedup_by(|next, kept| {
            let sum = kept.1 + next.1;
            let collected = next.0 == kept.0 && sum.is_finite();
            if collected {
                kept.1 = sum;
            }
            collected
        });
        gathered.retain(|(_, q)| !q.is_zero());
        match gathered.as_slice() {
            [] => Atom::Constant(constant),
            &[(node, q)] if constant.is_zero() => self.scaled(q, node),
            _ => {
                let content = content(constant, &gathered);
                // Printed forms have 1 − x under a root rather than −(x − 1).
                let turned = self.folding == Folding::Structural && (constant * content).is_negative();
                let content = if turned { -content } else { content };
                if content.is_one() {
                    return self.admit(&Candidate::Sum(constant, &gathered));
                }
                let divisor = content.recip();
                for (_, q) in &mut gathered {
                    *q = *q * divisor;
                }
                let inner = self.admit(&Candidate::Sum(constant * divisor, &gathered));
                self.scale(content, inner)
            }
        }
    }

    /// Adds q·n to `out` and `constant`, flattening the small sums inside it. Coefficients that would
    /// overflow or underflow stay where they are.
    fn gather_terms(&self, node: NodeId, q: Number, out: &mut Vec<(NodeId, Number)>, constant: &mut Number) {
        let limit = out.len() + GATHERED;
        let (mut next, mut open) = (Some((node, q)), Vec::new());
        while let Some((node, q)) = next {
            let (node, sign) = self.representative(node);
            let q = q * sign;
            let fits = |r: Number| q.abs().is_one() || q.checked_mul(r).is_some();
            match self.node(node) {
                Node::Constant(c) => *constant = *constant + q * c,
                Node::Sum { constant: c, terms }
                    if terms.range().len() <= MERGED_TERMS
                        && !self.is_kept(node)
                        && out.len() < limit
                        && fits(c)
                        && self.terms(terms).iter().all(|&(_, r)| fits(r)) =>
                {
                    *constant = *constant + q * c;
                    open.extend(self.terms(terms).iter().map(|&(child, r)| (child, q * r)));
                }
                _ => out.push((node, q)),
            }
            next = open.pop();
        }
    }

    /// q·n for a node n that is not itself a number times a node.
    fn scaled(&mut self, q: Number, node: NodeId) -> Atom {
        if q.is_one() {
            return Atom::Node(node);
        }
        let candidate = Candidate::Sum(Number::ZERO, &[(node, q)]);
        if (-q).is_one() { self.intern(&candidate) } else { self.admit(&candidate) }
    }

    /// q·x
    pub(crate) fn scale(&mut self, q: Number, x: Atom) -> Atom {
        match x {
            Atom::Constant(c) => Atom::Constant(c * q),
            _ if q.is_zero() => Atom::ZERO,
            _ if !q.is_finite() => Atom::Constant(Number::UNDEFINED),
            Atom::Node(node) => {
                let (node, q) = self.split_coefficient(node, q);
                self.scaled(q, node)
            }
        }
    }

    /// Writes q·n as q'·n' where n' is not a number times a node (unless q' overflows or underflows).
    pub(crate) fn split_coefficient(&self, node: NodeId, q: Number) -> (NodeId, Number) {
        let (mut node, sign) = self.representative(node);
        let mut q = q * sign;
        while let Node::Sum { constant, terms } = self.node(node) {
            let &[(child, coefficient)] = self.terms(terms) else { break };
            let (true, Some(product)) = (constant.is_zero(), q.checked_mul(coefficient)) else { break };
            let (child, sign) = self.representative(child);
            (node, q) = (child, product * sign);
        }
        (node, q)
    }

    /// q · Π nᵢ^eᵢ
    pub(crate) fn product(&mut self, mut coefficient: Number, factors: &[(NodeId, i32)]) -> Atom {
        let mut gathered = Vec::with_capacity(factors.len() + 4);
        for &(node, exponent) in factors {
            self.gather_factors(node, exponent, &mut gathered, &mut coefficient);
        }
        if self.is_spent(gathered.len()) || !coefficient.is_finite() {
            return Atom::Constant(Number::UNDEFINED);
        }
        if coefficient.is_zero() {
            return Atom::ZERO;
        }
        let square_parts = self.collect_exponents(&mut gathered, &mut coefficient);
        if square_parts {
            let flat = gathered.clone(); // a radicand may be a product or a multiple: gather once more
            return self.product(coefficient, &flat);
        }
        match gathered.as_slice() {
            [] => Atom::Constant(coefficient),
            &[(node, 1)] => self.scaled(coefficient, node),
            _ if gathered.iter().any(|(_, e)| e.unsigned_abs() > MAX_EXPONENT) => {
                let powers: Vec<Atom> = gathered.iter().map(|&(node, e)| self.large_power(node, e)).collect();
                self.product_of(coefficient, &powers)
            }
            _ => {
                let monomial = self.admit(&Candidate::Product(&gathered));
                self.scale(coefficient, monomial)
            }
        }
    }

    /// Adds n^e to `out` and `coefficient`, flattening the small products inside it. Coefficients and
    /// exponents that would overflow or underflow stay where they are.
    fn gather_factors(&self, node: NodeId, e: i32, out: &mut Vec<(NodeId, i32)>, coefficient: &mut Number) {
        let limit = out.len() + GATHERED;
        let (mut next, mut open) = (Some((node, e)), Vec::new());
        while let Some((node, e)) = next {
            let (inner, q) = self.split_coefficient(node, Number::ONE);
            let scaled = if q.is_one() {
                Some(*coefficient)
            } else {
                q.checked_powi(e).and_then(|power| coefficient.checked_mul(power))
            };
            match (scaled, self.node(inner)) {
                (None, _) => match self.representative(node) {
                    (kept, sign) if sign.is_one() => out.push((kept, e)),
                    _ => out.push((node, e)),
                },
                (Some(q), Node::Constant(c)) => *coefficient = q * c.powi(e),
                (Some(q), Node::Product { factors })
                    if factors.range().len() <= MERGED_FACTORS
                        && !self.is_kept(inner)
                        && out.len() < limit
                        && self.factors(factors).iter().all(|&(_, d)| d.checked_mul(e).is_some()) =>
                {
                    *coefficient = q;
                    open.extend(self.factors(factors).iter().map(|&(child, d)| (child, d * e)));
                }
                (Some(q), _) => {
                    *coefficient = q;
                    out.push((inner, e));
                }
            }
            next = open.pop();
        }
    }

    /// Adds the exponents of equal factors and turns (√e)² into e, e/√e into √e and |e|² into e²; moves
    /// signs into `coefficient`. Returns whether the factors may have to be gathered once more.
    fn collect_exponents(&self, factors: &mut Vec<(NodeId, i32)>, coefficient: &mut Number) -> bool {
        factors.sort_unstable_by_key(|&(node, _)| node);
        factors.dedup_by(|next, kept| {
            let sum = kept.1.checked_add(next.1).filter(|_| next.0 == kept.0);
            kept.1 = sum.unwrap_or(kept.1);
            sum.is_some()
        });
        factors.retain(|&(_, e)| e != 0);
        let mut took = false;
        for i in 0..factors.len() {
            let (node, e) = factors[i];
            let Node::Call { function, args } = self.node(node) else { continue };
            match function {
                Function::Sqrt if e.unsigned_abs() >= 2 => {
                    factors[i].1 = e % 2;
                    factors.push((args[0], e / 2));
                    took = true;
                }
                Function::Sqrt => {
                    // √E^e (±E)^r = ±√E^−e (±E)^{r+e} for e = ±1
                    let (radicand, sign) = self.representative(args[0]);
                    let other = factors.iter_mut().find(|(node, r)| *node == radicand && r.signum() == -e);
                    if let Some((_, r)) = other {
                        *r += e;
                        factors[i].1 = -e;
                        *coefficient = *coefficient * sign;
                    }
                }
                Function::Abs if e % 2 == 0 => {
                    factors[i] = (args[0], e);
                    took = true;
                }
                _ => {}
            }
        }
        factors.retain(|&(_, e)| e != 0);
        took
    }

    fn large_power(&mut self, node: NodeId, exponent: i32) -> Atom {
        if exponent.unsigned_abs() <= MAX_EXPONENT {
            return self.product(Number::ONE, &[(node, exponent)]);
        }
        self.call_unfolded(Function::Pow, &[Atom::Node(node), Atom::Constant(Number::integer(exponent))])
    }

    /// q · Π xᵢ
    pub(crate) fn product_of(&mut self, coefficient: Number, atoms: &[Atom]) -> Atom {
        let mut q = coefficient;
        let mut factors = Vec::with_capacity(atoms.len());
        for &atom in atoms {
            match atom {
                Atom::Constant(c) => q = q * c,
                Atom::Node(node) => factors.push((node, 1)),
            }
        }
        self.product(q, &factors)
    }

    /// Σ qᵢ xᵢ
    pub(crate) fn sum_of(&mut self, atoms: &[(Atom, Number)]) -> Atom {
        let mut constant = Number::ZERO;
        let mut terms = Vec::with_capacity(atoms.len());
        for &(atom, q) in atoms {
            match atom {
                Atom::Constant(c) => constant = constant + q * c,
                Atom::Node(node) => terms.push((node, q)),
            }
        }
        self.sum(constant, &terms)
    }

    /// x^e
    pub(crate) fn powi(&mut self, x: Atom, exponent: i32) -> Atom {
        match x {
            Atom::Constant(c) if c.is_zero() && exponent < 0 => self.divide(Atom::ONE, x),
            Atom::Constant(c) => Atom::Constant(c.powi(exponent)),
            Atom::Node(node) => self.product(Number::ONE, &[(node, exponent)]),
        }
    }

    /// x/y; if the divisor is identically zero, this is recorded, and the quotient is undefined.
    pub(crate) fn divide(&mut self, x: Atom, y: Atom) -> Atom {
        if y.is_zero() {
            self.zero_divisions.push(x);
            return Atom::Constant(Number::UNDEFINED);
        }
        let reciprocal = self.powi(y, -1);
        self.product_of(Number::ONE, &[x, reciprocal])
    }
}

/// The greatest common content of a linear combination, with the sign of its first term; for a sum
/// whose content is not an exact rational, only the sign.
fn content(constant: Number, terms: &[(NodeId, Number)]) -> Number {
    let sign = if terms[0].1.is_negative() { Number::MINUS_ONE } else { Number::ONE };
    let coefficients = || terms.iter().map(|&(_, q)| q).chain((!constant.is_zero()).then_some(constant));
    let content = coefficients().try_fold(Number::ZERO, Number::content);
    match content {
        Some(content) if !content.is_one() => {
            let divisor = content.recip();
            let exact = coefficients().all(|q| matches!(q * divisor, Number::Rational { .. }));
            // Denominators are cleared only if all coefficients become one.
            let simple = matches!(content, Number::Rational { den: 1, .. })
                || terms.iter().all(|&(_, q)| (q * divisor).abs().is_one());
            if exact && simple { content * sign } else { sign }
        }
        _ => sign,
    }
}

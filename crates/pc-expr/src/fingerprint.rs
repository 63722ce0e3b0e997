//! Fingerprints: the value of a node at two random points of GF(2⁶¹−1).
//!
//! Equal fingerprints mean equal as rational functions of the symbols, of e^{z/12} and of the points
//! (cos z/12, sin z/12) of the circle, with an error probability of about 2⁻¹²⁰ times the degree (Schwartz 1980,
//! Zippel 1979). Every other function is an unknown keyed by its arguments, so that √(x²) never becomes x.
//! A fingerprint depends on names and structure only, so two graphs agree on it.

use crate::dag::{Candidate, Dag, Node, NodeId};
use crate::field::{Element, mix};
use crate::function::{Function, Parity};
use crate::number::Number;

/// Number of independent points.
const POINTS: usize = 2;
/// sin, cos and exp of q·z are composed from those of z/FRACTION where that is an integer multiple.
const FRACTION: i32 = 12;
/// Largest such multiple.
const MAX_MULTIPLE: i32 = 100 * FRACTION;

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub(crate) struct Fingerprint([Element; POINTS]);

impl Fingerprint {
    pub(crate) fn constant(c: Number) -> Fingerprint {
        let value = match c {
            Number::Rational { num, den: 1 } => Element::integer(num),
            Number::Rational { num, den } => Element::integer(num) * Element::integer(den).inverse(),
            Number::Real(value) => Element::dyadic(value),
        };
        Fingerprint([value; POINTS])
    }

    pub(crate) fn symbol(name: &str) -> Fingerprint {
        let key = name.bytes().fold(0, |key, byte| mix(key ^ u64::from(byte)));
        Fingerprint::random(key)
    }

    fn random(key: u64) -> Fingerprint {
        Fingerprint(std::array::from_fn(|point| Element::random(mix(key) ^ point as u64)))
    }

    /// The value at the first point.
    pub(crate) fn first(self) -> Element {
        self.0[0]
    }

    /// The fingerprint as the key of something else.
    fn key(self, salt: u64) -> u64 {
        self.0.iter().fold(salt, |key, value| mix(key ^ value.to_bits()))
    }

    /// The rational constant, if this is one with numerator and denominator up to 2²⁰.
    pub(crate) fn small_rational(self) -> Option<(i64, i64)> {
        (self.0[0] == self.0[1]).then(|| self.0[0].small_rational()).flatten()
    }

    fn has_canonical_sign(self) -> bool {
        self.0[0].is_canonical_sign()
    }

    /// The same for x and −x.
    pub(crate) fn up_to_sign(self) -> Fingerprint {
        if self.has_canonical_sign() { self } else { self.map(|value| -value) }
    }

    fn map(self, f: impl Fn(Element) -> Element) -> Fingerprint {
        Fingerprint(self.0.map(f))
    }

    fn combine(self, other: Fingerprint, f: impl Fn(Element, Element) -> Element) -> Fingerprint {
        Fingerprint(std::array::from_fn(|point| f(self.0[point], other.0[point])))
    }

    fn plus(self, other: Fingerprint) -> Fingerprint {
        self.combine(other, |a, b| a + b)
    }

    fn times(self, other: Fingerprint) -> Fingerprint {
        self.combine(other, |a, b| a * b)
    }

    fn powi(self, exponent: i32) -> Fingerprint {
        self.map(|value| value.powi(exponent))
    }
}

/// A point (c, s) of the circle c² + s² = 1.
#[derive(Clone, Copy)]
struct CirclePoint {
    cos: Fingerprint,
    sin: Fingerprint,
}

impl CirclePoint {
    fn zero() -> CirclePoint {
        CirclePoint { cos: Fingerprint::constant(Number::ONE), sin: Fingerprint::constant(Number::ZERO) }
    }

    /// A random point of the circle by its rational parametrisation.
    fn random(key: u64) -> CirclePoint {
        let u = Fingerprint::random(key);
        let scale = u.map(|u| (Element::ONE + u * u).inverse());
        CirclePoint {
            cos: u.combine(scale, |u, scale| (Element::ONE - u * u) * scale),
            sin: u.combine(scale, |u, scale| (u + u) * scale),
        }
    }

    fn plus(self, other: CirclePoint) -> CirclePoint {
        let minus = |a: Fingerprint, b: Fingerprint| a.combine(b, |a, b| a - b);
        CirclePoint {
            cos: minus(self.cos.times(other.cos), self.sin.times(other.sin)),
            sin: self.sin.times(other.cos).plus(self.cos.times(other.sin)),
        }
    }

    fn negated(self) -> CirclePoint {
        CirclePoint { cos: self.cos, sin: self.sin.map(|s| -s) }
    }

    fn multiple(self, n: i32) -> CirclePoint {
        let mut square = if n < 0 { self.negated() } else { self };
        let mut result = CirclePoint::zero();
        let mut rest = n.unsigned_abs();
        while rest > 0 {
            if rest & 1 == 1 {
                result = result.plus(square);
            }
            square = square.plus(square);
            rest >>= 1;
        }
        result
    }
}

const SALT_CIRCLE: u64 = 0x5ca1_ab1e;
const SALT_EXP: u64 = 0xe4b0_4e47;

impl Dag {
    pub(crate) fn fingerprint_of(&self, candidate: &Candidate<'_>) -> Fingerprint {
        match *candidate {
            Candidate::Constant(c) => Fingerprint::constant(c),
            Candidate::Symbol(name) => Fingerprint::symbol(name),
            Candidate::Sum(constant, terms) => {
                terms.iter().fold(Fingerprint::constant(constant), |sum, &(node, q)| {
                    sum.plus(self.scaled_fingerprint(node, q))
                })
            }
            Candidate::Product(factors) => {
                factors.iter().fold(Fingerprint::constant(Number::ONE), |product, &(node, e)| {
                    product.times(self.fingerprint(node).powi(e))
                })
            }
            Candidate::Call(function, args) => self.call_fingerprint(function, Dag::args(function, &args)),
        }
    }

    fn scaled_fingerprint(&self, node: NodeId, q: Number) -> Fingerprint {
        let value = self.fingerprint(node);
        if q.is_one() {
            value
        } else if (-q).is_one() {
            value.map(|x| -x)
        } else {
            value.times(Fingerprint::constant(q))
        }
    }

    fn call_fingerprint(&self, function: Function, args: &[NodeId]) -> Fingerprint {
        let half = Number::ratio(1, 2);
        match function {
            Function::Sin => self.circle_point(args[0]).sin,
            Function::Cos => self.circle_point(args[0]).cos,
            Function::Exp => self.exponential(args[0]),
            Function::Sinh | Function::Cosh | Function::Tanh => {
                let exp = self.exponential(args[0]);
                let inverse = exp.powi(-1);
                let cosh = exp.plus(inverse).times(Fingerprint::constant(half));
                let sinh = exp.combine(inverse, |a, b| a - b).times(Fingerprint::constant(half));
                match function {
                    Function::Sinh => sinh,
                    Function::Cosh => cosh,
                    _ => sinh.times(cosh.powi(-1)),
                }
            }
            _ => self.unknown(function, args),
        }
    }

    /// A random value keyed by the function and its arguments; odd and even functions keep their symmetry.
    fn unknown(&self, function: Function, args: &[NodeId]) -> Fingerprint {
        let parity = function.parity();
        let keep_sign = parity == Parity::None;
        let key = args.iter().fold(function as u64, |key, &arg| {
            let value = self.fingerprint(arg);
            (if keep_sign { value } else { value.up_to_sign() }).key(key)
        });
        let value = Fingerprint::random(key);
        if parity == Parity::Odd && !self.fingerprint(args[0]).has_canonical_sign() {
            value.map(|x| -x)
        } else {
            value
        }
    }

    /// (cos u, sin u) by the group law of the circle from one random point for each term of u.
    fn circle_point(&self, u: NodeId) -> CirclePoint {
        let mut point = CirclePoint::zero();
        self.for_each_linear_term(u, |value, multiple| {
            let base = CirclePoint::random(value.up_to_sign().key(SALT_CIRCLE));
            let base = if value.has_canonical_sign() { base } else { base.negated() };
            point = point.plus(base.multiple(multiple));
        });
        point
    }

    /// e^u, as a product over the terms of u.
    fn exponential(&self, u: NodeId) -> Fingerprint {
        let mut exponential = Fingerprint::constant(Number::ONE);
        self.for_each_linear_term(u, |value, multiple| {
            let base = Fingerprint::random(value.up_to_sign().key(SALT_EXP));
            let multiple = if value.has_canonical_sign() { multiple } else { -multiple };
            exponential = exponential.times(base.powi(multiple));
        });
        exponential
    }

    /// Writes u as Σ (m/12)·z with integers m and calls `visit` with the fingerprints of the z and the m.
    fn for_each_linear_term(&self, u: NodeId, mut visit: impl FnMut(Fingerprint, i32)) {
        let multiple =
            |q: Number| (q * Number::integer(FRACTION)).as_integer().filter(|m| m.abs() <= MAX_MULTIPLE);
        let mut constant = Number::ZERO;
        let mut open = vec![(u, Number::ONE)];
        while let Some((node, q)) = open.pop() {
            match self.node(node) {
                Node::Sum { constant: c, terms } => {
                    constant = constant + q * c;
                    open.extend(
                        self.terms(terms).iter().map(|&(child, coefficient)| (child, q * coefficient)),
                    );
                }
                Node::Constant(c) => constant = constant + q * c,
                _ => match multiple(q) {
                    Some(m) => visit(self.fingerprint(node), m),
                    None => visit(self.scaled_fingerprint(node, q), FRACTION),
                },
            }
        }
        if !constant.is_zero() {
            match multiple(constant) {
                Some(m) => visit(Fingerprint::constant(Number::ONE), m),
                None => visit(Fingerprint::constant(constant), FRACTION),
            }
        }
    }
}

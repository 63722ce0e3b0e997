//! Fingerprints: the value of a node at a random point of each of two prime fields, GF(2⁶¹−1) and GF(2⁶¹−45).
//!
//! Equal fingerprints mean equal as rational functions of the symbols, of e^{z/12} and of the points
//! (cos z/12, sin z/12) of the circle, with an error probability of about 2⁻¹²⁰ times the degree (Schwartz 1980,
//! Zippel 1979). There are two primes because constants are not random: in the first field 2⁶¹·x is x, while no two
//! of our rationals agree in both. Every other function is an unknown keyed by its arguments, so that √(x²) never
//! becomes x. A fingerprint depends on names and structure only, so two graphs agree on it.

use crate::dag::{Candidate, Dag, Node, NodeId};
use crate::field::{Element, mix};
use crate::function::{Function, Parity};
use crate::number::Number;

/// sin, cos and exp of q·z are composed from those of z/FRACTION where that is an integer multiple.
const FRACTION: i32 = 12;
/// Largest such multiple.
const MAX_MULTIPLE: i32 = 100 * FRACTION;
/// Sums inside the argument of a sine or exponential are opened up to so many terms; what is left counts as one term.
const MAX_TERMS: usize = 1 << 14;

/// The first of the two fields.
pub(crate) type First = Element<1>;
type Second = Element<45>;

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub(crate) struct Fingerprint(First, Second);

impl Fingerprint {
    const ZERO: Fingerprint = Fingerprint(First::ZERO, Second::ZERO);
    const ONE: Fingerprint = Fingerprint(First::ONE, Second::ONE);

    pub(crate) fn constant(c: Number) -> Fingerprint {
        match c {
            Number::Rational { num, den: 1 } => Fingerprint::integer(num),
            Number::Rational { num, den } => {
                Fingerprint::integer(num).times(Fingerprint::integer(den).powi(-1))
            }
            Number::Real(value) => Fingerprint(Element::dyadic(value), Element::dyadic(value)),
        }
    }

    fn integer(value: i64) -> Fingerprint {
        Fingerprint(Element::integer(value), Element::integer(value))
    }

    pub(crate) fn symbol(name: &str) -> Fingerprint {
        let key = name.bytes().fold(0, |key, byte| mix(key ^ u64::from(byte)));
        Fingerprint::random(key)
    }

    fn random(key: u64) -> Fingerprint {
        Fingerprint(Element::random(mix(key)), Element::random(mix(key) ^ 1))
    }

    /// The value in the first field.
    pub(crate) fn first(self) -> First {
        self.0
    }

    /// The fingerprint as the key of something else.
    fn key(self, salt: u64) -> u64 {
        mix(mix(salt ^ self.0.to_bits()) ^ self.1.to_bits())
    }

    /// The rational constant, if this is one with numerator and denominator up to 2²⁰.
    pub(crate) fn small_rational(self) -> Option<(i64, i64)> {
        self.0.small_rational().filter(|&(p, q)| Element::integer(p) == Element::integer(q) * self.1)
    }

    fn has_canonical_sign(self) -> bool {
        self.0.is_canonical_sign()
    }

    /// The same for x and −x.
    pub(crate) fn up_to_sign(self) -> Fingerprint {
        if self.has_canonical_sign() { self } else { self.negated() }
    }

    fn plus(self, other: Fingerprint) -> Fingerprint {
        Fingerprint(self.0 + other.0, self.1 + other.1)
    }

    fn minus(self, other: Fingerprint) -> Fingerprint {
        Fingerprint(self.0 - other.0, self.1 - other.1)
    }

    pub(crate) fn times(self, other: Fingerprint) -> Fingerprint {
        Fingerprint(self.0 * other.0, self.1 * other.1)
    }

    fn negated(self) -> Fingerprint {
        Fingerprint(-self.0, -self.1)
    }

    pub(crate) fn powi(self, exponent: i32) -> Fingerprint {
        Fingerprint(self.0.powi(exponent), self.1.powi(exponent))
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
        CirclePoint { cos: Fingerprint::ONE, sin: Fingerprint::ZERO }
    }

    /// A random point of the circle by its rational parametrisation.
    fn random(key: u64) -> CirclePoint {
        let u = Fingerprint::random(key);
        let square = u.times(u);
        let scale = Fingerprint::ONE.plus(square).powi(-1);
        CirclePoint { cos: Fingerprint::ONE.minus(square).times(scale), sin: u.plus(u).times(scale) }
    }

    fn plus(self, other: CirclePoint) -> CirclePoint {
        CirclePoint {
            cos: self.cos.times(other.cos).minus(self.sin.times(other.sin)),
            sin: self.sin.times(other.cos).plus(self.cos.times(other.sin)),
        }
    }

    fn negated(self) -> CirclePoint {
        CirclePoint { cos: self.cos, sin: self.sin.negated() }
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
            Candidate::Product(factors) => factors
                .iter()
                .fold(Fingerprint::ONE, |product, &(node, e)| product.times(self.fingerprint(node).powi(e))),
            Candidate::Call(function, args) => self.call_fingerprint(function, Dag::args(function, &args)),
        }
    }

    fn scaled_fingerprint(&self, node: NodeId, q: Number) -> Fingerprint {
        let value = self.fingerprint(node);
        if q.is_one() {
            value
        } else if (-q).is_one() {
            value.negated()
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
                let sinh = exp.minus(inverse).times(Fingerprint::constant(half));
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
            value.negated()
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
        let mut exponential = Fingerprint::ONE;
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
        let mut opened = 0;
        while let Some((node, q)) = open.pop() {
            match self.node(node) {
                Node::Sum { constant: c, terms }
                    if opened < MAX_TERMS
                        && q.checked_mul(c).is_some()
                        && self.terms(terms).iter().all(|&(_, r)| q.checked_mul(r).is_some()) =>
                {
                    opened += terms.range().len();
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
                Some(m) => visit(Fingerprint::ONE, m),
                None => visit(Fingerprint::constant(constant), FRACTION),
            }
        }
    }
}

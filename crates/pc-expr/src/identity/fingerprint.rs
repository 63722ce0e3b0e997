//! Fingerprints: the value of a node at a random point of each of two prime fields, GF(2⁶¹−1) and GF(2⁶¹−45).
//!
//! Equal fingerprints mean equality as rational functions of the symbols, of e^{z/12} and of the points (cos
//! z/12, sin z/12) of the circle, with an error probability of about 2⁻¹²⁰ times the degree (Schwartz 1980,
//! Zippel 1979). There are two primes because constants are not random: in the first field 2⁶¹·x is x, while
//! no two of our rationals agree in both. Roots, |x| and x^(p/q) obey the laws of their powers, and of
//! products as far as signs are known: (√x + 1)(√x − 1) = x − 1, √(x²y) = |x| √y for y ≥ 0, but √(x²) never
//! becomes x. Logarithms and inverse functions of angles obey the laws that hold wherever both sides have
//! values. Every other function is an unknown keyed by its arguments. A fingerprint depends on names and
//! structure only, so two graphs agree on it.

use crate::identity::prime_field::{Residue, mix};

type First = Residue<1>;
type Second = Residue<45>;

#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub(crate) struct Fingerprint(First, Second);

impl Fingerprint {
    pub(crate) const ZERO: Fingerprint = Fingerprint(First::ZERO, Second::ZERO);
    pub(crate) const ONE: Fingerprint = Fingerprint(First::ONE, Second::ONE);

    pub(crate) fn integer(value: i64) -> Fingerprint {
        Fingerprint(Residue::integer(value), Residue::integer(value))
    }

    /// The fingerprint of a finite f64, which is a dyadic rational.
    pub(crate) fn dyadic(value: f64) -> Fingerprint {
        Fingerprint(Residue::dyadic(value), Residue::dyadic(value))
    }

    pub(crate) fn symbol(name: &str) -> Fingerprint {
        let key = name.bytes().fold(0, |key, byte| mix(key ^ u64::from(byte)));
        Fingerprint::random(key)
    }

    pub(crate) fn random(key: u64) -> Fingerprint {
        Fingerprint(Residue::random(mix(key)), Residue::random(mix(key) ^ 1))
    }

    /// The value in the first field.
    pub(crate) fn first(self) -> Residue {
        self.0
    }

    /// A key derived from the fingerprint.
    pub(crate) fn key(self, salt: u64) -> u64 {
        mix(mix(salt ^ self.0.to_bits()) ^ self.1.to_bits())
    }

    /// The rational constant, if this is one with numerator and denominator up to 2²⁰.
    pub(crate) fn small_rational(self) -> Option<(i64, i64)> {
        self.0.small_rational().filter(|&(p, q)| Residue::integer(p) == Residue::integer(q) * self.1)
    }

    pub(crate) fn has_canonical_sign(self) -> bool {
        self.0.is_canonical_sign()
    }

    /// A value that is the same for x and −x.
    pub(crate) fn up_to_sign(self) -> Fingerprint {
        if self.has_canonical_sign() { self } else { self.negated() }
    }

    pub(crate) fn plus(self, other: Fingerprint) -> Fingerprint {
        Fingerprint(self.0 + other.0, self.1 + other.1)
    }

    pub(crate) fn minus(self, other: Fingerprint) -> Fingerprint {
        Fingerprint(self.0 - other.0, self.1 - other.1)
    }

    pub(crate) fn times(self, other: Fingerprint) -> Fingerprint {
        Fingerprint(self.0 * other.0, self.1 * other.1)
    }

    pub(crate) fn negated(self) -> Fingerprint {
        Fingerprint(-self.0, -self.1)
    }

    pub(crate) fn powi(self, exponent: i32) -> Fingerprint {
        Fingerprint(self.0.powi(exponent), self.1.powi(exponent))
    }
}

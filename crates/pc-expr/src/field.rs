//! Arithmetic in the prime field GF(2⁶¹−1), in which expressions are tested for identity.

/// 2⁶¹ − 1
pub(crate) const PRIME: u64 = (1 << 61) - 1;

/// Largest numerator and denominator that [`Element::small_rational`] recognises.
const SMALL: u64 = 1 << 20;

/// An element of GF(2⁶¹−1), kept in 0..PRIME.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub(crate) struct Element(u64);

impl Element {
    pub(crate) const ZERO: Element = Element(0);
    pub(crate) const ONE: Element = Element(1);

    /// Folds 61-bit halves: 2⁶¹ ≡ 1.
    fn reduce(value: u128) -> Element {
        let folded = (value as u64 & PRIME) + (value >> 61) as u64;
        Element(if folded >= PRIME { folded - PRIME } else { folded })
    }

    /// A pseudo-random element determined by `key` (splitmix64).
    pub(crate) fn random(key: u64) -> Element {
        Element::reduce(u128::from(mix(key)))
    }

    pub(crate) fn integer(value: i64) -> Element {
        let size = Element::reduce(u128::from(value.unsigned_abs()));
        if value < 0 { -size } else { size }
    }

    /// A finite f64 is the dyadic rational m·2^e, exactly.
    pub(crate) fn dyadic(value: f64) -> Element {
        let bits = value.to_bits();
        let biased = ((bits >> 52) & 0x7ff) as i32;
        let fraction = bits & ((1 << 52) - 1);
        let (mantissa, exponent) =
            if biased == 0 { (fraction, -1074) } else { (fraction | (1 << 52), biased - 1075) };
        let power = Element(1 << exponent.rem_euclid(61)); // 2⁶¹ ≡ 1
        let size = Element::reduce(u128::from(mantissa)) * power;
        if value < 0.0 { -size } else { size }
    }

    pub(crate) fn pow(self, mut exponent: u64) -> Element {
        let (mut result, mut square) = (Element::ONE, self);
        while exponent > 0 {
            if exponent & 1 == 1 {
                result = result * square;
            }
            square = square * square;
            exponent >>= 1;
        }
        result
    }

    /// x^e for a signed exponent; 0 to a negative power is 0 (callers refuse zero divisors before).
    pub(crate) fn powi(self, exponent: i32) -> Element {
        if exponent < 0 {
            self.inverse().pow(u64::from(exponent.unsigned_abs()))
        } else {
            self.pow(exponent as u64)
        }
    }

    /// Inverse by the extended Euclidean algorithm; 0 for 0.
    pub(crate) fn inverse(self) -> Element {
        let (mut r0, mut r1) = (PRIME as i64, self.0 as i64);
        let (mut s0, mut s1) = (0i64, 1i64);
        while r1 != 0 {
            let q = r0 / r1;
            (r0, r1) = (r1, r0 - q * r1);
            (s0, s1) = (s1, s0 - q * s1);
        }
        if self.0 == 0 { Element::ZERO } else { Element::integer(s0) }
    }

    /// The pair (p, q), both at most 2²⁰ in size, with p = x·q, if there is one (rational reconstruction).
    pub(crate) fn small_rational(self) -> Option<(i64, i64)> {
        if self.0 <= SMALL {
            return Some((self.0 as i64, 1));
        }
        let (mut r0, mut r1) = (PRIME, self.0);
        let (mut s0, mut s1) = (0i64, 1i64);
        while r1 > SMALL {
            let q = r0 / r1;
            (r0, r1) = (r1, r0 - q * r1);
            (s0, s1) = (s1, s0 - q as i64 * s1);
            if s1.unsigned_abs() > SMALL {
                return None;
            }
        }
        Some(if s1 < 0 { (-(r1 as i64), -s1) } else { (r1 as i64, s1) })
    }

    /// Whether this is the smaller of x and −x: fixes one of the two as the representative of a class up to sign.
    pub(crate) fn is_canonical_sign(self) -> bool {
        self.0 <= PRIME / 2
    }

    pub(crate) fn to_bits(self) -> u64 {
        self.0
    }
}

/// The finaliser of splitmix64.
pub(crate) fn mix(key: u64) -> u64 {
    let mut z = key.wrapping_add(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

impl std::ops::Add for Element {
    type Output = Element;
    fn add(self, other: Element) -> Element {
        let sum = self.0 + other.0;
        Element(if sum >= PRIME { sum - PRIME } else { sum })
    }
}

impl std::ops::Neg for Element {
    type Output = Element;
    fn neg(self) -> Element {
        Element(if self.0 == 0 { 0 } else { PRIME - self.0 })
    }
}

impl std::ops::Sub for Element {
    type Output = Element;
    fn sub(self, other: Element) -> Element {
        self + -other
    }
}

impl std::ops::Mul for Element {
    type Output = Element;
    fn mul(self, other: Element) -> Element {
        Element::reduce(u128::from(self.0) * u128::from(other.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn field_laws() {
        for key in 0..200 {
            let (a, b, c) = (Element::random(key), Element::random(key + 1000), Element::random(key + 2000));
            assert_eq!(a * (b + c), a * b + a * c);
            assert_eq!((a * b) * c, a * (b * c));
            assert_eq!(a * a.inverse(), Element::ONE);
            assert_eq!(a - a, Element::ZERO);
            assert_eq!(a.pow(PRIME - 1), Element::ONE);
            assert_eq!(a.powi(-3) * a.powi(3), Element::ONE);
        }
    }

    #[test]
    fn rationals_are_reconstructed() {
        for (p, q) in [(1, 3), (-7, 12), (0, 1), (999_983, 1_000_003), (-5, 1), (1, 1 << 20)] {
            let x = Element::integer(p) * Element::integer(q).inverse();
            let (r, s) = x.small_rational().unwrap();
            assert_eq!(p * s, q * r);
        }
        let recognised = (0..2000).filter(|&key| Element::random(key).small_rational().is_some()).count();
        assert!(recognised < 10, "{recognised} random elements taken for constants");
    }

    #[test]
    fn dyadic_rationals_are_exact() {
        assert_eq!(Element::dyadic(0.75), Element::integer(3) * Element::integer(4).inverse());
        assert_eq!(Element::dyadic(-6.0), Element::integer(-6));
        assert_eq!(
            Element::dyadic(5e-324) * Element::dyadic(2f64.powi(1000)),
            Element::dyadic(2f64.powi(-74))
        );
    }
}

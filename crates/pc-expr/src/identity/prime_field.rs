//! Arithmetic in the prime fields GF(2⁶¹−c), in which expressions are tested for identity.

/// Largest numerator and denominator that [`Residue::small_rational`] recognises.
const SMALL: u64 = 1 << 20;

/// An element of the field GF(p) of the prime p = 2⁶¹ − `C`, by default of Mersenne's prime 2⁶¹ − 1.
///
/// Identities of rational numbers hold for their residues, unless p divides a denominator, and nothing is rounded. So
/// a matrix of residues at a random point has the rank of the matrix of functions, except with a probability of about
/// its degree divided by p \[J. T. Schwartz, J. ACM 27 (1980) 701\].
///
/// ```
/// use pc_expr::{Number, Residue};
/// let third = Number::ratio(1, 3).residue().expect("rational");
/// assert_eq!(third * Residue::integer(6), Residue::integer(2));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Default)]
pub struct Residue<const C: u64 = 1>(u64); // in 0..p

impl<const C: u64> Residue<C> {
    /// 0
    pub const ZERO: Residue<C> = Residue(0);
    /// 1
    pub const ONE: Residue<C> = Residue(1);
    const PRIME: u64 = (1 << 61) - C;

    /// Folds 61-bit halves, twice: 2⁶¹ ≡ C.
    fn reduce(value: u128) -> Residue<C> {
        const HALF: u128 = (1 << 61) - 1;
        let once = (value & HALF) + (value >> 61) * u128::from(C);
        let twice = (once & HALF) as u64 + (once >> 61) as u64 * C;
        Residue(if twice >= Self::PRIME { twice - Self::PRIME } else { twice })
    }

    /// A pseudo-random element determined by `key` (splitmix64).
    pub(crate) fn random(key: u64) -> Residue<C> {
        Residue::reduce(u128::from(mix(key)))
    }

    /// Pseudo-random elements determined by `seed`: those of splitmix64.
    pub fn sequence(seed: u64) -> impl Iterator<Item = Residue<C>> {
        std::iter::successors(Some(seed), |state| Some(state.wrapping_add(GOLDEN))).map(Residue::random)
    }

    /// The residue of an integer.
    pub fn integer(value: i64) -> Residue<C> {
        let size = Residue::reduce(u128::from(value.unsigned_abs()));
        if value < 0 { -size } else { size }
    }

    /// The residue of a finite f64, which is exactly a dyadic rational m·2^e.
    pub(crate) fn dyadic(value: f64) -> Residue<C> {
        let bits = value.to_bits();
        let biased = ((bits >> 52) & 0x7ff) as i32;
        let fraction = bits & ((1 << 52) - 1);
        let (mantissa, exponent) =
            if biased == 0 { (fraction, -1074) } else { (fraction | (1 << 52), biased - 1075) };
        let size = Residue::reduce(u128::from(mantissa)) * Residue(2).powi(exponent);
        if value < 0.0 { -size } else { size }
    }

    pub(crate) fn pow(self, mut exponent: u64) -> Residue<C> {
        let (mut result, mut square) = (Residue::ONE, self);
        while exponent > 0 {
            if exponent & 1 == 1 {
                result = result * square;
            }
            square = square * square;
            exponent >>= 1;
        }
        result
    }

    /// x^e for a signed exponent; 0 to a negative power is 0 (callers reject zero divisors beforehand).
    pub(crate) fn powi(self, exponent: i32) -> Residue<C> {
        if exponent < 0 {
            self.inverse().pow(u64::from(exponent.unsigned_abs()))
        } else {
            self.pow(exponent as u64)
        }
    }

    /// Inverse by the extended Euclidean algorithm; 0 for 0.
    #[must_use]
    pub fn inverse(self) -> Residue<C> {
        let (mut r0, mut r1) = (Self::PRIME as i64, self.0 as i64);
        let (mut s0, mut s1) = (0i64, 1i64);
        while r1 != 0 {
            let q = r0 / r1;
            (r0, r1) = (r1, r0 - q * r1);
            (s0, s1) = (s1, s0 - q * s1);
        }
        if self.0 == 0 { Residue::ZERO } else { Residue::integer(s0) }
    }

    /// The pair (p, q), both at most 2²⁰ in size, with p = x·q, if there is one (rational reconstruction).
    pub(crate) fn small_rational(self) -> Option<(i64, i64)> {
        if self.0 <= SMALL {
            return Some((self.0 as i64, 1));
        }
        let (mut r0, mut r1) = (Self::PRIME, self.0);
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
        self.0 <= Self::PRIME / 2
    }

    pub(crate) fn to_bits(self) -> u64 {
        self.0
    }
}

/// 2⁶⁴ over the golden ratio: the increment of the state of splitmix64.
const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// The finaliser of splitmix64.
pub(crate) fn mix(key: u64) -> u64 {
    let mut z = key.wrapping_add(GOLDEN);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

impl<const C: u64> std::ops::Add for Residue<C> {
    type Output = Residue<C>;
    fn add(self, other: Residue<C>) -> Residue<C> {
        let sum = self.0 + other.0;
        Residue(if sum >= Self::PRIME { sum - Self::PRIME } else { sum })
    }
}

impl<const C: u64> std::ops::Neg for Residue<C> {
    type Output = Residue<C>;
    fn neg(self) -> Residue<C> {
        Residue(if self.0 == 0 { 0 } else { Self::PRIME - self.0 })
    }
}

impl<const C: u64> std::ops::Sub for Residue<C> {
    type Output = Residue<C>;
    fn sub(self, other: Residue<C>) -> Residue<C> {
        self + -other
    }
}

impl<const C: u64> std::ops::Mul for Residue<C> {
    type Output = Residue<C>;
    fn mul(self, other: Residue<C>) -> Residue<C> {
        Residue::reduce(u128::from(self.0) * u128::from(other.0))
    }
}

impl<const C: u64> std::iter::Sum for Residue<C> {
    fn sum<I: Iterator<Item = Residue<C>>>(terms: I) -> Residue<C> {
        terms.fold(Residue::ZERO, |sum, x| sum + x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn field_laws<const C: u64>() {
        for key in 0..200 {
            let (a, b, c): (Residue<C>, _, _) =
                (Residue::random(key), Residue::random(key + 1000), Residue::random(key + 2000));
            assert_eq!(a * (b + c), a * b + a * c);
            assert_eq!((a * b) * c, a * (b * c));
            assert_eq!(a * a.inverse(), Residue::ONE);
            assert_eq!(a + -a, Residue::ZERO);
            assert_eq!(a.pow(Residue::<C>::PRIME - 1), Residue::ONE);
            assert_eq!(a.powi(-3) * a.powi(3), Residue::ONE);
        }
        let largest = -Residue::<C>::ONE;
        assert_eq!(largest * largest, Residue::ONE);
    }

    #[test]
    fn both_fields_obey_the_laws() {
        field_laws::<1>();
        field_laws::<45>();
    }

    #[test]
    fn fractions_multiply_exactly() {
        let residue = |num, den| Residue::<1>::integer(num) * Residue::integer(den).inverse();
        assert_eq!(residue(-2, 3) * residue(9, 4), residue(-3, 2));
        assert_eq!(residue(-2, 3) + residue(1, 6), residue(-1, 2));
        assert_eq!(residue(1, 3) - residue(1, 3), Residue::ZERO);
    }

    #[test]
    fn rationals_are_reconstructed() {
        for (p, q) in [(1, 3), (-7, 12), (0, 1), (999_983, 1_000_003), (-5, 1), (1, 1 << 20)] {
            let x = Residue::<1>::integer(p) * Residue::integer(q).inverse();
            let (r, s) = x.small_rational().unwrap();
            assert_eq!(p * s, q * r);
        }
        let recognised =
            (0..2000).filter(|&key| Residue::<1>::random(key).small_rational().is_some()).count();
        assert!(recognised < 10, "{recognised} random elements taken for constants");
    }

    #[test]
    fn dyadic_rationals_are_exact() {
        fn check<const C: u64>() {
            let dyadic = Residue::<C>::dyadic;
            assert_eq!(dyadic(0.75), Residue::integer(3) * Residue::integer(4).inverse());
            assert_eq!(dyadic(-6.0), Residue::integer(-6));
            assert_eq!(dyadic(5e-324) * dyadic(2f64.powi(1000)), dyadic(2f64.powi(-74)));
        }
        check::<1>();
        check::<45>();
    }
}

//! Constants: exact rationals as long as they are small, or small times a power of ten; rounded reals
//! otherwise.

use std::fmt;
use std::hash::{Hash, Hasher};

use crate::identity::fingerprint::Fingerprint;
use crate::identity::prime_field::Residue;

/// Largest numerator and denominator kept exactly: both are then exact in f64, and so their quotient is correctly
/// rounded.
const EXACT: i128 = 1 << 53;

/// A constant of the graph.
///
/// An `f64` given to the graph counts as the decimal number as which it is printed, so that `0.1 + 0.2` is 3/10, and
/// like terms cancel exactly, even with powers of units such as 10⁻⁹. Results that are neither a small rational nor a
/// small rational times a power of ten are rounded to `f64`.
#[derive(Clone, Copy, Debug)]
pub enum Number {
    /// `num / den` in lowest terms, `den > 0`, both at most 2⁵³ in size.
    Rational {
        /// Numerator.
        num: i64,
        /// Denominator, positive.
        den: i64,
    },
    /// `num / den · 10^exponent`, which is not a small rational: in lowest terms, both at most 2⁵³ in size, `den > 0` without a factor 2 or
    /// 5, and `num` without a factor 10.
    Scaled {
        /// Numerator.
        num: i64,
        /// Denominator, positive.
        den: i64,
        /// Exponent of ten.
        exponent: i16,
    },
    /// Any other value, NaN (undefined) included.
    Real(f64),
}

/// The maximum number of digits of a number that is taken to be meant as a decimal. A number with more digits
/// is taken to be the rounded result of a computation.
const DIGITS: usize = 15;

impl Number {
    /// 0
    pub const ZERO: Number = Number::integer(0);
    /// 1
    pub const ONE: Number = Number::integer(1);
    /// −1
    pub const MINUS_ONE: Number = Number::integer(-1);
    /// The value of an undefined expression, such as a quotient by zero.
    pub const UNDEFINED: Number = Number::Real(f64::NAN);

    /// A small integer.
    pub const fn integer(value: i32) -> Number {
        Number::Rational { num: value as i64, den: 1 }
    }

    /// `num / den`, rounded if it is not a small rational; [`UNDEFINED`](Number::UNDEFINED) for `den = 0`.
    pub fn ratio(num: i64, den: i64) -> Number {
        Number::reduce(i128::from(num), i128::from(den))
    }

    fn reduce(num: i128, den: i128) -> Number {
        match den {
            0 => Number::UNDEFINED,
            _ => Number::exact(num, den, 0).unwrap_or_else(|| Number::from(num as f64 / den as f64)),
        }
    }

    /// `num / den · 10^exponent` for `den ≠ 0`, if that can be represented and is within the range of f64.
    fn exact(num: i128, den: i128, exponent: i32) -> Option<Number> {
        if num == 0 {
            return Some(Number::ZERO);
        }
        let divisor = gcd(num.unsigned_abs(), den.unsigned_abs()).cast_signed() * den.signum();
        let (mut num, mut den, mut exponent) = (num / divisor, den / divisor, exponent);
        if exponent == 0 && num.abs() <= EXACT && den <= EXACT {
            return Some(Number::Rational { num: num as i64, den: den as i64 });
        }
        for (factor, other) in [(10, 1), (2, 5), (5, 2)] {
            while den % factor == 0 {
                (num, den, exponent) = (num.checked_mul(other)?, den / factor, exponent - 1);
            }
        }
        while num % 10 == 0 {
            (num, exponent) = (num / 10, exponent + 1);
        }
        let power = |exponent: i32| 10i128.checked_pow(exponent.max(0).unsigned_abs());
        let whole = || num.checked_mul(power(exponent)?).zip(den.checked_mul(power(-exponent)?));
        if let Some(small) = whole().and_then(|(num, den)| Number::small(num, den)) {
            return Some(small);
        }
        let held = num.abs() <= EXACT && den <= EXACT;
        let scaled =
            Number::Scaled { num: num as i64, den: den as i64, exponent: i16::try_from(exponent).ok()? };
        (held && scaled.to_f64().is_normal()).then_some(scaled)
    }

    /// Numerator, denominator and exponent of ten of an exact number.
    fn parts(self) -> Option<(i128, i128, i32)> {
        match self {
            Number::Rational { num, den } => Some((num.into(), den.into(), 0)),
            Number::Scaled { num, den, exponent } => Some((num.into(), den.into(), exponent.into())),
            Number::Real(_) => None,
        }
    }

    /// The value of the number in each of two prime fields; this value does not depend on the random points
    /// in the fields.
    pub(crate) fn fingerprint(self) -> Fingerprint {
        match self {
            Number::Rational { num, den: 1 } => Fingerprint::integer(num),
            Number::Rational { num, den } => {
                Fingerprint::integer(num).times(Fingerprint::integer(den).powi(-1))
            }
            Number::Scaled { num, den, exponent } => {
                let quotient = Fingerprint::integer(num).times(Fingerprint::integer(den).powi(-1));
                quotient.times(Fingerprint::integer(10).powi(exponent.into()))
            }
            Number::Real(value) => Fingerprint::dyadic(value),
        }
    }

    /// The residue of the number; `None` if it is rounded. Denominators are below the prime, so none is 0.
    pub fn residue(self) -> Option<Residue> {
        (!self.is_rounded()).then(|| self.fingerprint().first())
    }

    /// Whether the exact value is unknown.
    pub fn is_rounded(self) -> bool {
        matches!(self, Number::Real(_))
    }

    fn whole(value: i128) -> Number {
        match value.abs() <= EXACT {
            true => Number::Rational { num: value as i64, den: 1 },
            false => Number::reduce(value, 1),
        }
    }

    /// `num / den` for `den ≠ 0`, if it is a small rational.
    fn small(num: i128, den: i128) -> Option<Number> {
        let divisor = gcd(num.unsigned_abs(), den.unsigned_abs()).cast_signed();
        let (num, den) =
            if den < 0 { (-num / divisor, -den / divisor) } else { (num / divisor, den / divisor) };
        let small = num.abs() <= EXACT && den <= EXACT;
        small.then_some(Number::Rational { num: num as i64, den: den as i64 })
    }

    /// The nearest `f64`.
    pub fn to_f64(self) -> f64 {
        match self {
            Number::Rational { num, den } => num as f64 / den as f64,
            Number::Scaled { num, den, exponent } => {
                // Correctly rounded for decimals.
                let decimal = |num: i64| format!("{num}e{exponent}").parse().unwrap_or(f64::NAN);
                if den == 1 { decimal(num) } else { num as f64 / den as f64 * decimal(1) }
            }
            Number::Real(value) => value,
        }
    }

    /// Whether this is exactly 0.
    pub fn is_zero(self) -> bool {
        matches!(self, Number::Rational { num: 0, .. }) || matches!(self, Number::Real(0.0))
    }

    /// Whether this is exactly 1.
    pub fn is_one(self) -> bool {
        matches!(self, Number::Rational { num: 1, den: 1 })
    }

    /// Whether this is below 0.
    pub fn is_negative(self) -> bool {
        match self {
            Number::Rational { num, .. } | Number::Scaled { num, .. } => num < 0,
            Number::Real(value) => value < 0.0,
        }
    }

    /// Whether this is a number at all: not NaN and not infinite.
    pub fn is_finite(self) -> bool {
        match self {
            Number::Rational { .. } | Number::Scaled { .. } => true,
            Number::Real(value) => value.is_finite(),
        }
    }

    /// The value as an integer, if it is an integer within the range of the type.
    pub fn as_integer(self) -> Option<i32> {
        match self {
            Number::Rational { num, den: 1 } => i32::try_from(num).ok(),
            _ => None,
        }
    }

    /// |x|
    #[must_use]
    pub fn abs(self) -> Number {
        if self.is_negative() { -self } else { self }
    }

    /// 1/x; [`UNDEFINED`](Number::UNDEFINED) for 0.
    #[must_use]
    pub fn recip(self) -> Number {
        match self {
            Number::Rational { num, den } => Number::ratio(den, num),
            Number::Scaled { num, den, exponent } => {
                let exact = Number::exact(den.into(), num.into(), -i32::from(exponent));
                exact.unwrap_or_else(|| Number::from(1.0 / self.to_f64()))
            }
            Number::Real(value) => Number::from(1.0 / value),
        }
    }

    /// x^e
    #[must_use]
    pub fn powi(self, exponent: i32) -> Number {
        let base = if exponent < 0 { self.recip() } else { self };
        let mut result = Number::ONE;
        let mut square = base;
        let mut rest = exponent.unsigned_abs();
        while rest > 0 {
            if rest & 1 == 1 {
                result = result * square;
            }
            rest >>= 1;
            if rest > 0 {
                square = square * square;
            }
        }
        result
    }

    /// The rational square root, if there is one.
    pub fn exact_sqrt(self) -> Option<Number> {
        let Number::Rational { num, den } = self else { return None };
        let root = |n: i64| {
            let r = (n as f64).sqrt() as i64;
            (n >= 0 && r * r == n).then_some(r)
        };
        Some(Number::ratio(root(num)?, root(den)?))
    }

    /// The product, unless it overflows or underflows.
    pub(crate) fn checked_mul(self, other: Number) -> Option<Number> {
        let product = self * other;
        let Number::Real(_) = product else {
            return (!product.is_zero() || self.is_zero() || other.is_zero()).then_some(product);
        };
        let unscaled = |x: Number| x.abs().is_one() || !x.is_finite();
        (product.to_f64().is_normal() || unscaled(self) || unscaled(other)).then_some(product)
    }

    /// x^e, unless it overflows or underflows.
    pub(crate) fn checked_powi(self, exponent: i32) -> Option<Number> {
        let power = self.powi(exponent);
        let out_of_range = match power {
            Number::Rational { num, .. } => num == 0,
            Number::Scaled { .. } => false,
            Number::Real(value) => !value.is_normal(),
        };
        (!out_of_range || exponent == 1 || self.is_zero() || !self.is_finite()).then_some(power)
    }

    /// The greatest rational g such that both numbers are integer multiples of it; `None` for rounded reals.
    pub(crate) fn content(self, other: Number) -> Option<Number> {
        match (self, other) {
            (Number::Rational { num: a, den: b }, Number::Rational { num: c, den: d }) => {
                let num = gcd(a.unsigned_abs().into(), c.unsigned_abs().into());
                let common = gcd(b.unsigned_abs().into(), d.unsigned_abs().into());
                let den = (b.unsigned_abs() as u128 / common) * d.unsigned_abs() as u128;
                Number::small(num.cast_signed(), den.cast_signed())
            }
            _ => None,
        }
    }
}

fn gcd(mut a: u128, mut b: u128) -> u128 {
    while b != 0 {
        (a, b) = (b, a % b);
    }
    a.max(1)
}

impl From<f64> for Number {
    /// The shortest decimal that rounds to `value`, as an exact number if it is a small rational or has few
    /// digits.
    fn from(value: f64) -> Number {
        if !value.is_finite() {
            return Number::Real(value);
        }
        if value.fract() == 0.0 && value.abs() <= EXACT as f64 {
            return Number::Rational { num: value as i64, den: 1 };
        }
        decimal(value).unwrap_or(Number::Real(value))
    }
}

/// Reads the shortest decimal expansion of `value` as digits · 10^exponent, if that is a small rational, or has so few
/// digits that it must be meant as a decimal.
fn decimal(value: f64) -> Option<Number> {
    let text = format!("{value:e}");
    let (mantissa, exponent) = text.split_once('e')?;
    let fraction_digits = mantissa.split_once('.').map_or(0, |(_, fraction)| fraction.len() as i32);
    let digits: i64 = mantissa.replace('.', "").parse().ok()?;
    let number = Number::exact(digits.into(), 1, exponent.parse::<i32>().ok()? - fraction_digits)?;
    // A number of the size of a rounding error of 1 may be one.
    let is_meant = || {
        digits.unsigned_abs().to_string().len() <= DIGITS
            && !(f64::EPSILON / 16.0..f64::EPSILON * 64.0).contains(&value.abs())
    };
    (matches!(number, Number::Rational { .. }) || is_meant()).then_some(number)
}

impl From<i32> for Number {
    fn from(value: i32) -> Number {
        Number::integer(value)
    }
}

impl std::ops::Neg for Number {
    type Output = Number;
    fn neg(self) -> Number {
        match self {
            Number::Rational { num, den } => Number::Rational { num: -num, den },
            Number::Scaled { num, den, exponent } => Number::Scaled { num: -num, den, exponent },
            Number::Real(value) => Number::Real(-value),
        }
    }
}

impl std::ops::Add for Number {
    type Output = Number;
    fn add(self, other: Number) -> Number {
        match (self, other) {
            (Number::Rational { num: a, den: 1 }, Number::Rational { num: c, den: 1 }) => {
                Number::whole(i128::from(a) + i128::from(c))
            }
            (Number::Rational { num: a, den: b }, Number::Rational { num: c, den: d }) => {
                let [a, b, c, d] = [a, b, c, d].map(i128::from);
                Number::reduce(a * d + c * b, b * d)
            }
            _ => sum(self, other).unwrap_or_else(|| Number::from(self.to_f64() + other.to_f64())),
        }
    }
}

impl std::ops::Mul for Number {
    type Output = Number;
    fn mul(self, other: Number) -> Number {
        match (self, other) {
            (Number::Rational { num: a, den: 1 }, Number::Rational { num: c, den: 1 }) => {
                Number::whole(i128::from(a) * i128::from(c))
            }
            (Number::Rational { num: a, den: b }, Number::Rational { num: c, den: d }) => {
                let [a, b, c, d] = [a, b, c, d].map(i128::from);
                Number::reduce(a * c, b * d)
            }
            _ => product(self, other).unwrap_or_else(|| Number::from(self.to_f64() * other.to_f64())),
        }
    }
}

/// a + b, if both are exact and the sum can be represented.
fn sum(a: Number, b: Number) -> Option<Number> {
    let ((a, b, e), (c, d, f)) = (a.parts()?, b.parts()?);
    let least = e.min(f);
    let aligned = |num: i128, den: i128, exponent: i32| {
        num.checked_mul(den)?.checked_mul(10i128.checked_pow((exponent - least).unsigned_abs())?)
    };
    Number::exact(aligned(a, d, e)?.checked_add(aligned(c, b, f)?)?, b * d, least)
}

/// a b, if both are exact and the product can be represented.
fn product(a: Number, b: Number) -> Option<Number> {
    let ((a, b, e), (c, d, f)) = (a.parts()?, b.parts()?);
    Number::exact(a * c, b * d, e + f)
}

impl PartialEq for Number {
    /// Equality of representation: NaN equals itself, so that constants can be interned.
    fn eq(&self, other: &Number) -> bool {
        match (self, other) {
            (Number::Rational { num: a, den: b }, Number::Rational { num: c, den: d }) => a == c && b == d,
            (
                Number::Scaled { num: a, den: b, exponent: e },
                Number::Scaled { num: c, den: d, exponent: f },
            ) => a == c && b == d && e == f,
            (Number::Real(a), Number::Real(b)) => a.to_bits() == b.to_bits(),
            _ => false,
        }
    }
}

impl Eq for Number {}

impl Hash for Number {
    fn hash<H: Hasher>(&self, state: &mut H) {
        match self {
            Number::Rational { num, den } => (num, den).hash(state),
            Number::Scaled { num, den, exponent } => (num, den, exponent).hash(state),
            Number::Real(value) => value.to_bits().hash(state),
        }
    }
}

impl fmt::Display for Number {
    /// Writes small fractions as such (`-1/3`), and other rationals as decimals if these terminate.
    ///
    /// Very large and very small numbers are written with an exponent.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Number::Rational { num, den: 1 } => write!(f, "{num}"),
            Number::Rational { num, den } if den <= 12 && den != 5 && den != 10 => write!(f, "{num}/{den}"),
            Number::Rational { num, den } => {
                let value = self.to_f64();
                if Number::from(value) == *self { decimal_text(value, f) } else { write!(f, "{num}/{den}") }
            }
            Number::Scaled { .. } | Number::Real(_) => decimal_text(self.to_f64(), f),
        }
    }
}

fn decimal_text(value: f64, f: &mut fmt::Formatter<'_>) -> fmt::Result {
    match value.abs() {
        size if size.is_finite() && !(1e-5..1e17).contains(&size) => write!(f, "{value:e}"),
        _ => write!(f, "{value}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn decimals_are_exact() {
        assert_eq!(Number::from(0.1) + Number::from(0.2), Number::from(0.3));
        assert_eq!(Number::from(0.1), Number::ratio(1, 10));
        assert_eq!(Number::from(-0.25), Number::ratio(-1, 4));
        assert_eq!(Number::from(1e-3), Number::ratio(1, 1000));
    }

    #[test]
    fn f64_round_trips_bit_for_bit() {
        for value in
            [0.1, -2.5, 1.0 / 3.0, std::f64::consts::PI, 1e300, 5e-324, 123_456.789, 9_007_199_254_740_993.0]
        {
            assert_eq!(Number::from(value).to_f64().to_bits(), value.to_bits(), "{value}");
        }
    }

    /// Powers of units, which are not small rationals, cancel like other numbers.
    #[test]
    fn powers_of_ten_are_exact() {
        let [unit, back] = [1e-9, 1e9].map(Number::from);
        let power = unit.powi(4);
        assert_eq!((power.to_f64(), power.is_rounded()), (1e-36, false));
        assert_eq!(power * back.powi(4), Number::ONE);
        assert_eq!(power * back.powi(3), unit);
        assert_eq!(power + -power, Number::ZERO);
        assert_eq!(power, Number::from(1e-36));
        let third = Number::ratio(1, 3) * power;
        assert_eq!(third + third + third, power);
        assert_ne!(third, Number::from(third.to_f64()), "a third is no decimal");
        assert_eq!((third * power.recip(), third.recip() * third), (Number::ratio(1, 3), Number::ONE));
    }

    #[test]
    fn results_of_other_computations_are_rounded() {
        assert!(Number::from(std::f64::consts::SQRT_2 * 1e-20).is_rounded());
        assert!((Number::from(1e-20) * Number::from(6.123233995736766e-17)).is_rounded());
        assert!(!Number::from(1.5e-20).is_rounded() && !Number::from(6.02214076e23).is_rounded());
    }

    #[test]
    fn too_large_a_rational_is_rounded() {
        let big = Number::ratio(1 << 40, 1);
        assert_eq!(big * big, Number::Real(2f64.powi(80)));
        assert_eq!(Number::ratio(1, 3) * Number::ratio(3, 1), Number::ONE);
        assert_eq!(Number::ratio((1 << 54) + 1, 1 << 54), Number::ONE, "rounded to a small rational again");
    }

    #[test]
    fn checked_operations_refuse_to_leave_the_range() {
        let [huge, tiny] = [1e300, 1e-300].map(Number::from);
        assert_eq!(huge.checked_mul(huge), None);
        assert_eq!(tiny.checked_mul(tiny), None);
        assert!(huge.checked_mul(tiny).is_some());
        assert_eq!(tiny.checked_powi(2), None);
        assert_eq!(tiny.checked_powi(-2), None);
        assert_eq!(Number::ZERO.checked_mul(huge), Some(Number::ZERO));
        assert_eq!(Number::from(5e-324).checked_mul(Number::MINUS_ONE), Some(Number::Real(-5e-324)));
    }

    #[test]
    fn division_by_zero_is_undefined() {
        assert!(!Number::ZERO.recip().is_finite());
        assert_eq!(Number::ratio(1, 0), Number::UNDEFINED);
    }

    #[test]
    fn content_is_the_rational_gcd() {
        assert_eq!(Number::ratio(1, 2).content(Number::ratio(1, 3)), Some(Number::ratio(1, 6)));
        assert_eq!(Number::integer(4).content(Number::integer(-6)), Some(Number::integer(2)));
    }

    #[test]
    fn prints_fractions_and_decimals() {
        let shown = [(1, 2), (-1, 3), (3, 10), (1, 7), (3, 1000), (22, 13)]
            .map(|(a, b)| Number::ratio(a, b).to_string());
        assert_eq!(shown, ["1/2", "-1/3", "0.3", "1/7", "0.003", "22/13"]);
        let shown = [6.674e-11, -1e300, 5e-324, 1e5, 0.1 + 0.2].map(|x| Number::from(x).to_string());
        assert_eq!(shown, ["6.674e-11", "-1e300", "5e-324", "100000", "0.30000000000000004"]);
    }
}

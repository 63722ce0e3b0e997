//! Functions in lanes.
//!
//! sin and cos are computed inline with errors below 2 units in the last place, exp and log below
//! 1.5; √, min, max, |x|, sign and step are operations; the others are called lane by lane. In a lane whose
//! argument is outside the range of the inline code, the library computes the function.

use super::tape::{Binary, Fused, LaneTape, LaneValue};
use crate::graph::function::Function;
use crate::kernel::circle::{COS, HALF_PI, ROUNDING, SIN};

const SIGN: u64 = 1 << 63;

/// Arguments of sin and cos up to this are reduced inline: with n below 2³⁰, x − n·HALF_PI\[0\] is
/// a multiple of 2⁻⁵³ below 1 and therefore exact, and the third part of π/2 still covers the
/// remainder.
const CIRCLE_RANGE: f64 = 1e9;
/// log 2 as a sum; n times the first part is exact for |n| < 2¹¹.
const LOG_2: [f64; 2] = [6.931_471_803_691_238e-1, 1.908_214_929_270_587_7e-10];
/// Arguments beyond which eˣ is 0 or infinite.
const EXP_RANGE: [f64; 2] = [-746.0, 710.0];
/// (log (1+s)/(1−s) − 2s)/s in powers of s², for |s| below 0.1716 [the coefficients of fdlibm].
const LOG: [f64; 7] = [
    6.666_666_666_666_735e-1,
    3.999_999_999_940_942e-1,
    2.857_142_874_366_239e-1,
    2.222_219_843_214_978_4e-1,
    1.818_357_216_161_805e-1,
    1.531_383_769_920_937_3e-1,
    1.479_819_860_511_658_6e-1,
];
/// The upper half of the bits of √½, for splitting numbers into 2ᵏ m with m near 1.
const ROOT_OF_HALF: u64 = 0x3fe6_a09e << 32;

impl LaneTape {
    /// a + b
    pub fn add(&mut self, a: LaneValue, b: LaneValue) -> LaneValue {
        self.binary(Binary::Add, a, b)
    }

    /// a − b
    pub fn subtract(&mut self, a: LaneValue, b: LaneValue) -> LaneValue {
        self.binary(Binary::Subtract, a, b)
    }

    /// a · b
    pub fn multiply(&mut self, a: LaneValue, b: LaneValue) -> LaneValue {
        self.binary(Binary::Multiply, a, b)
    }

    /// a·b + c, rounded once
    pub fn multiply_add(&mut self, a: LaneValue, b: LaneValue, c: LaneValue) -> LaneValue {
        self.fused(Fused::MultiplyAdd, a, b, c)
    }

    /// −a
    pub fn negate(&mut self, a: LaneValue) -> LaneValue {
        let sign = self.bits(SIGN);
        self.binary(Binary::Xor, a, sign)
    }

    /// |a|
    pub fn size(&mut self, a: LaneValue) -> LaneValue {
        let rest = self.bits(!SIGN);
        self.binary(Binary::And, a, rest)
    }

    /// The value of the function; it takes its arguments from the first of these three.
    pub(super) fn function(&mut self, function: Function, arguments: [LaneValue; 3]) -> LaneValue {
        let [x, y, z] = arguments;
        let zero = self.constant(0.0);
        match function {
            Function::Sin => self.circle(x)[0],
            Function::Cos => self.circle(x)[1],
            Function::Exp => self.exp(x),
            Function::Log => self.log(x),
            Function::Sqrt => self.square_root(x),
            Function::Abs => self.size(x),
            Function::Sign => {
                let (one, other) = (self.constant(1.0), self.constant(-1.0));
                let (above, below) = (self.binary(Binary::Less, zero, x), self.binary(Binary::Less, x, zero));
                let rest = self.multiply(x, zero);
                let rest = self.select(below, other, rest);
                self.select(above, one, rest)
            }
            Function::Min | Function::Max => {
                let choice = if function == Function::Min { Binary::Lesser } else { Binary::Greater };
                let (value, none) = (self.binary(choice, x, y), self.add(x, y));
                let unordered = self.binary(Binary::Unordered, x, y);
                self.select(unordered, none, value)
            }
            Function::Step => {
                let (not_below, below) =
                    (self.binary(Binary::LessOrEqual, zero, x), self.binary(Binary::Less, x, zero));
                let rest = self.select(below, z, x);
                self.select(not_below, y, rest)
            }
            Function::Asin
            | Function::Acos
            | Function::Atan
            | Function::Atan2
            | Function::Sinh
            | Function::Cosh
            | Function::Tanh
            | Function::Pow => self.call(function, arguments),
        }
    }

    /// [sin x, cos x]: with n the integer nearest to 2x/π, r = x − nπ/2 lies in [−π/4, π/4], and n
    /// mod 4 determines which of ±sin r and ±cos r is sin x and which cos x.
    fn circle(&mut self, x: LaneValue) -> [LaneValue; 2] {
        if let Some(&known) = self.circles.get(&x) {
            return known;
        }
        let (scale, rounding) = (self.constant(std::f64::consts::FRAC_2_PI), self.constant(ROUNDING));
        let shifted = self.multiply_add(x, scale, rounding);
        let n = self.subtract(shifted, rounding);
        let [first, second, third] = HALF_PI.map(|part| self.constant(part));
        let rest = self.fused(Fused::NegateMultiplyAdd, n, first, x);
        let r = self.fused(Fused::NegateMultiplyAdd, n, second, rest);
        let z = self.multiply(r, r);
        let z2 = self.multiply(z, z);
        let z4 = self.multiply(z2, z2);
        // −sin r = (−r) − (r³p − n·π₃): with these signs that of zero is right.
        let p = self.six(&SIN, z, z2, z4);
        let minus_n = self.negate(n);
        let tail = self.multiply(minus_n, third);
        let r3 = self.multiply(r, z);
        let bend = self.multiply_add(r3, p, tail);
        let one = self.constant(1.0);
        let minus_sin = self.fused(Fused::NegateMultiplySubtract, r, one, bend);
        let q = self.six(&COS, z, z2, z4);
        let minus_half = self.constant(-0.5);
        let top = self.multiply_add(z, minus_half, one);
        let cos = self.multiply_add(z2, q, top);

        // n mod 4 = 0, 1, 2, 3:  sin x = s, c, −s, −c;  cos x = c, −s, −c, s.
        let [none, unit, three, sign] = [0, 1, 3, SIGN].map(|bits| self.bits(bits));
        let odd = self.binary(Binary::And, shifted, unit);
        let odd = self.binary(Binary::IntegerSubtract, none, odd);
        let n3 = self.binary(Binary::IntegerAdd, shifted, three);
        let (size, range) = (self.size(x), self.constant(CIRCLE_RANGE));
        let mut result = |function, [a, b]: [LaneValue; 2], n| {
            let value = self.select(odd, a, b);
            let second_bit = self.shift_left(n, 62);
            let value = self.xor_and(value, second_bit, sign);
            self.near((function, x), (size, range), value)
        };
        let both =
            [result(Function::Sin, [cos, minus_sin], n3), result(Function::Cos, [minus_sin, cos], shifted)];
        self.circles.insert(x, both);
        both
    }

    /// eˣ = 2ⁿ eʳ with r = x − n log 2, and 2ⁿ in two factors, so that only the last product is
    /// rounded if the result is subnormal.
    fn exp(&mut self, x: LaneValue) -> LaneValue {
        let [least, most] = EXP_RANGE.map(|bound| self.constant(bound));
        // A NaN persists as the second operand.
        let x = self.binary(Binary::Greater, least, x);
        let x = self.binary(Binary::Lesser, most, x);
        let (scale, rounding) = (self.constant(std::f64::consts::LOG2_E), self.constant(ROUNDING));
        let shifted = self.multiply_add(x, scale, rounding);
        let n = self.subtract(shifted, rounding);
        let [first, second] = LOG_2.map(|part| self.constant(part));
        let rest = self.fused(Fused::NegateMultiplyAdd, n, first, x);
        let r = self.fused(Fused::NegateMultiplyAdd, n, second, rest);

        // (eʳ − 1 − r)/r²: the neglected terms are below 4e-18.
        let (mut terms, mut factorial) = (Vec::new(), 1.0);
        for k in 2..=13 {
            factorial *= f64::from(k);
            terms.push(self.constant(1.0 / factorial));
        }
        let r2 = self.multiply(r, r);
        let r4 = self.multiply(r2, r2);
        let r8 = self.multiply(r4, r4);
        let pairs: Vec<LaneValue> =
            terms.chunks_exact(2).map(|pair| self.multiply_add(pair[1], r, pair[0])).collect();
        let fours: Vec<LaneValue> =
            pairs.chunks_exact(2).map(|pair| self.multiply_add(pair[1], r2, pair[0])).collect();
        let low = self.multiply_add(fours[1], r4, fours[0]);
        let p = self.multiply_add(fours[2], r8, low);
        let bend = self.multiply_add(r2, p, r);
        let one = self.constant(1.0);
        let power = self.add(one, bend);

        let half = self.constant(0.5);
        let half_shifted = self.multiply_add(n, half, rounding);
        let half_n = self.subtract(half_shifted, rounding);
        let other = self.subtract(n, half_n);
        let other_shifted = self.add(other, rounding);
        let factors = [half_shifted, other_shifted].map(|shifted| {
            let exponent = self.shift_left(shifted, 52);
            self.binary(Binary::IntegerAdd, exponent, one)
        });
        let power = self.multiply(power, factors[0]);
        self.multiply(power, factors[1])
    }

    /// log x = k log 2 + log (1 + f), 1 + f in [√½, √2), with s = f/(2 + f) as in fdlibm.
    fn log(&mut self, x: LaneValue) -> LaneValue {
        let one = self.constant(1.0);
        let shift = self.bits(1.0f64.to_bits() - ROOT_OF_HALF);
        let u = self.binary(Binary::IntegerAdd, x, shift);
        let exponent = self.shift_right(u, 52);
        let large = self.constant(4_503_599_627_370_496.0); // 2⁵²
        let exponent = self.binary(Binary::Or, exponent, large);
        let biased = self.constant(4_503_599_627_370_496.0 + 1023.0);
        let k = self.subtract(exponent, biased);
        let (fraction, root) = (self.bits((1 << 52) - 1), self.bits(ROOT_OF_HALF));
        let m = self.binary(Binary::And, u, fraction);
        let m = self.binary(Binary::IntegerAdd, m, root);
        let f = self.subtract(m, one);

        let [two, half] = [2.0, 0.5].map(|value| self.constant(value));
        let divisor = self.add(f, two);
        let s = self.binary(Binary::Divide, f, divisor);
        let z = self.multiply(s, s);
        let w = self.multiply(z, z);
        let c = LOG.map(|c| self.constant(c));
        let even = self.multiply_add(w, c[5], c[3]);
        let even = self.multiply_add(w, even, c[1]);
        let odd = self.multiply_add(w, c[6], c[4]);
        let odd = self.multiply_add(w, odd, c[2]);
        let odd = self.multiply_add(w, odd, c[0]);
        let even = self.multiply(w, even);
        let rest = self.multiply_add(z, odd, even);
        let square = self.multiply(f, f);
        let square = self.multiply(half, square);
        let sum = self.add(square, rest);
        let [first, second] = LOG_2.map(|part| self.constant(part));
        let low = self.multiply(k, second);
        let low = self.multiply_add(s, sum, low);
        let bend = self.subtract(square, low);
        let near_one = self.subtract(f, bend);
        let value = self.multiply_add(k, first, near_one);

        let [least, most] = [f64::MIN_POSITIVE, f64::MAX].map(|bound| self.constant(bound));
        let value = self.near((Function::Log, x), (least, x), value);
        self.near((Function::Log, x), (x, most), value)
    }

    /// Σ cᵢ zⁱ, evaluated in pairs so that few operations depend on each other.
    fn six(&mut self, c: &[f64; 6], z: LaneValue, z2: LaneValue, z4: LaneValue) -> LaneValue {
        let [c0, c1, c2, c3, c4, c5] = c.map(|c| self.constant(c));
        let low = self.multiply_add(c1, z, c0);
        let middle = self.multiply_add(c3, z, c2);
        let high = self.multiply_add(c5, z, c4);
        let low = self.multiply_add(middle, z2, low);
        self.multiply_add(high, z4, low)
    }
}

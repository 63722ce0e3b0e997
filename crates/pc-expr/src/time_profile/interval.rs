//! Enclosures of real functions over intervals [Moore 1966].
//!
//! Ends are rounded to nearest instead of outwards: they are off by a few units of rounding, which is
//! negligible for the features sought here.

use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::{Add, Mul, Neg, Sub};

/// All x with lo ≤ x ≤ hi.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Interval {
    pub(crate) lo: f64,
    pub(crate) hi: f64,
}

impl Interval {
    pub(crate) const ALL: Interval = Interval { lo: f64::NEG_INFINITY, hi: f64::INFINITY };
    pub(crate) const ZERO: Interval = Interval::point(0.0);
    pub(crate) const ONE: Interval = Interval::point(1.0);

    pub(crate) const fn point(x: f64) -> Interval {
        Interval { lo: x, hi: x }
    }

    /// The interval between two numbers; the whole real line if one of them is NaN.
    pub(crate) fn between(a: f64, b: f64) -> Interval {
        if a.is_nan() || b.is_nan() { Interval::ALL } else { Interval { lo: a.min(b), hi: a.max(b) } }
    }

    pub(crate) fn is_point(self) -> bool {
        self.lo == self.hi
    }

    pub(crate) fn width(self) -> f64 {
        self.hi - self.lo
    }

    /// The largest |x|.
    pub(crate) fn size(self) -> f64 {
        self.lo.abs().max(self.hi.abs())
    }

    pub(crate) fn hull(self, other: Interval) -> Interval {
        Interval { lo: self.lo.min(other.lo), hi: self.hi.max(other.hi) }
    }

    /// 1, −1 or 0 if the whole interval has that sign; ends may be zero.
    pub(crate) fn sign(self) -> Option<i8> {
        match (self.lo >= 0.0, self.hi <= 0.0) {
            (true, true) => Some(0),
            (true, false) => Some(1),
            (false, true) => Some(-1),
            (false, false) => None,
        }
    }

    fn monotone(self, f: impl Fn(f64) -> f64) -> Interval {
        Interval::between(f(self.lo), f(self.hi))
    }

    pub(crate) fn scale(self, factor: f64) -> Interval {
        self * Interval::point(factor)
    }

    pub(crate) fn square(self) -> Interval {
        let (a, b) = (self.lo * self.lo, self.hi * self.hi);
        let least = if self.lo <= 0.0 && self.hi >= 0.0 { 0.0 } else { a.min(b) };
        Interval { lo: least, hi: a.max(b) }
    }

    pub(crate) fn recip(self) -> Interval {
        if self.lo > 0.0 || self.hi < 0.0 {
            return self.monotone(f64::recip);
        }
        match (self.lo == 0.0, self.hi == 0.0) {
            (true, false) => Interval { lo: self.hi.recip(), hi: f64::INFINITY },
            (false, true) => Interval { lo: f64::NEG_INFINITY, hi: self.lo.recip() },
            _ => Interval::ALL,
        }
    }

    /// The part that is not below `least`; a point if there is none.
    pub(crate) fn from(self, least: f64) -> Interval {
        Interval { lo: self.lo.max(least), hi: self.hi.max(least) }
    }

    /// The part between two numbers; a point if there is none.
    pub(crate) fn within(self, least: f64, most: f64) -> Interval {
        Interval { lo: self.lo.clamp(least, most), hi: self.hi.clamp(least, most) }
    }

    pub(crate) fn exp(self) -> Interval {
        self.monotone(f64::exp)
    }

    pub(crate) fn ln(self) -> Interval {
        self.from(0.0).monotone(f64::ln)
    }

    pub(crate) fn sqrt(self) -> Interval {
        self.from(0.0).monotone(f64::sqrt)
    }

    pub(crate) fn asin(self) -> Interval {
        self.within(-1.0, 1.0).monotone(f64::asin)
    }

    pub(crate) fn atan(self) -> Interval {
        self.monotone(f64::atan)
    }

    pub(crate) fn tanh(self) -> Interval {
        self.monotone(f64::tanh)
    }

    pub(crate) fn sinh(self) -> Interval {
        self.monotone(f64::sinh)
    }

    pub(crate) fn cosh(self) -> Interval {
        let ends = self.monotone(f64::cosh);
        if self.lo <= 0.0 && self.hi >= 0.0 { Interval { lo: 1.0, hi: ends.hi } } else { ends }
    }

    pub(crate) fn cos(self) -> Interval {
        if !self.width().is_finite() || self.width() >= 2.0 * PI {
            return Interval { lo: -1.0, hi: 1.0 };
        }
        let mut values = self.monotone(f64::cos);
        // Multiples of π inside: even ones are maxima, odd ones minima.
        let (first, last) = ((self.lo / PI).ceil(), (self.hi / PI).floor());
        let mut k = first;
        while k <= last {
            values = values.hull(Interval::point(if k.rem_euclid(2.0) == 0.0 { 1.0 } else { -1.0 }));
            k += 1.0;
        }
        values
    }

    pub(crate) fn sin(self) -> Interval {
        (self - Interval::point(FRAC_PI_2)).cos()
    }

    /// xᶜ for x ≥ 0.
    pub(crate) fn powf(self, c: f64) -> Interval {
        self.from(0.0).monotone(|x| x.powf(c))
    }
}

/// The interval with these computed ends; the whole real line if one of them is NaN, such as ∞ − ∞.
fn ends(lo: f64, hi: f64) -> Interval {
    Interval {
        lo: if lo.is_nan() { f64::NEG_INFINITY } else { lo },
        hi: if hi.is_nan() { f64::INFINITY } else { hi },
    }
}

impl Add for Interval {
    type Output = Interval;
    fn add(self, other: Interval) -> Interval {
        ends(self.lo + other.lo, self.hi + other.hi)
    }
}

impl Sub for Interval {
    type Output = Interval;
    fn sub(self, other: Interval) -> Interval {
        ends(self.lo - other.hi, self.hi - other.lo)
    }
}

impl Neg for Interval {
    type Output = Interval;
    fn neg(self) -> Interval {
        Interval { lo: -self.hi, hi: -self.lo }
    }
}

impl Mul for Interval {
    type Output = Interval;
    fn mul(self, other: Interval) -> Interval {
        // 0 · ∞ is 0: the ends of an interval stand for the finite numbers inside.
        let product = |a: f64, b: f64| if a == 0.0 || b == 0.0 { 0.0 } else { a * b };
        let (a, b) = (product(self.lo, other.lo), product(self.lo, other.hi));
        let (c, d) = (product(self.hi, other.lo), product(self.hi, other.hi));
        ends(a.min(b).min(c).min(d), a.max(b).max(c).max(d))
    }
}

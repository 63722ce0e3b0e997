//! Numbers with rates of change: dual numbers, nested as deeply as there are derivatives.

use num_dual::{Derivative, Dual, DualNum, DualSVec64};

use crate::numbers::rounding::Rounding;

/// A number with derivatives along several directions; `f64` has none.
pub(crate) trait Number: DualNum<Primitive = f64> + Copy {
    /// The same kind of number with one more direction.
    type Rate: Number;

    /// This number, made to change at a rate; `None` beyond the deepest nesting.
    fn changing(self, rate: Self) -> Option<Self::Rate>;

    /// The rate at which a number changes.
    fn rate_of(changing: Self::Rate) -> Self;

    /// The value without any derivative.
    fn real(self) -> f64;

    /// Whether all derivatives vanish.
    fn is_constant(self) -> bool;

    /// Whether the value and all derivatives vanish.
    fn vanishes(self) -> bool;

    /// x^c for a constant exponent, computed by products if it is a small integer, so that no power of 0
    /// becomes 0/0.
    fn power(self, exponent: f64) -> Self;

    /// This number with every part moved by one unit in the last place, up or down.
    fn rounded(self, rounding: &Rounding) -> Self;

    /// A constant.
    fn constant(value: f64) -> Self {
        Self::from(value)
    }
}

/// The largest exponent for which a power is computed as a product.
const LONGEST_PRODUCT: f64 = 64.0;

fn integer_power<T: Number>(base: T, exponent: f64) -> T {
    let factor = if exponent < 0.0 { base.recip() } else { base };
    let mut power = T::constant(1.0);
    for _ in 0..exponent.abs() as usize {
        power *= factor;
    }
    power
}

fn is_small_integer(exponent: f64) -> bool {
    exponent.fract() == 0.0 && exponent.abs() <= LONGEST_PRODUCT
}

impl Number for f64 {
    type Rate = Dual<f64>;

    fn changing(self, rate: f64) -> Option<Dual<f64>> {
        Some(Dual::new(self, rate))
    }

    fn rate_of(changing: Dual<f64>) -> f64 {
        changing.eps
    }

    fn real(self) -> f64 {
        self
    }

    fn is_constant(self) -> bool {
        true
    }

    fn vanishes(self) -> bool {
        self == 0.0
    }

    fn power(self, exponent: f64) -> f64 {
        if is_small_integer(exponent) { integer_power(self, exponent) } else { self.powf(exponent) }
    }

    fn rounded(self, rounding: &Rounding) -> f64 {
        rounding.of(self)
    }
}

/// Implements a number at another level of nesting. `next` has one more direction; the deepest has none.
macro_rules! level {
    ($number:ty, $next:ty, $changing:expr, $rate:expr) => {
        impl Number for $number {
            type Rate = $next;

            fn changing(self, rate: Self) -> Option<$next> {
                let changing: fn(Self, Self) -> Option<$next> = $changing;
                changing(self, rate)
            }

            fn rate_of(changing: $next) -> Self {
                let rate: fn($next) -> Self = $rate;
                rate(changing)
            }

            fn real(self) -> f64 {
                self.re.real()
            }

            fn is_constant(self) -> bool {
                self.eps.vanishes() && self.re.is_constant()
            }

            fn vanishes(self) -> bool {
                self.eps.vanishes() && self.re.vanishes()
            }

            fn power(self, exponent: f64) -> Self {
                if is_small_integer(exponent) {
                    return integer_power(self, exponent);
                }
                let slope = self.re.power(exponent - 1.0) * exponent;
                Dual::new(self.re.power(exponent), self.eps * slope)
            }

            fn rounded(self, rounding: &Rounding) -> Self {
                Dual::new(self.re.rounded(rounding), self.eps.rounded(rounding))
            }
        }
    };
    ($number:ty, $next:ty) => {
        level!($number, $next, |value, rate| Some(Dual::new(value, rate)), |changing| changing.eps);
    };
}

/// The number of directions along which a number changes at once.
pub(crate) const LANES: usize = 8;

/// A number with its derivatives along several directions: they are found in one evaluation of a term.
pub(crate) type Lanes = DualSVec64<LANES>;

impl Number for Lanes {
    type Rate = Dual<Lanes>;

    fn changing(self, rate: Self) -> Option<Dual<Lanes>> {
        Some(Dual::new(self, rate))
    }

    fn rate_of(changing: Dual<Lanes>) -> Self {
        changing.eps
    }

    fn real(self) -> f64 {
        self.re
    }

    fn is_constant(self) -> bool {
        self.eps.0.is_none_or(|rates| rates.iter().all(|&rate| rate == 0.0))
    }

    fn vanishes(self) -> bool {
        self.re == 0.0 && self.is_constant()
    }

    fn power(self, exponent: f64) -> Self {
        if is_small_integer(exponent) {
            return integer_power(self, exponent);
        }
        Lanes::new(self.re.power(exponent), self.eps * (self.re.power(exponent - 1.0) * exponent))
    }

    fn rounded(self, rounding: &Rounding) -> Self {
        let re = rounding.of(self.re);
        Lanes::new(re, Derivative::new(self.eps.0.map(|rates| rates.map(|rate| rounding.of(rate)))))
    }
}

pub(crate) type D1 = Dual<f64>;
pub(crate) type D2 = Dual<D1>;
type D3 = Dual<D2>;
type D4 = Dual<D3>;

/// The same, which also changes in one more direction.
pub(crate) type MovingLanes = Dual<Lanes>;
type Lanes2 = Dual<MovingLanes>;
type Lanes3 = Dual<Lanes2>;

level!(MovingLanes, Lanes2);
level!(Lanes2, Lanes3);
level!(Lanes3, Lanes3, |_, _| None, |_| Lanes3::constant(f64::NAN));
level!(D1, D2);
level!(D2, D3);
level!(D3, D4);
level!(D4, D4, |_, _| None, |_| D4::constant(f64::NAN));

//! The dual numbers of `num-dual` as scalars that expressions can be evaluated over: derivatives without the
//! library's own.

use std::ops::{Add, Mul, Neg};

use num_dual::{DualNum, HyperDual64};
use pc_expr::{Function, Scalar};

/// A number with two first derivatives and the mixed second one, along two directions ε_1 and ε_2.
#[derive(Clone, Copy, Debug)]
pub struct Dual(pub HyperDual64);

impl Dual {
    /// The value with its rates of change along the two directions.
    pub fn new(value: f64, along_first: f64, along_second: f64) -> Dual {
        Dual(HyperDual64::new(value, along_first, along_second, 0.0))
    }

    /// The value.
    pub fn value(self) -> f64 {
        self.0.re
    }

    /// The derivative along the first direction.
    pub fn first(self) -> f64 {
        self.0.eps1
    }

    /// The derivative along the second direction.
    pub fn second(self) -> f64 {
        self.0.eps2
    }

    /// The second derivative, once along each.
    pub fn mixed(self) -> f64 {
        self.0.eps1eps2
    }
}

impl Add for Dual {
    type Output = Dual;
    fn add(self, other: Dual) -> Dual {
        Dual(self.0 + other.0)
    }
}

impl Mul for Dual {
    type Output = Dual;
    fn mul(self, other: Dual) -> Dual {
        Dual(self.0 * other.0)
    }
}

impl Neg for Dual {
    type Output = Dual;
    fn neg(self) -> Dual {
        Dual(-self.0)
    }
}

impl Scalar for Dual {
    fn from_f64(value: f64) -> Dual {
        Dual::new(value, 0.0, 0.0)
    }

    fn powi(self, exponent: i32) -> Dual {
        // By products: the powers of num-dual divide by x² and x³ and lose the small ones.
        let factor = if exponent < 0 { self.0.recip() } else { self.0 };
        let power = (0..exponent.unsigned_abs()).fold(HyperDual64::from(1.0), |power, _| power * factor);
        Dual(power)
    }

    /// # Panics
    /// At the corners of |x|, min, max, sign and step, where there is no derivative.
    fn call(function: Function, args: &[Dual]) -> Dual {
        let x = args[0].0;
        let side = match function {
            Function::Abs | Function::Sign | Function::Step => x.re,
            Function::Min | Function::Max => x.re - args[1].0.re,
            _ => 1.0,
        };
        assert!(side != 0.0, "{} has no derivative at a corner", function.name());
        Dual(match function {
            Function::Sin => x.sin(),
            Function::Cos => x.cos(),
            Function::Asin => x.asin(),
            Function::Acos => x.acos(),
            Function::Atan => x.atan(),
            Function::Atan2 => x.atan2(args[1].0),
            Function::Sinh => x.sinh(),
            Function::Cosh => x.cosh(),
            Function::Tanh => x.tanh(),
            Function::Exp => x.exp(),
            Function::Log => x.ln(),
            Function::Sqrt => x.sqrt(),
            Function::Pow => x.powd(args[1].0),
            Function::Abs => x * side.signum(),
            Function::Sign => HyperDual64::from(side.signum()),
            Function::Min => args[usize::from(side > 0.0)].0,
            Function::Max => args[usize::from(side < 0.0)].0,
            Function::Step => args[if side > 0.0 { 1 } else { 2 }].0,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// f = sin(x y)/x at (0.7, 1.3): ∂²f/∂x∂y = −y sin(x y).
    #[test]
    fn mixed_derivatives_are_those_of_calculus() {
        let (x, y) = (0.7f64, 1.3f64);
        let (u, v) = (Dual::new(x, 1.0, 0.0), Dual::new(y, 0.0, 1.0));
        let f = Scalar::call(Function::Sin, &[u * v]) * Scalar::powi(u, -1);
        let (sin, cos) = (x * y).sin_cos();
        let expected = [sin / x, y * cos / x - sin / (x * x), cos, -y * sin];
        let found = [f.value(), f.first(), f.second(), f.mixed()];
        assert!(
            found.iter().zip(expected).all(|(f, e)| (f - e).abs() < 1e-15),
            "{found:?}, not {expected:?}"
        );
    }
}

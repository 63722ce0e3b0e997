//! Numbers together with the size of their terms, to distinguish a small number from the rounding error of a
//! zero.
//!
//! A weight is used once, at sample points of a derivation, so that its order of magnitude suffices; the
//! bound with which a motion compares residuals at each state is an expression, in
//! `pc-mech/src/compiled/running_error.rs`.

use std::ops::{Add, Mul, Neg};

use crate::graph::evaluate::Scalar;
use crate::graph::function::Function;
use crate::graph::number::Number;

/// The relative change of an argument that shows how a function magnifies errors: far above the unit of
/// rounding.
const CHANGE: f64 = 1e-12;

/// A number and its weight: the size of the terms of which it is the sum, so that its rounding error is of
/// the order of the weight times the unit of rounding. Exact numbers have weight 0.
///
///   w(a + b) = w(a) + w(b),   w(a b) = max(|a b|, |a| w(b), w(a) |b|),   w(f(a)) = max(|f|, |f'| w(a)),
///
/// where in a sum w is at least the absolute value. This is a running error analysis \[N. J. Higham,
/// *Accuracy and Stability of Numerical Algorithms*, 2002, § 3.3\] without the number of operations.
///
/// ```
/// # use pc_expr::{Graph, Scalar, Weighed};
/// let graph = Graph::new();
/// let [x, y] = graph.symbols(["x", "y"]);
/// let at = [(x, Weighed::from_f64(0.1)), (y, Weighed::from_f64(0.3))];
/// let values = graph.evaluate(&[3.0 * x - y, 1e-9 * x], &at)?;
/// assert!(values[0].value != 0.0 && values[0].rest() < 1e-15 && values[1].rest() == 1.0);
/// # Ok::<(), pc_expr::ExprError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weighed {
    /// The number.
    pub value: f64,
    weight: f64,
    /// Whether the number is 0 only because its nonzero value was too small to be represented, such as
    /// exp(−10⁶).
    lost: bool,
}

impl Weighed {
    /// A number that has been rounded.
    #[must_use]
    pub fn rounded(value: f64) -> Weighed {
        Weighed { value, weight: value.abs(), lost: false }
    }

    /// |a|, or the weight where that is larger.
    pub fn size(self) -> f64 {
        self.value.abs().max(self.weight)
    }

    /// The sum as a fraction of its terms, from 0 to 1; rounding leaves about 10⁻¹⁶.
    pub fn rest(self) -> f64 {
        if self.value == 0.0 { 0.0 } else { self.value.abs() / self.size() }
    }

    /// Whether the number and its weight are finite.
    pub fn is_finite(self) -> bool {
        self.value.is_finite() && self.weight.is_finite()
    }

    /// Whether this is a finite number that is 0 only where the exact value is 0.
    pub fn is_known(self) -> bool {
        self.is_finite() && !self.lost
    }

    /// f(a), weighed by how much it changes with each of its arguments.
    fn of<const N: usize>(args: [Weighed; N], f: impl Fn([f64; N]) -> f64) -> Weighed {
        let at = args.map(|arg| arg.value);
        let value = f(at);
        let mut weight = value.abs();
        for (i, arg) in args.iter().enumerate().filter(|(_, arg)| arg.weight > 0.0) {
            for change in [-CHANGE, CHANGE] {
                let mut moved = at;
                moved[i] += change * arg.size();
                weight = weight.max((f(moved) - value).abs() / CHANGE); // outside its domain f gives no weight
            }
        }
        // Of the functions without zeros only exp has values that are too small.
        let lost = value == 0.0 && args.iter().any(|arg| arg.lost);
        Weighed { value, weight, lost }
    }
}

impl Add for Weighed {
    type Output = Weighed;
    fn add(self, other: Weighed) -> Weighed {
        let value = self.value + other.value;
        let lost = value == 0.0 && (self.lost || other.lost);
        Weighed { value, weight: self.size() + other.size(), lost }
    }
}

impl Mul for Weighed {
    type Output = Weighed;
    fn mul(self, other: Weighed) -> Weighed {
        let value = self.value * other.value;
        let errors = (self.value.abs() * other.weight).max(self.weight * other.value.abs());
        let is_zero = |factor: Weighed| factor.value == 0.0 && !factor.lost;
        let lost = value == 0.0 && !is_zero(self) && !is_zero(other);
        Weighed { value, weight: value.abs().max(errors), lost }
    }
}

impl Neg for Weighed {
    type Output = Weighed;
    fn neg(self) -> Weighed {
        Weighed { value: -self.value, ..self }
    }
}

impl Scalar for Weighed {
    fn from_f64(value: f64) -> Weighed {
        Weighed { value, weight: 0.0, lost: false }
    }

    /// A constant as small as a rounding error, like cos(π/2), counts as the remainder of numbers of order
    /// one.
    fn constant(value: Number) -> Weighed {
        const LEAST: f64 = f64::EPSILON / 16.0;
        const MOST: f64 = f64::EPSILON * 64.0;
        match value {
            Number::Rational { .. } | Number::Scaled { .. } => Weighed::from_f64(value.to_f64()),
            Number::Real(value) if (LEAST..MOST).contains(&value.abs()) => {
                Weighed { value, weight: 1.0, lost: false }
            }
            Number::Real(value) => Weighed::rounded(value),
        }
    }

    fn powi(self, exponent: i32) -> Weighed {
        if exponent == 1 {
            return self;
        }
        let power = Weighed::of([self], |[x]| x.powi(exponent));
        Weighed { lost: power.value == 0.0 && (self.lost || self.value != 0.0), ..power }
    }

    fn call(function: Function, args: &[Weighed]) -> Weighed {
        match *args {
            [x] => {
                let value = Weighed::of([x], |args| f64::call(function, &args));
                Weighed { lost: value.lost || (function == Function::Exp && value.value == 0.0), ..value }
            }
            [x, y] => Weighed::of([x, y], |args| f64::call(function, &args)),
            [x, y, z] => Weighed::of([x, y, z], |args| f64::call(function, &args)),
            _ => Weighed::from_f64(f64::NAN), // all functions have one to three arguments
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exact(value: f64) -> Weighed {
        Weighed::from_f64(value)
    }

    #[test]
    fn small_numbers_and_rounding_errors_are_distinguished() {
        let small = exact(1e-10) * exact(0.3);
        assert_eq!(small.rest(), 1.0);
        let third = exact(0.1) * exact(3.0);
        let rounding = third + -exact(0.3);
        assert!(rounding.value != 0.0 && rounding.rest() < 1e-15, "{rounding:?}");
        // It stays a rounding error when multiplied, or passed through a function.
        let sine = Weighed::call(Function::Sin, &[rounding * exact(1e3)]);
        assert!(sine.value != 0.0 && sine.rest() < 1e-15, "{sine:?}");
        let sign = Weighed::call(Function::Sign, &[rounding]);
        assert!(sign.value != 0.0 && sign.rest() <= CHANGE, "{sign:?}");
        assert_eq!((rounding + exact(1.0)).rest(), 1.0 / 1.6);
        assert_eq!((exact(2.0) + -exact(2.0)).rest(), 0.0);
    }

    #[test]
    fn a_function_enlarges_errors_by_its_slope() {
        // The error of 10⁶ − 10⁶ + 1 is that of 10⁶, and so is the one of its logarithm.
        let one = exact(1e6) + -exact(1e6) + exact(1.0);
        let log = Weighed::call(Function::Log, &[one]);
        let relative = log.size() / one.size() - 1.0;
        // log(1 + h) − h = h²/2, where h = CHANGE·2·10⁶
        assert!(relative.abs() < CHANGE * 2e6, "{relative}");
        let large = Weighed::call(Function::Sin, &[exact(1e9)]);
        assert_eq!(large.rest(), 1.0, "an exact argument has no error to enlarge");
    }

    #[test]
    fn a_number_that_is_too_small_is_not_zero() {
        let vanished = Weighed::call(Function::Exp, &[exact(-1e6)]);
        assert!(vanished.value == 0.0 && !vanished.is_known());
        assert!(!(vanished * exact(1e3)).is_known() && !(vanished + exact(0.0)).is_known());
        assert!(!Weighed::call(Function::Sin, &[vanished]).is_known() && !vanished.powi(2).is_known());
        assert!(!(exact(1e-200) * exact(1e-200)).is_known() && !exact(1e-200).powi(2).is_known());
        // Beside 1 it does not count, and an exact zero is one.
        assert!((vanished + exact(1.0)).is_known() && Weighed::call(Function::Cos, &[vanished]).is_known());
        assert!((exact(0.0) * exact(2.0)).is_known() && exact(0.0).powi(3).is_known());
    }

    #[test]
    fn the_rounding_error_of_a_constant_is_not_a_small_constant() {
        let zero = Weighed::constant(Number::from((std::f64::consts::PI / 2.0).cos()));
        assert!(zero.rest() < 1e-16 && (zero * exact(1e3)).rest() < 1e-16);
        for small in [1e-10, 1e-14, 1e-20] {
            assert_eq!(Weighed::constant(Number::from(small)).rest(), 1.0);
        }
    }
}

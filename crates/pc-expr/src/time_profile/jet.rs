//! A function of time with its first two derivatives, enclosed over an interval.

use super::interval::Interval;
use crate::graph::function::Function;
use crate::program::program::{Instruction, Register};

/// Enclosures of v, v̇ and v̈ over an interval of time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Jet {
    pub(crate) value: Interval,
    pub(crate) rate: Interval,
    pub(crate) bend: Interval,
}

impl Jet {
    pub(crate) fn constant(x: f64) -> Jet {
        Jet::line(Interval::point(x), 0.0)
    }

    /// A function that passes through `value` at this rate.
    pub(crate) fn line(value: Interval, rate: f64) -> Jet {
        Jet { value, rate: Interval::point(rate), bend: Interval::ZERO }
    }

    /// Values with unknown derivatives: where a function jumps or has a corner.
    fn rough(value: Interval) -> Jet {
        Jet { value, rate: Interval::ALL, bend: Interval::ALL }
    }

    /// F(u) with F, F′ and F″ over the values of u.
    fn chain(self, f: Interval, first: Interval, second: Interval) -> Jet {
        Jet { value: f, rate: first * self.rate, bend: second * self.rate.square() + first * self.bend }
    }

    fn add(self, other: Jet) -> Jet {
        Jet { value: self.value + other.value, rate: self.rate + other.rate, bend: self.bend + other.bend }
    }

    fn negate(self) -> Jet {
        Jet { value: -self.value, rate: -self.rate, bend: -self.bend }
    }

    fn multiply(self, other: Jet) -> Jet {
        Jet {
            value: self.value * other.value,
            rate: self.rate * other.value + self.value * other.rate,
            bend: self.bend * other.value + (self.rate * other.rate).scale(2.0) + self.value * other.bend,
        }
    }

    fn square(self) -> Jet {
        self.chain(self.value.square(), self.value.scale(2.0), Interval::point(2.0))
    }

    pub(crate) fn recip(self) -> Jet {
        let inverse = self.value.recip();
        let square = inverse.square();
        self.chain(inverse, -square, (square * inverse).scale(2.0))
    }

    fn exp(self) -> Jet {
        let values = self.value.exp();
        self.chain(values, values, values)
    }

    fn ln(self) -> Jet {
        let inverse = self.value.from(0.0).recip();
        self.chain(self.value.ln(), inverse, -inverse.square())
    }

    fn atan(self) -> Jet {
        let first = (self.value.square() + Interval::ONE).recip();
        self.chain(self.value.atan(), first, (self.value * first.square()).scale(-2.0))
    }

    fn asin(self) -> Jet {
        let u = self.value.within(-1.0, 1.0);
        let left = (Interval::ONE - u.square()).from(0.0);
        let first = left.sqrt().recip();
        self.chain(u.asin(), first, u * first * left.recip())
    }

    fn abs(self) -> Jet {
        match self.value.sign() {
            Some(0 | 1) => self,
            Some(_) => self.negate(),
            None => Jet {
                value: Interval { lo: 0.0, hi: self.value.size() },
                rate: self.rate.hull(-self.rate),
                bend: Interval::ALL,
            },
        }
    }

    /// The lesser of two functions.
    fn min(self, other: Jet) -> Jet {
        if self.value.hi <= other.value.lo {
            return self;
        }
        if other.value.hi <= self.value.lo {
            return other;
        }
        let (a, b) = (self.value, other.value);
        Jet {
            value: Interval { lo: a.lo.min(b.lo), hi: a.hi.min(b.hi) },
            rate: self.rate.hull(other.rate),
            bend: Interval::ALL,
        }
    }

    /// −1, 0 or 1
    fn signum(self) -> Jet {
        if self.value.lo > 0.0 {
            Jet::constant(1.0)
        } else if self.value.hi < 0.0 {
            Jet::constant(-1.0)
        } else if self.value == Interval::ZERO {
            Jet::constant(0.0)
        } else {
            Jet::rough(Interval { lo: -1.0, hi: 1.0 })
        }
    }

    /// `a` where this function is not negative, else `b`.
    fn step(self, a: Jet, b: Jet) -> Jet {
        if self.value.lo >= 0.0 {
            a
        } else if self.value.hi < 0.0 {
            b
        } else {
            Jet::rough(a.value.hull(b.value))
        }
    }

    fn powf(self, exponent: Jet) -> Jet {
        if !exponent.value.is_point() || exponent.rate != Interval::ZERO {
            return self.ln().multiply(exponent).exp();
        }
        let (u, c) = (self.value, exponent.value.lo);
        self.chain(u.powf(c), u.powf(c - 1.0).scale(c), u.powf(c - 2.0).scale(c * (c - 1.0)))
    }

    /// The angle of the point (x, y), of which `self` is y.
    fn atan2(self, x: Jet) -> Jet {
        if x.value.lo > 0.0 {
            return self.multiply(x.recip()).atan();
        }
        let (y, r2) = (self, self.square().add(x.square()));
        let on_cut = y.value.lo <= 0.0 && y.value.hi >= 0.0;
        if on_cut || r2.value.lo <= 0.0 {
            return Jet::rough(Interval { lo: -std::f64::consts::PI, hi: std::f64::consts::PI });
        }
        // Away from the cut the extremes are at corners.
        let corners = [(y.value.lo, x.value.lo), (y.value.lo, x.value.hi), (y.value.hi, x.value.lo)];
        let value = corners.iter().fold(Interval::point(y.value.hi.atan2(x.value.hi)), |hull, (y, x)| {
            hull.hull(Interval::point(y.atan2(*x)))
        });
        let moment = x.value * y.rate - y.value * x.rate;
        let moment_rate = x.value * y.bend - y.value * x.bend;
        let inverse = r2.value.recip();
        Jet {
            value,
            rate: moment * inverse,
            bend: moment_rate * inverse - moment * r2.rate * inverse.square(),
        }
    }

    fn call(function: Function, [u, v, w]: [Jet; 3]) -> Jet {
        let x = u.value;
        match function {
            Function::Sin => u.chain(x.sin(), x.cos(), -x.sin()),
            Function::Cos => u.chain(x.cos(), -x.sin(), -x.cos()),
            Function::Asin => u.asin(),
            Function::Acos => u.asin().negate().add(Jet::constant(std::f64::consts::FRAC_PI_2)),
            Function::Atan => u.atan(),
            Function::Atan2 => u.atan2(v),
            Function::Sinh => u.chain(x.sinh(), x.cosh(), x.sinh()),
            Function::Cosh => u.chain(x.cosh(), x.sinh(), x.cosh()),
            Function::Tanh => {
                let tanh = x.tanh();
                let first = (Interval::ONE - tanh.square()).from(0.0);
                u.chain(tanh, first, (tanh * first).scale(-2.0))
            }
            Function::Exp => u.exp(),
            Function::Log => u.ln(),
            Function::Sqrt => {
                let root = x.sqrt();
                let first = root.scale(2.0).recip();
                u.chain(root, first, -(first * x.from(0.0).scale(2.0).recip()))
            }
            Function::Abs => u.abs(),
            Function::Sign => u.signum(),
            Function::Min => u.min(v),
            Function::Max => u.negate().min(v.negate()).negate(),
            Function::Step => u.step(v, w),
            Function::Pow => u.powf(v),
        }
    }

    /// The jet of an instruction from those of its operands.
    pub(crate) fn of(instruction: &Instruction, jet: impl Fn(Register) -> Jet) -> Jet {
        let product = |a, b| if a == b { jet(a).square() } else { jet(a).multiply(jet(b)) };
        match *instruction {
            Instruction::Add(a, b) => jet(a).add(jet(b)),
            Instruction::Subtract(a, b) => jet(a).add(jet(b).negate()),
            Instruction::Multiply(a, b) => product(a, b),
            Instruction::Divide(a, b) => jet(a).multiply(jet(b).recip()),
            Instruction::Negate(a) => jet(a).negate(),
            Instruction::MultiplyAdd(a, b, c) => product(a, b).add(jet(c)),
            Instruction::MultiplySubtract(a, b, c) => product(a, b).add(jet(c).negate()),
            Instruction::NegateMultiplyAdd(a, b, c) => jet(c).add(product(a, b).negate()),
            Instruction::NegateMultiplySubtract(a, b, c) => product(a, b).add(jet(c)).negate(),
            Instruction::Call(function, args) => Jet::call(function, args.map(jet)),
        }
    }
}

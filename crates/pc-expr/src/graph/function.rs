//! The elementary functions an expression may contain, each with one name, one arity and one value.

use serde::{Deserialize, Serialize};

/// A function of one, two or three arguments.
///
/// tan, cot and small integer powers are written in terms of these functions and of products.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[allow(missing_docs)] // each variant is the function of its name
pub enum Function {
    Sin,
    Cos,
    Asin,
    Acos,
    Atan,
    /// `atan2(y, x)`, the angle of the point (x, y).
    Atan2,
    Sinh,
    Cosh,
    Tanh,
    Exp,
    /// Natural logarithm.
    Log,
    Sqrt,
    Abs,
    /// −1, 0 or 1.
    Sign,
    Min,
    Max,
    /// `step(x, a, b)`: a where x ≥ 0, else b.
    Step,
    /// `pow(x, y)` for an exponent that is not an integer, or a very large one.
    Pow,
}

impl Function {
    /// Every function, in the order of declaration.
    pub const ALL: [Function; 18] = {
        use Function::*;
        [Sin, Cos, Asin, Acos, Atan, Atan2, Sinh, Cosh, Tanh, Exp, Log, Sqrt, Abs, Sign, Min, Max, Step, Pow]
    };

    /// Name in the expression language.
    pub fn name(self) -> &'static str {
        match self {
            Function::Sin => "sin",
            Function::Cos => "cos",
            Function::Asin => "asin",
            Function::Acos => "acos",
            Function::Atan => "atan",
            Function::Atan2 => "atan2",
            Function::Sinh => "sinh",
            Function::Cosh => "cosh",
            Function::Tanh => "tanh",
            Function::Exp => "exp",
            Function::Log => "log",
            Function::Sqrt => "sqrt",
            Function::Abs => "abs",
            Function::Sign => "sign",
            Function::Min => "min",
            Function::Max => "max",
            Function::Step => "step",
            Function::Pow => "pow",
        }
    }

    /// Number of arguments.
    pub fn arity(self) -> usize {
        match self {
            Function::Atan2 | Function::Min | Function::Max | Function::Pow => 2,
            Function::Step => 3,
            _ => 1,
        }
    }

    /// Whether the function has derivatives of every order wherever it has a value: no jump, no corner, no
    /// root.
    pub fn is_smooth(self) -> bool {
        use Function::*;
        !matches!(self, Asin | Acos | Atan2 | Sqrt | Abs | Sign | Min | Max | Step | Pow)
    }

    /// Whether the function has no jump.
    pub fn is_continuous(self) -> bool {
        !matches!(self, Function::Atan2 | Function::Sign | Function::Step)
    }

    /// Whether the function consists of several pieces, each on a part of its domain.
    pub fn is_piecewise(self) -> bool {
        matches!(self, Function::Abs | Function::Sign | Function::Min | Function::Max | Function::Step)
    }

    /// Symmetry under x → −x of a function of one argument.
    pub(crate) fn parity(self) -> Parity {
        match self {
            Function::Sin
            | Function::Asin
            | Function::Atan
            | Function::Sinh
            | Function::Tanh
            | Function::Sign => Parity::Odd,
            Function::Cos | Function::Cosh | Function::Abs => Parity::Even,
            _ => Parity::None,
        }
    }

    /// The value at real arguments; `args` has [`arity`](Function::arity) entries (more are ignored).
    #[inline]
    pub fn eval(self, args: &[f64]) -> f64 {
        let x = args[0];
        match self {
            Function::Sin => x.sin(),
            Function::Cos => x.cos(),
            Function::Asin => x.asin(),
            Function::Acos => x.acos(),
            Function::Atan => x.atan(),
            Function::Atan2 => x.atan2(args[1]),
            Function::Sinh => x.sinh(),
            Function::Cosh => x.cosh(),
            Function::Tanh => x.tanh(),
            Function::Exp => x.exp(),
            Function::Log => x.ln(),
            Function::Sqrt => x.sqrt(),
            Function::Abs => x.abs(),
            Function::Sign if x > 0.0 => 1.0,
            Function::Sign if x < 0.0 => -1.0,
            Function::Sign => x * 0.0, // NaN stays NaN
            Function::Min if x.is_nan() || args[1].is_nan() => f64::NAN,
            Function::Max if x.is_nan() || args[1].is_nan() => f64::NAN,
            Function::Min => x.min(args[1]),
            Function::Max => x.max(args[1]),
            Function::Step if x.is_nan() => f64::NAN,
            Function::Step => {
                if x >= 0.0 {
                    args[1]
                } else {
                    args[2]
                }
            }
            Function::Pow => x.powf(args[1]),
        }
    }
}

/// Behaviour of a function under a change of sign of its argument.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Parity {
    Even,
    Odd,
    None,
}

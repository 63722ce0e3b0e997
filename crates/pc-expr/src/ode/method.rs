//! The methods of integration.

use std::fmt;

/// A family of variable-step methods.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash)]
pub enum Method {
    /// Adams–Moulton formulas of orders 1 to 12, for non-stiff systems.
    Adams,
    /// Backward differentiation formulas of orders 1 to 5, for stiff systems.
    Bdf,
    /// The explicit Runge–Kutta method of order 8 of Dormand and Prince, for non-stiff systems at
    /// tolerances of 1e-6 and below: the fastest if f is cheap.
    Dop853,
    /// Taylor's method of adaptive order and step, for non-stiff systems whose f is a program: the
    /// fastest at tolerances of 1e-8 and below, and accurate to rounding error.
    Taylor,
    /// [`Dop853`](Method::Dop853) where the motion is not stiff, [`Bdf`](Method::Bdf) where
    /// stiffness is detected: the default method of a run.
    #[default]
    Auto,
}

impl Method {
    /// All methods.
    pub const ALL: [Method; 5] = [Method::Adams, Method::Bdf, Method::Dop853, Method::Taylor, Method::Auto];

    /// The name of the method in model files, on command lines and in Python.
    pub fn name(self) -> &'static str {
        match self {
            Method::Adams => "adams",
            Method::Bdf => "bdf",
            Method::Dop853 => "dop853",
            Method::Taylor => "taylor",
            Method::Auto => "auto",
        }
    }

    /// The method with this [`name`](Method::name).
    pub fn named(name: &str) -> Option<Method> {
        Method::ALL.into_iter().find(|method| method.name() == name)
    }

    /// The highest order of the family.
    pub fn highest_order(self) -> u32 {
        match self {
            Method::Bdf => 5,
            Method::Adams => 12,
            Method::Dop853 | Method::Auto => 8,
            Method::Taylor => 40,
        }
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Method::Bdf => "BDF",
            Method::Adams => "Adams",
            Method::Dop853 => "DOP853",
            Method::Taylor => "Taylor",
            Method::Auto => "auto",
        })
    }
}

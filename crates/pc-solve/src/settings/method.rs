//! Methods, and how their implicit equations are solved.

use std::fmt;

/// A family of linear multistep methods of variable order and step.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Method {
    /// Backward differentiation formulas of orders 1 to 5, for stiff systems.
    Bdf,
    /// Adams–Moulton formulas of orders 1 to 12, for systems that are not stiff.
    Adams,
}

impl Method {
    /// The highest order of the family.
    pub fn highest_order(self) -> u32 {
        match self {
            Method::Bdf => 5,
            Method::Adams => 12,
        }
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Method::Bdf => "BDF",
            Method::Adams => "Adams",
        })
    }
}

/// How the implicit equation of a step is solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum NonlinearSolver {
    /// Newton's iteration, with a [`LinearSolver`](crate::LinearSolver).
    Newton,
    /// Fixed-point iteration, which needs no matrix but contracts only for small steps of a stiff system.
    FixedPoint,
}

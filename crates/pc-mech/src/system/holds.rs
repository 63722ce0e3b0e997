//! What holds a joint at rest more firmly than the forces of its motion do.

use pc_expr::Expr;

/// Stops count as reached within this fraction of the way between them.
const REACHED: f64 = 1e-9;

/// Forces that act at rest only, so that they are no part of Q: each holds a velocity v at zero.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Hold<'g> {
    /// Dry friction −F sign v that holds up to F_s: v is the `rate`, and F_s/F the `ratio`.
    Stiction { rate: Expr<'g>, ratio: Expr<'g> },
    /// A rigid stop: it pushes with N ≥ 0 where the `gap` is closed and its `rate` v is zero. `way` is the size of
    /// gaps.
    Stop { gap: Expr<'g>, rate: Expr<'g>, way: Expr<'g> },
}

impl<'g> Hold<'g> {
    /// The function that vanishes where the hold acts: v; for a stop that is not reached, 1.
    pub(crate) fn function(&self) -> Expr<'g> {
        match *self {
            Hold::Stiction { rate, .. } => rate,
            Hold::Stop { gap, rate, way } => (REACHED * way - gap).step(rate, 1.0),
        }
    }

    /// The velocity v.
    pub(crate) fn rate(&self) -> Expr<'g> {
        match *self {
            Hold::Stiction { rate, .. } | Hold::Stop { rate, .. } => rate,
        }
    }

    /// The gap of a stop.
    pub(crate) fn gap(&self) -> Option<Expr<'g>> {
        match *self {
            Hold::Stiction { .. } => None,
            Hold::Stop { gap, .. } => Some(gap),
        }
    }

    /// F_s/F
    pub(crate) fn ratio(&self) -> Option<Expr<'g>> {
        match *self {
            Hold::Stiction { ratio, .. } => Some(ratio),
            Hold::Stop { .. } => None,
        }
    }

    /// The same hold with `put` applied to its expressions.
    pub(crate) fn map<'n>(&self, put: impl Fn(Expr<'g>) -> Expr<'n>) -> Hold<'n> {
        match *self {
            Hold::Stiction { rate, ratio } => Hold::Stiction { rate: put(rate), ratio: put(ratio) },
            Hold::Stop { gap, rate, way } => Hold::Stop { gap: put(gap), rate: put(rate), way: put(way) },
        }
    }
}

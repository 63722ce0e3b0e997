//! Verdicts on an identity.

/// Whether an identity holds. The graph proves it, or numbers disprove it; between the two it stays open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Identity {
    /// The graph folds it to zero.
    Proved,
    /// The graph does not, but the numerical residual is small enough to be rounding, or there are no numbers (∞).
    Open {
        /// The part of the terms that is left.
        rest: f64,
    },
    /// The numerical residual is larger than any rounding.
    Disproved {
        /// The part of the terms that is left.
        rest: f64,
    },
}

impl Identity {
    /// What is left of the terms of a sum that differs from zero is of their order; rounding, even where derivatives of
    /// roots enlarge it a million times, leaves less.
    const MARGIN: f64 = 1e-6;

    /// The verdict by the [residual](crate::Neighbourhood::residual) of an identity.
    pub fn of(residual: f64) -> Identity {
        match residual {
            0.0 => Identity::Proved,
            rest if rest.is_finite() && rest > Identity::MARGIN => Identity::Disproved { rest },
            rest => Identity::Open { rest },
        }
    }
}

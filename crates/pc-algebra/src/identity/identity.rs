//! Verdicts on an identity.

/// Whether an identity holds. The graph proves it, or numbers disprove it; between the two it stays open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Identity {
    /// The graph folds it to zero.
    Proved,
    /// The graph does not fold it, but the numerical residual is small enough to be rounding, or there are no
    /// numbers (∞).
    Open {
        /// The residual, as a fraction of the terms.
        rest: f64,
    },
    /// The numerical residual is larger than any rounding.
    Disproved {
        /// The residual, as a fraction of the terms.
        rest: f64,
    },
}

impl Identity {
    /// The greatest residual that rounding may leave, even where derivatives of roots magnify it a million
    /// times; a sum that is not zero is of the order of its terms.
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

//! Verdicts on an identity.

/// Whether an identity holds. The graph may prove the identity, or numbers may disprove it; otherwise it
/// stays open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Identity {
    /// The graph folds the expression to zero.
    Proved,
    /// The graph does not fold the expression, but the numerical residual is small enough to be rounding
    /// error, or there are no numerical values (∞).
    Open {
        /// The residual, as a fraction of the size of the terms.
        rest: f64,
    },
    /// The numerical residual is larger than any rounding error.
    Disproved {
        /// The residual, as a fraction of the size of the terms.
        rest: f64,
    },
}

impl Identity {
    /// The greatest residual that rounding errors may leave, even where derivatives of roots magnify it a
    /// million times; a sum that is not zero is of the order of its terms.
    const MARGIN: f64 = 1e-6;

    /// The verdict that follows from the [residual](crate::Neighbourhood::residual) of an identity.
    pub fn of(residual: f64) -> Identity {
        match residual {
            0.0 => Identity::Proved,
            rest if rest.is_finite() && rest > Identity::MARGIN => Identity::Disproved { rest },
            rest => Identity::Open { rest },
        }
    }
}

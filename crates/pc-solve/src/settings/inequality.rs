//! Inequalities that components have to satisfy.

use std::fmt;

/// A condition on a component of y at the end of every step, so that f is not evaluated far outside
/// its domain.
///
/// If the state at the end of a step violates the condition slightly, the state is corrected;
/// otherwise the step is repeated with a shorter length. Inside a step, the polynomial of the
/// method may violate the condition by up to the tolerance. Where the motion itself leaves the
/// allowed region, the steps become ever shorter, until the limit on steps or the minimum step ends
/// the integration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Inequality {
    /// No condition.
    Free,
    /// y ≥ 0.
    NotNegative,
    /// y ≤ 0.
    NotPositive,
    /// y > 0.
    Positive,
    /// y < 0.
    Negative,
}

impl Inequality {
    /// Whether `value` satisfies the inequality.
    pub fn holds(self, value: f64) -> bool {
        match self {
            Inequality::Free => true,
            Inequality::NotNegative => value >= 0.0,
            Inequality::NotPositive => value <= 0.0,
            Inequality::Positive => value > 0.0,
            Inequality::Negative => value < 0.0,
        }
    }
}

impl fmt::Display for Inequality {
    /// What the component must be, for example `zero or positive`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Inequality::Free => "any number",
            Inequality::NotNegative => "zero or positive",
            Inequality::NotPositive => "zero or negative",
            Inequality::Positive => "positive",
            Inequality::Negative => "negative",
        })
    }
}

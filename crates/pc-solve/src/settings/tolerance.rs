//! Absolute tolerances.

/// The absolute tolerance: a single number for all components, or one number for each.
#[derive(Debug, Clone, PartialEq)]
pub enum Tolerance {
    /// The same tolerance for all components.
    Scalar(f64),
    /// One tolerance for each component, in order.
    Vector(Vec<f64>),
}

impl Tolerance {
    /// The tolerances of the components, reduced to a single tolerance if they are all equal.
    pub fn each(tolerances: Vec<f64>) -> Tolerance {
        match tolerances.split_first() {
            Some((first, rest)) if rest.iter().all(|other| other == first) => Tolerance::Scalar(*first),
            _ => Tolerance::Vector(tolerances),
        }
    }
}

impl From<f64> for Tolerance {
    fn from(tolerance: f64) -> Self {
        Tolerance::Scalar(tolerance)
    }
}

impl From<Vec<f64>> for Tolerance {
    fn from(tolerances: Vec<f64>) -> Self {
        Tolerance::Vector(tolerances)
    }
}

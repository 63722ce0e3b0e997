//! Integrals along an integration.

use pc_expr::Failure;

use crate::cvode::handles::Vector;

/// A vector field with integrals q̇ = r(t, y) that do not act on it.
pub(crate) trait Quadratures {
    /// Number of integrals, at least 1.
    fn count(&self) -> usize;

    /// Writes r(t, y), all finite.
    fn integrands(&mut self, t: f64, y: &[f64], rates: &mut [f64]) -> Result<(), Failure>;
}

/// What an integration with integrals has besides.
pub(crate) struct Quadrature {
    /// Where CVODES writes them.
    pub(super) values: Vector,
    /// As they were at the last start.
    pub(super) start: Vec<f64>,
}

//! Integrals along an integration.

use pc_expr::Failure;

use crate::cvode::handles::Vector;

/// A vector field with integrals q̇ = r(t, y) that do not affect it.
pub(crate) trait Quadratures {
    /// The number of integrals, at least 1.
    fn count(&self) -> usize;

    /// Writes r(t, y), which must be finite.
    fn integrands(&mut self, t: f64, y: &[f64], rates: &mut [f64]) -> Result<(), Failure>;
}

/// The data of the integrals of an integration.
pub(crate) struct Quadrature {
    /// Room for the values of the integrals, written by CVODES.
    pub(super) values: Vector,
    /// The values of the integrals at the last start or restart.
    pub(super) start: Vec<f64>,
}

//! What every integrator takes: ẏ = f(t, y).

use std::error::Error;

/// A first-order system ẏ = f(t, y) of [`dim`](VectorField::dim) equations.
///
/// Implemented by compiled equations of motion and by anything a user writes; integrators know nothing else.
pub trait VectorField {
    /// Number of components of y.
    fn dim(&self) -> usize;

    /// Writes f(t, y) to `ydot`; both slices have length [`dim`](VectorField::dim).
    ///
    /// # Errors
    /// [`Failure`] where f is not defined; a recoverable one lets an integrator try a smaller step.
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure>;

    /// Whether [`jacobian`](VectorField::jacobian) is implemented; if not, integrators take difference quotients.
    fn has_jacobian(&self) -> bool {
        false
    }

    /// Writes ∂f_i/∂y_j to `jacobian[i + j * dim]` (column-major, dim × dim, every entry written).
    ///
    /// Called only if [`has_jacobian`](VectorField::has_jacobian) answers true.
    ///
    /// # Errors
    /// [`Failure`], as for [`rhs`](VectorField::rhs).
    fn jacobian(&mut self, _t: f64, _y: &[f64], _jacobian: &mut [f64]) -> Result<(), Failure> {
        Err(Failure::fatal(NoJacobian))
    }

    /// Name of component `i` of y, for messages.
    fn component_name(&self, i: usize) -> String {
        format!("y[{i}]")
    }
}

/// Why a function of (t, y) could not be evaluated, and whether a nearby state may succeed.
#[derive(Debug, thiserror::Error)]
#[error("{source}")]
pub struct Failure {
    recoverable: bool,
    source: Box<dyn Error + Send + Sync>,
}

impl Failure {
    /// A failure that a smaller step may avoid, such as a state outside the domain of a function.
    pub fn recoverable(source: impl Error + Send + Sync + 'static) -> Self {
        Failure { recoverable: true, source: Box::new(source) }
    }

    /// A failure that ends the integration.
    pub fn fatal(source: impl Error + Send + Sync + 'static) -> Self {
        Failure { recoverable: false, source: Box::new(source) }
    }

    /// Whether a smaller step may avoid the failure.
    pub fn is_recoverable(&self) -> bool {
        self.recoverable
    }

    /// What went wrong.
    pub fn cause(&self) -> &(dyn Error + Send + Sync + 'static) {
        self.source.as_ref()
    }
}

#[derive(Debug, thiserror::Error)]
#[error("this vector field has no Jacobian")]
struct NoJacobian;

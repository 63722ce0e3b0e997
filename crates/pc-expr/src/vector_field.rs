//! What every integrator takes: ẏ = f(t, y).

use std::error::Error;
use std::fmt;

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

impl<F: VectorField + ?Sized> VectorField for &mut F {
    fn dim(&self) -> usize {
        (**self).dim()
    }
    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        (**self).rhs(t, y, ydot)
    }
    fn has_jacobian(&self) -> bool {
        (**self).has_jacobian()
    }
    fn jacobian(&mut self, t: f64, y: &[f64], jacobian: &mut [f64]) -> Result<(), Failure> {
        (**self).jacobian(t, y, jacobian)
    }
    fn component_name(&self, i: usize) -> String {
        (**self).component_name(i)
    }
}

/// Why a function of (t, y) could not be evaluated, and whether a nearby state may succeed.
///
/// It speaks as its cause does.
#[derive(Debug)]
pub struct Failure {
    recoverable: bool,
    cause: Box<dyn Error + Send + Sync>,
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.cause.fmt(f)
    }
}

impl Error for Failure {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        self.cause.source()
    }
}

impl Failure {
    /// A failure that a smaller step may avoid, such as a state outside the domain of a function.
    pub fn recoverable(cause: impl Error + Send + Sync + 'static) -> Self {
        Failure { recoverable: true, cause: Box::new(cause) }
    }

    /// A failure that ends the integration.
    pub fn fatal(cause: impl Error + Send + Sync + 'static) -> Self {
        Failure { recoverable: false, cause: Box::new(cause) }
    }

    /// Whether a smaller step may avoid the failure.
    pub fn is_recoverable(&self) -> bool {
        self.recoverable
    }

    /// What went wrong.
    pub fn cause(&self) -> &(dyn Error + Send + Sync + 'static) {
        self.cause.as_ref()
    }
}

#[derive(Debug, thiserror::Error)]
#[error("this vector field has no Jacobian")]
struct NoJacobian;

//! Methods of integration with their options.

use pc_expr::VectorField;

use crate::error::SolveError;
use crate::integration::stepper::Stepper;

/// A method with its options, which can begin at a state.
pub trait IntegrationMethod<F: VectorField> {
    /// The method after it has begun.
    type Stepper: Stepper<Field = F>;

    /// Begins at y(t0) = y0; the field must never be evaluated beyond `stop`, nor beyond the stop
    /// time of the method.
    ///
    /// # Errors
    /// [`SolveError::Input`] unless all inputs are finite, of matching lengths and in their ranges.
    fn begin(&self, field: F, t0: f64, y0: &[f64], stop: Option<f64>) -> Result<Self::Stepper, SolveError>;
}

impl<F: VectorField, M: IntegrationMethod<F>> IntegrationMethod<F> for &M {
    type Stepper = M::Stepper;

    fn begin(&self, field: F, t0: f64, y0: &[f64], stop: Option<f64>) -> Result<M::Stepper, SolveError> {
        (**self).begin(field, t0, y0, stop)
    }
}

//! Functionals of a motion, and their gradients.

use pc_expr::Failure;

use crate::integration::statistics::Statistics;

/// A functional G = ∫ g(t, y, p) dt + h(t₁, y(t₁), p) of a motion from t₀ to t₁, with its
/// derivatives.
///
/// Both terms write their derivatives with respect to the state and the parameters of the field;
/// the derivatives with respect to the parameters are empty if the field does not provide [such
/// derivatives](pc_expr::VectorField::parameter_jacobian). Every entry must be written, including
/// zeros. A term that is not implemented is zero.
pub trait Functional {
    /// g(t, y), with ∂g/∂y and ∂g/∂p.
    ///
    /// # Errors
    /// [`Failure`] where g is not defined.
    fn density(
        &mut self,
        _t: f64,
        _y: &[f64],
        by_state: &mut [f64],
        by_parameters: &mut [f64],
    ) -> Result<f64, Failure> {
        by_state.fill(0.0);
        by_parameters.fill(0.0);
        Ok(0.0)
    }

    /// h(t₁, y(t₁)), with ∂h/∂y and ∂h/∂p.
    ///
    /// # Errors
    /// [`Failure`] where h is not defined.
    fn end(
        &mut self,
        _t: f64,
        _y: &[f64],
        by_state: &mut [f64],
        by_parameters: &mut [f64],
    ) -> Result<f64, Failure> {
        by_state.fill(0.0);
        by_parameters.fill(0.0);
        Ok(0.0)
    }
}

impl<G: Functional + ?Sized> Functional for Box<G> {
    fn density(
        &mut self,
        t: f64,
        y: &[f64],
        by_state: &mut [f64],
        by_parameters: &mut [f64],
    ) -> Result<f64, Failure> {
        (**self).density(t, y, by_state, by_parameters)
    }
    fn end(
        &mut self,
        t: f64,
        y: &[f64],
        by_state: &mut [f64],
        by_parameters: &mut [f64],
    ) -> Result<f64, Failure> {
        (**self).end(t, y, by_state, by_parameters)
    }
}

/// The value of a functional and its derivatives.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Gradient {
    /// G
    pub value: f64,
    /// The derivatives ∂G/∂y₀, one for each component of the field.
    pub by_start: Vec<f64>,
    /// The derivatives ∂G/∂p for an initial state that does not depend on p, one for each
    /// parameter; empty if the field does not provide derivatives with respect to its parameters.
    ///
    /// If the initial state does depend on p, add (∂y₀/∂p)ᵀ ∂G/∂y₀.
    pub by_parameters: Vec<f64>,
    /// The work of the forward integration to t₁ alone.
    pub statistics: Statistics,
}

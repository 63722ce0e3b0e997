//! Functionals of a motion, and their gradients.

use pc_expr::Failure;

use crate::integration::statistics::Statistics;

/// A functional G = ∫ g(t, y, p) dt + h(t₁, y(t₁), p) of a motion from t₀ to t₁, with its derivatives.
///
/// Both terms write their derivatives by the state, of the dimension of the field, and by the parameters: as many as
/// the field has, none if it has no [derivative](pc_expr::VectorField::parameter_jacobian) by them. Every entry must be written,
/// zeros too. A term that is left out is zero.
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

/// A functional and its derivatives.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Gradient {
    /// G
    pub value: f64,
    /// ∂G/∂y₀, of the dimension of the field.
    pub by_start: Vec<f64>,
    /// ∂G/∂p of a start that does not depend on p, one for each parameter; none if the field has no derivative by them.
    ///
    /// If it does, (∂y₀/∂p)ᵀ ∂G/∂y₀ is to be added.
    pub by_parameters: Vec<f64>,
    /// The work of the motion to t₁, without the way back.
    pub statistics: Statistics,
}

//! Closures as vector fields.

use pc_expr::{Failure, VectorField};

/// A vector field given by closures; made by [`from_fn`].
#[derive(Debug, Clone)]
pub struct FnField<R, J = fn(f64, &[f64], &mut [f64]) -> Result<(), Failure>> {
    dim: usize,
    rhs: R,
    jacobian: Option<J>,
    names: Vec<String>,
}

/// The vector field of dimension `dim` whose closure writes f(t, y) to its last argument.
///
/// Both slices have length `dim`. The closure reports where f is not defined as [`VectorField::rhs`] does.
pub fn from_fn<R>(dim: usize, rhs: R) -> FnField<R>
where
    R: FnMut(f64, &[f64], &mut [f64]) -> Result<(), Failure>,
{
    FnField { dim, rhs, jacobian: None, names: Vec::new() }
}

impl<R, J> FnField<R, J> {
    /// The same field with a closure that writes ∂fᵢ/∂yⱼ to entry `i + j * dim` of its last argument.
    ///
    /// Every entry must be written, zeros too.
    pub fn with_jacobian<K>(self, jacobian: K) -> FnField<R, K>
    where
        K: FnMut(f64, &[f64], &mut [f64]) -> Result<(), Failure>,
    {
        FnField { dim: self.dim, rhs: self.rhs, jacobian: Some(jacobian), names: self.names }
    }

    /// The same field with names of its components, for messages; a component without one is called `y[i]`.
    pub fn with_names<N: Into<String>>(self, names: impl IntoIterator<Item = N>) -> Self {
        FnField { names: names.into_iter().map(Into::into).collect(), ..self }
    }
}

impl<R, J> VectorField for FnField<R, J>
where
    R: FnMut(f64, &[f64], &mut [f64]) -> Result<(), Failure>,
    J: FnMut(f64, &[f64], &mut [f64]) -> Result<(), Failure>,
{
    fn dim(&self) -> usize {
        self.dim
    }

    fn rhs(&mut self, t: f64, y: &[f64], ydot: &mut [f64]) -> Result<(), Failure> {
        (self.rhs)(t, y, ydot)
    }

    fn has_jacobian(&self) -> bool {
        self.jacobian.is_some()
    }

    fn jacobian(&mut self, t: f64, y: &[f64], jacobian: &mut [f64]) -> Result<(), Failure> {
        match &mut self.jacobian {
            Some(evaluate) => evaluate(t, y, jacobian),
            None => Err(Failure::fatal(NoJacobian)),
        }
    }

    fn component_name(&self, i: usize) -> String {
        self.names.get(i).map_or_else(|| format!("y[{i}]"), Clone::clone)
    }
}

#[derive(Debug, thiserror::Error)]
#[error("this vector field was given no Jacobian")]
struct NoJacobian;

//! The linear part of a vector field at a state, from whatever the field offers.

use pc_expr::{Failure, VectorField};

use crate::error::NonFinite;
use crate::settings::options::Options;
use crate::settings::tolerance::Tolerance;

/// How products (∂f/∂y) v are computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Products {
    /// The field computes the products.
    Field,
    /// The products are formed with the ∂f/∂y that the field writes.
    Jacobian,
    /// (f(t, y + σv) − f(t, y − σv))/2σ
    #[default]
    Differences,
}

/// ∂f/∂y and ∂f/∂p of a field, and products with them.
///
/// Products are computed by the field if it can do so, else with its Jacobian, else as central
/// difference quotients. The relative error of a quotient is about ε^(2/3) = 4e-11 if σ|v| is
/// ε^(1/3) times the size of the state, where truncation and rounding errors are about equal. The
/// size of the state is max
/// |yᵢ|, but at least atol/rtol, the smallest significant size.
#[derive(Debug, Default)]
pub(crate) struct Linearisation {
    products: Products,
    least_size: f64,
    dim: usize,
    jacobian: Vec<f64>,
    by_parameters: Vec<f64>,
    /// Work space for difference quotients.
    moved: Vec<f64>,
    behind: Vec<f64>,
}

impl Linearisation {
    pub(crate) fn new(field: &impl VectorField, options: &Options) -> Linearisation {
        let products = if field.has_jvp() {
            Products::Field
        } else if field.has_jacobian() {
            Products::Jacobian
        } else {
            Products::Differences
        };
        let atol = match &options.absolute_tolerance {
            Tolerance::Scalar(atol) => *atol,
            Tolerance::Vector(atol) => atol.iter().copied().fold(0.0, f64::max),
        };
        Linearisation {
            products,
            least_size: atol / options.relative_tolerance,
            dim: field.dim(),
            ..Linearisation::default()
        }
    }

    /// Prepares for products at (t, y).
    pub(crate) fn prepare(&mut self, field: &mut impl VectorField, t: f64, y: &[f64]) -> Result<(), Failure> {
        if self.products == Products::Jacobian {
            self.jacobian(field, t, y)?;
        }
        Ok(())
    }

    /// Writes (∂f/∂y) v at the [prepared](Linearisation::prepare) state; entries may be NaN.
    pub(crate) fn product(
        &mut self,
        field: &mut impl VectorField,
        t: f64,
        y: &[f64],
        v: &[f64],
        product: &mut [f64],
    ) -> Result<(), Failure> {
        match self.products {
            Products::Field => {
                product.fill(f64::NAN);
                field.jvp(t, y, v, product)
            }
            Products::Jacobian => {
                product.fill(0.0);
                for (column, v) in self.jacobian.chunks_exact(self.dim).zip(v) {
                    for (product, entry) in product.iter_mut().zip(column) {
                        *product += entry * v;
                    }
                }
                Ok(())
            }
            Products::Differences => self.quotient(field, t, y, v, product),
        }
    }

    /// (f(t, y + σv) − f(t, y − σv))/2σ
    fn quotient(
        &mut self,
        field: &mut impl VectorField,
        t: f64,
        y: &[f64],
        v: &[f64],
        product: &mut [f64],
    ) -> Result<(), Failure> {
        let largest = |v: &[f64]| v.iter().fold(0.0, |size: f64, v| size.max(v.abs()));
        let length = largest(v);
        if length == 0.0 {
            product.fill(0.0);
            return Ok(());
        }
        let step = f64::EPSILON.cbrt() * largest(y).max(self.least_size) / length;
        self.moved.resize(self.dim, 0.0);
        self.behind.clear();
        self.behind.resize(self.dim, f64::NAN);
        product.fill(f64::NAN);
        self.rhs_at(field, t, y, v, step, product)?;
        let mut behind = std::mem::take(&mut self.behind);
        let outcome = self.rhs_at(field, t, y, v, -step, &mut behind);
        for (product, behind) in product.iter_mut().zip(&behind) {
            *product = (*product - behind) / (2.0 * step);
        }
        self.behind = behind;
        outcome
    }

    /// Writes f(t, y + step v).
    fn rhs_at(
        &mut self,
        field: &mut impl VectorField,
        t: f64,
        y: &[f64],
        v: &[f64],
        step: f64,
        rate: &mut [f64],
    ) -> Result<(), Failure> {
        for ((moved, y), v) in self.moved.iter_mut().zip(y).zip(v) {
            *moved = y + step * v;
        }
        field.rhs(t, &self.moved, rate)
    }

    /// ∂f/∂y, column-major; assembled column by column from products if the field does not write
    /// it.
    pub(crate) fn jacobian(
        &mut self,
        field: &mut impl VectorField,
        t: f64,
        y: &[f64],
    ) -> Result<&[f64], Failure> {
        let dim = self.dim;
        let mut jacobian = std::mem::take(&mut self.jacobian);
        jacobian.clear();
        jacobian.resize(dim * dim, f64::NAN);
        let outcome = if field.has_jacobian() {
            field.jacobian(t, y, &mut jacobian)
        } else {
            self.columns(field, t, y, &mut jacobian)
        };
        self.jacobian = jacobian;
        outcome?;
        match self.jacobian.iter().position(|entry| !entry.is_finite()) {
            None => Ok(&self.jacobian),
            Some(k) => Err(Failure::recoverable(NonFinite::Jacobian {
                row: field.component_name(k % dim),
                column: field.component_name(k / dim),
                value: self.jacobian[k],
                t,
            })),
        }
    }

    /// The products with the unit vectors.
    fn columns(
        &mut self,
        field: &mut impl VectorField,
        t: f64,
        y: &[f64],
        jacobian: &mut [f64],
    ) -> Result<(), Failure> {
        let mut unit = vec![0.0; self.dim];
        for (j, column) in jacobian.chunks_exact_mut(self.dim).enumerate() {
            unit[j] = 1.0;
            self.product(field, t, y, &unit, column)?;
            unit[j] = 0.0;
        }
        Ok(())
    }

    /// ∂f/∂p, column-major, of a field that provides it.
    pub(crate) fn parameter_jacobian(
        &mut self,
        field: &mut impl VectorField,
        t: f64,
        y: &[f64],
    ) -> Result<&[f64], Failure> {
        let dim = self.dim;
        self.by_parameters.clear();
        self.by_parameters.resize(dim * field.parameters_len(), f64::NAN);
        field.parameter_jacobian(t, y, &mut self.by_parameters)?;
        match self.by_parameters.iter().position(|entry| !entry.is_finite()) {
            None => Ok(&self.by_parameters),
            Some(k) => Err(Failure::recoverable(NonFinite::ParameterJacobian {
                row: field.component_name(k % dim),
                parameter: k / dim,
                value: self.by_parameters[k],
                t,
            })),
        }
    }

    /// ∂f/∂pⱼ at the state at which [`parameter_jacobian`](Linearisation::parameter_jacobian) was
    /// last evaluated.
    pub(crate) fn by_parameter(&self, j: usize) -> &[f64] {
        &self.by_parameters[j * self.dim..(j + 1) * self.dim]
    }
}

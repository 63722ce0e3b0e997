//! SO(2) in terms of its angle.

use nalgebra::DMatrix;
use pc_expr::Expr;

use crate::error::AlgebraError;
use crate::group::group::{LieGroup, Side, finite, principal};
use crate::lie_algebra::lie_algebra::LieAlgebra;
use crate::linear_algebra::matrix::Matrix;

/// The rotations of the plane, SO(2): one coordinate, the angle φ, with φ̇ = η on either side.
///
/// Angles that differ by 2π represent the same element; `log` and `compose` give the angle in (−π, π].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlaneRotations;

impl LieGroup for PlaneRotations {
    fn algebra(&self) -> LieAlgebra {
        LieAlgebra::commutative(1)
    }

    fn coordinates(&self) -> Vec<String> {
        vec!["phi".into()]
    }

    fn identity(&self) -> Vec<f64> {
        vec![0.0]
    }

    fn compose(&self, g: &[f64], h: &[f64]) -> Vec<f64> {
        vec![principal(g[0] + h[0])]
    }

    fn inverse(&self, g: &[f64]) -> Vec<f64> {
        vec![-g[0]]
    }

    fn exp(&self, x: &[f64]) -> Vec<f64> {
        vec![x[0]]
    }

    fn log(&self, g: &[f64]) -> Vec<f64> {
        vec![principal(g[0])]
    }

    fn adjoint(&self, _: &[f64]) -> DMatrix<f64> {
        DMatrix::identity(1, 1)
    }

    fn dexp(&self, _: Side, _: &[f64]) -> DMatrix<f64> {
        DMatrix::identity(1, 1)
    }

    fn dexp_inverse(&self, _: Side, _: &[f64]) -> DMatrix<f64> {
        DMatrix::identity(1, 1)
    }

    /// The chord 2|sin ½(φ_g − φ_h)| between the two points on the circle.
    fn distance(&self, g: &[f64], h: &[f64]) -> f64 {
        2.0 * ((g[0] - h[0]) / 2.0).sin().abs()
    }

    fn project(&self, g: &[f64]) -> Result<Vec<f64>, AlgebraError> {
        finite(g)
    }

    fn operators<'g>(&self, _: Side, _: &[Expr<'g>]) -> Matrix<Expr<'g>> {
        Matrix::from_fn(1, 1, |_, _| Expr::ONE)
    }
}

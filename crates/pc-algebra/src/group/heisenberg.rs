//! The Heisenberg groups.

use nalgebra::DMatrix;
use pc_expr::Expr;

use crate::error::AlgebraError;
use crate::group::exponential;
use crate::group::group::{LieGroup, Side, finite, largest_difference};
use crate::lie_algebra::lie_algebra::LieAlgebra;
use crate::linear_algebra::matrix::Matrix;

/// The Heisenberg group of dimension 2n + 1: coordinates (x_1..x_n, y_1..y_n, z) with the product (x, y,
/// z)(x', y', z') = (x + x', y + y', z + z' + ½(x·y' − y·x')).
///
/// The coordinates are those of the exponential map: exp and log leave the numbers unchanged. ẋ = a, ẏ = b,
/// ż = c ± ½(x·b − y·a) with velocities (a, b, c); the plus sign is for body velocities (left), the minus
/// sign for spatial velocities (right).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct HeisenbergGroup {
    n: usize,
}

impl HeisenbergGroup {
    /// The group of dimension 2n + 1.
    pub fn new(n: usize) -> HeisenbergGroup {
        HeisenbergGroup { n }
    }

    /// x·y' − y·x'
    fn area(&self, g: &[f64], h: &[f64]) -> f64 {
        (0..self.n).map(|i| g[i] * h[self.n + i] - g[self.n + i] * h[i]).sum()
    }
}

impl LieGroup for HeisenbergGroup {
    fn algebra(&self) -> LieAlgebra {
        LieAlgebra::heisenberg(self.n)
    }

    fn coordinates(&self) -> Vec<String> {
        if self.n == 1 {
            return ["x", "y", "z"].map(Into::into).to_vec();
        }
        let numbered = |name: char| (1..=self.n).map(move |i| format!("{name}{i}"));
        numbered('x').chain(numbered('y')).chain(["z".into()]).collect()
    }

    fn identity(&self) -> Vec<f64> {
        vec![0.0; 2 * self.n + 1]
    }

    fn compose(&self, g: &[f64], h: &[f64]) -> Vec<f64> {
        let mut product: Vec<f64> = g.iter().zip(h).map(|(g, h)| g + h).collect();
        product[2 * self.n] += self.area(g, h) / 2.0;
        product
    }

    fn inverse(&self, g: &[f64]) -> Vec<f64> {
        g.iter().map(|x| -x).collect()
    }

    fn exp(&self, x: &[f64]) -> Vec<f64> {
        x.to_vec()
    }

    fn log(&self, g: &[f64]) -> Vec<f64> {
        g.to_vec()
    }

    /// (a, b, c) ↦ (a, b, c + x·b − y·a)
    fn adjoint(&self, g: &[f64]) -> DMatrix<f64> {
        DMatrix::identity(g.len(), g.len()) + self.ad(g)
    }

    /// The matrix 1 ± ½ ad x, with the minus sign for the left side.
    fn dexp(&self, side: Side, x: &[f64]) -> DMatrix<f64> {
        exponential::dexp(side, &self.ad(x), 0.0)
    }

    fn dexp_inverse(&self, side: Side, x: &[f64]) -> DMatrix<f64> {
        exponential::dexp_inverse(side, &self.ad(x), 0.0)
    }

    fn distance(&self, g: &[f64], h: &[f64]) -> f64 {
        largest_difference(g, h)
    }

    fn project(&self, g: &[f64]) -> Result<Vec<f64>, AlgebraError> {
        finite(g)
    }

    fn operators<'g>(&self, side: Side, x: &[Expr<'g>]) -> Matrix<Expr<'g>> {
        let (n, dim) = (self.n, 2 * self.n + 1);
        let half = if side == Side::Left { 0.5 } else { -0.5 };
        Matrix::from_fn(dim, dim, |i, s| match (i == s, i == 2 * n) {
            (true, _) => Expr::ONE,
            (false, false) => Expr::ZERO,
            (false, true) if s < n => -half * x[n + s],
            (false, true) => half * x[s - n],
        })
    }
}

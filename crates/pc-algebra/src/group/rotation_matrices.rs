//! SO(3) in terms of rotation matrices.

use nalgebra::{DMatrix, Matrix3};
use pc_expr::Expr;

use crate::error::AlgebraError;
use crate::group::exponential;
use crate::group::group::{LieGroup, Side, finite, largest_difference};
use crate::group::rotation::{dynamic, hat, matrix_exp, matrix_log, vector};
use crate::lie_algebra::lie_algebra::LieAlgebra;
use crate::linear_algebra::matrix::Matrix;

/// The rotations of space, SO(3), described by the nine entries of R, row by row: R takes components along
/// body axes to components along axes in space. Ṙ = R ω̂ with body velocities ω (left), Ṙ = ω̂ R with spatial
/// velocities (right), where ω̂ x = ω × x.
///
/// `log` returns |x| ≤ π. At |x| = π, where x and −x give the same R, it returns the one whose first nonzero
/// component is positive. The vector is computed from the quaternion, and so is accurate at π too.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RotationMatrices;

impl RotationMatrices {
    /// The 3 × 3 matrix R from body axes to axes in space, with its entries `x` given row by row.
    ///
    /// # Panics
    /// If there are fewer than nine entries.
    pub fn rotation_matrix<'g>(&self, x: &[Expr<'g>]) -> Matrix<Expr<'g>> {
        Matrix::from_fn(3, 3, |i, j| x[3 * i + j])
    }
}

fn matrix(g: &[f64]) -> Matrix3<f64> {
    Matrix3::from_row_slice(&g[..9])
}

fn entries(r: &Matrix3<f64>) -> Vec<f64> {
    r.transpose().as_slice().to_vec()
}

impl LieGroup for RotationMatrices {
    fn algebra(&self) -> LieAlgebra {
        LieAlgebra::so3()
    }

    fn coordinates(&self) -> Vec<String> {
        (1..=3).flat_map(|i| (1..=3).map(move |j| format!("R{i}{j}"))).collect()
    }

    fn identity(&self) -> Vec<f64> {
        entries(&Matrix3::identity())
    }

    fn compose(&self, g: &[f64], h: &[f64]) -> Vec<f64> {
        entries(&(matrix(g) * matrix(h)))
    }

    /// Rᵀ
    fn inverse(&self, g: &[f64]) -> Vec<f64> {
        entries(&matrix(g).transpose())
    }

    /// 1 + (sin θ/θ) x̂ + ((1 − cos θ)/θ²) x̂², θ = |x|
    fn exp(&self, x: &[f64]) -> Vec<f64> {
        entries(&matrix_exp(&vector(x)))
    }

    fn log(&self, g: &[f64]) -> Vec<f64> {
        matrix_log(&matrix(g)).as_slice().to_vec()
    }

    /// R itself.
    fn adjoint(&self, g: &[f64]) -> DMatrix<f64> {
        dynamic(&matrix(g))
    }

    /// The matrix 1 ± ((1 − cos θ)/θ²) x̂ + ((θ − sin θ)/θ³) x̂², with the minus sign for the left side.
    fn dexp(&self, side: Side, x: &[f64]) -> DMatrix<f64> {
        exponential::dexp(side, &dynamic(&hat(&vector(x))), vector(x).norm())
    }

    fn dexp_inverse(&self, side: Side, x: &[f64]) -> DMatrix<f64> {
        exponential::dexp_inverse(side, &dynamic(&hat(&vector(x))), vector(x).norm())
    }

    fn distance(&self, g: &[f64], h: &[f64]) -> f64 {
        largest_difference(g, h)
    }

    /// The matrix U diag(1, 1, ±1) Vᵀ with determinant 1, for R = U Σ Vᵀ: the nearest rotation in the sum of
    /// squares of entries (it is not unique where the two smallest singular values are equal and the
    /// determinant of R is not positive).
    fn project(&self, g: &[f64]) -> Result<Vec<f64>, AlgebraError> {
        let r = matrix(&finite(g)?);
        let no_nearest = || AlgebraError::NoNearestElement { element: g.to_vec() };
        let svd = r.try_svd(true, true, f64::EPSILON, 200).ok_or_else(no_nearest)?;
        if svd.rank(1e-14 * svd.singular_values.max()) < 2 {
            return Err(no_nearest());
        }
        let (u, v) = svd.u.zip(svd.v_t).ok_or_else(no_nearest)?;
        let sign = (u.determinant() * v.determinant()).signum();
        let least = svd.singular_values.imin();
        let signs = Matrix3::from_fn(|i, j| match i == j {
            true if i == least => sign,
            true => 1.0,
            false => 0.0,
        });
        Ok(entries(&(u * signs * v)))
    }

    fn operators<'g>(&self, side: Side, x: &[Expr<'g>]) -> Matrix<Expr<'g>> {
        // (ê_s)_ij = 1 where s, j, i are cyclic: ê_s e_j = e_i.
        Matrix::from_fn(9, 3, |row, s| {
            let (i, j, next) = (row / 3, row % 3, |a: usize, b: usize| (a + b) % 3);
            match side {
                // (R ê_s)_ij = R_il with ê_s e_j = ± e_l
                Side::Left if j == next(s, 1) => x[3 * i + next(s, 2)],
                Side::Left if j == next(s, 2) => -x[3 * i + next(s, 1)],
                // (ê_s R)_ij = ± R_lj with ê_s e_l = ± e_i
                Side::Right if i == next(s, 2) => x[3 * next(s, 1) + j],
                Side::Right if i == next(s, 1) => -x[3 * next(s, 2) + j],
                _ => Expr::ZERO,
            }
        })
    }
}

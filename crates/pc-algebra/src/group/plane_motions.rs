//! SE(2).

use nalgebra::{DMatrix, Vector2};
use pc_expr::Expr;

use crate::error::AlgebraError;
use crate::group::exponential;
use crate::group::group::{LieGroup, Side, finite, principal};
use crate::group::stumpff::stumpff;
use crate::lie_algebra::lie_algebra::LieAlgebra;
use crate::linear_algebra::matrix::Matrix;

/// The motions of the plane, SE(2). The coordinates (φ, x, y) stand for the motion that turns by φ and then
/// shifts by (x, y).
///
/// φ̇ = ω; (ẋ, ẏ) = R(φ) v with body velocities (ω, v) (left), (ẋ, ẏ) = v + ω(−y, x) with spatial velocities
/// (right). Angles that differ by 2π represent the same element; `log` returns |ω| ≤ π, and ω = π for a half
/// turn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PlaneMotions;

fn place(g: &[f64]) -> Vector2<f64> {
    Vector2::new(g[1], g[2])
}

/// R(φ) v
fn turned(angle: f64, v: &Vector2<f64>) -> Vector2<f64> {
    let (s, c) = angle.sin_cos();
    Vector2::new(c * v.x - s * v.y, s * v.x + c * v.y)
}

/// The vector a v + b J v, where J is the quarter turn.
fn combined(a: f64, b: f64, v: &Vector2<f64>) -> Vector2<f64> {
    Vector2::new(a * v.x - b * v.y, b * v.x + a * v.y)
}

fn element(angle: f64, place: &Vector2<f64>) -> Vec<f64> {
    vec![angle, place.x, place.y]
}

impl LieGroup for PlaneMotions {
    fn algebra(&self) -> LieAlgebra {
        LieAlgebra::se2()
    }

    fn coordinates(&self) -> Vec<String> {
        ["phi", "x", "y"].map(Into::into).to_vec()
    }

    fn identity(&self) -> Vec<f64> {
        vec![0.0; 3]
    }

    /// (φ + φ', r + R(φ) r')
    fn compose(&self, g: &[f64], h: &[f64]) -> Vec<f64> {
        element(principal(g[0] + h[0]), &(place(g) + turned(g[0], &place(h))))
    }

    fn inverse(&self, g: &[f64]) -> Vec<f64> {
        element(-g[0], &-turned(-g[0], &place(g)))
    }

    /// (ω, (sin ω/ω) v + ((1 − cos ω)/ω) J v), J the quarter turn
    fn exp(&self, x: &[f64]) -> Vec<f64> {
        let [_, c1, c2, ..] = stumpff(x[0]);
        element(x[0], &combined(c1, x[0] * c2, &place(x)))
    }

    /// v = ½ω (cot ½ω − J) r
    fn log(&self, g: &[f64]) -> Vec<f64> {
        let half = principal(g[0]) / 2.0;
        element(2.0 * half, &combined(half.cos() / stumpff(half)[1], -half, &place(g)))
    }

    /// (ω, v) ↦ (ω, R(φ) v − ω J r)
    fn adjoint(&self, g: &[f64]) -> DMatrix<f64> {
        let (s, c) = g[0].sin_cos();
        DMatrix::from_row_slice(3, 3, &[1.0, 0.0, 0.0, g[2], c, -s, -g[1], s, c])
    }

    fn dexp(&self, side: Side, x: &[f64]) -> DMatrix<f64> {
        exponential::dexp(side, &self.ad(x), x[0])
    }

    fn dexp_inverse(&self, side: Side, x: &[f64]) -> DMatrix<f64> {
        exponential::dexp_inverse(side, &self.ad(x), x[0])
    }

    /// The largest of three numbers: the chord between the angles, and the differences in x and in y.
    fn distance(&self, g: &[f64], h: &[f64]) -> f64 {
        let chord = 2.0 * ((g[0] - h[0]) / 2.0).sin().abs();
        chord.max((place(g) - place(h)).amax())
    }

    fn project(&self, g: &[f64]) -> Result<Vec<f64>, AlgebraError> {
        finite(g)
    }

    fn operators<'g>(&self, side: Side, x: &[Expr<'g>]) -> Matrix<Expr<'g>> {
        let (zero, one, sin, cos) = (Expr::ZERO, Expr::ONE, x[0].sin(), x[0].cos());
        let rows = match side {
            Side::Left => [[one, zero, zero], [zero, cos, -sin], [zero, sin, cos]],
            Side::Right => [[one, zero, zero], [-x[2], one, zero], [x[1], zero, one]],
        };
        Matrix::from_fn(3, 3, |i, s| rows[i][s])
    }
}

//! The unit quaternions, which cover SO(3) twice.

use nalgebra::{DMatrix, Vector3};
use pc_expr::Expr;

use crate::error::AlgebraError;
use crate::group::exponential;
use crate::group::group::{LieGroup, Side, finite, largest_difference};
use crate::group::rotation::{
    components, dynamic, hat, matrix_of, quaternion, quaternion_exp, quaternion_log, rotation_of, vector,
};
use crate::lie_algebra::lie_algebra::LieAlgebra;
use crate::linear_algebra::matrix::Matrix;

/// The unit quaternions q = (q_0, q_1, q_2, q_3), scalar first, with Hamilton's product ij = k. q and −q are
/// two elements that represent the same rotation x ↦ q x q* from body axes to axes in space.
///
/// The basis of the algebra is ½i, ½j, ½k, so that q̇ = ½ q ω with body angular velocity ω (left) and q̇ = ½
/// ω q with the spatial angular velocity (right). `log` is the rotation vector with |x| ≤ 2π, (2π, 0, 0) for
/// q = −1; if q_0 < 0, the shorter rotation is that of −q. Off the unit sphere the frames are homogeneous in
/// q and |q| is constant along their motions.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct UnitQuaternions;

impl UnitQuaternions {
    /// The 3 × 3 matrix of x ↦ q x q* from body axes to axes in space: |q|² times a rotation matrix.
    ///
    /// # Panics
    /// If `q` has fewer than four entries.
    ///
    /// ```
    /// # use pc_algebra::UnitQuaternions;
    /// # use pc_expr::Graph;
    /// let graph = Graph::new();
    /// let q = graph.symbols(["q0", "q1", "q2", "q3"]);
    /// let r = UnitQuaternions.rotation_matrix(&q);
    /// assert_eq!(r[(2, 0)], 2.0 * (q[1] * q[3] - q[0] * q[2]));
    /// ```
    pub fn rotation_matrix<'g>(&self, q: &[Expr<'g>]) -> Matrix<Expr<'g>> {
        let rows = rotation_of(q);
        Matrix::from_fn(3, 3, |i, j| rows[i][j])
    }
}

impl LieGroup for UnitQuaternions {
    fn algebra(&self) -> LieAlgebra {
        LieAlgebra::so3()
    }

    fn coordinates(&self) -> Vec<String> {
        (0..4).map(|i| format!("q{i}")).collect()
    }

    fn identity(&self) -> Vec<f64> {
        vec![1.0, 0.0, 0.0, 0.0]
    }

    fn compose(&self, g: &[f64], h: &[f64]) -> Vec<f64> {
        components(&(quaternion(g) * quaternion(h))).to_vec()
    }

    /// The conjugate (q_0, −q_1, −q_2, −q_3).
    fn inverse(&self, g: &[f64]) -> Vec<f64> {
        components(&quaternion(g).conjugate()).to_vec()
    }

    /// (cos ½θ, x sin ½θ/θ), θ = |x|
    fn exp(&self, x: &[f64]) -> Vec<f64> {
        components(&quaternion_exp(&vector(x))).to_vec()
    }

    fn log(&self, g: &[f64]) -> Vec<f64> {
        quaternion_log(&quaternion(g), &Vector3::x()).as_slice().to_vec()
    }

    /// The matrix of the rotation.
    fn adjoint(&self, g: &[f64]) -> DMatrix<f64> {
        dynamic(&matrix_of(&quaternion(g)))
    }

    fn dexp(&self, side: Side, x: &[f64]) -> DMatrix<f64> {
        exponential::dexp(side, &dynamic(&hat(&vector(x))), vector(x).norm())
    }

    fn dexp_inverse(&self, side: Side, x: &[f64]) -> DMatrix<f64> {
        exponential::dexp_inverse(side, &dynamic(&hat(&vector(x))), vector(x).norm())
    }

    fn distance(&self, g: &[f64], h: &[f64]) -> f64 {
        largest_difference(g, h)
    }

    /// q/|q|
    fn project(&self, g: &[f64]) -> Result<Vec<f64>, AlgebraError> {
        unit(g).map(|q| q.to_vec())
    }

    fn operators<'g>(&self, side: Side, x: &[Expr<'g>]) -> Matrix<Expr<'g>> {
        quaternion_operators(side, x)
    }
}

/// The unit quaternion q/|q|, where q consists of the first four numbers.
pub(crate) fn unit(g: &[f64]) -> Result<[f64; 4], AlgebraError> {
    let q = quaternion(&finite(g)?);
    let largest = q.w.abs().max(q.i.abs()).max(q.j.abs()).max(q.k.abs());
    if largest == 0.0 {
        return Err(AlgebraError::NoNearestElement { element: g.to_vec() });
    }
    // Scaled first: the squares of very large and very small components are out of range.
    let scaled = components(&q).map(|x| x / largest);
    let norm = scaled.iter().map(|x| x * x).sum::<f64>().sqrt();
    Ok(scaled.map(|x| x / norm))
}

/// The matrix with the columns ½ q e_s for the left side and ½ e_s q for the right, where e_s = i, j, k.
pub(crate) fn quaternion_operators<'g>(side: Side, q: &[Expr<'g>]) -> Matrix<Expr<'g>> {
    let sign = if side == Side::Left { 1.0 } else { -1.0 };
    Matrix::from_fn(4, 3, |i, s| {
        match (i, s + 1) {
            (0, s) => -0.5 * q[s],
            (i, s) if i == s => 0.5 * q[0],
            // e_l e_s = e_i where l, s, i are cyclic, −e_i where s, l, i are.
            (i, s) if s % 3 + 1 == i => 0.5 * sign * q[6 - i - s],
            (i, s) => -0.5 * sign * q[6 - i - s],
        }
    })
}

//! SE(3) in terms of a quaternion and a position.

use nalgebra::{DMatrix, Matrix3, Vector3};
use pc_expr::Expr;

use crate::error::AlgebraError;
use crate::group::exponential;
use crate::group::group::{LieGroup, Side, finite, largest_difference};
use crate::group::rotation::{
    components, hat, matrix_of, quaternion, quaternion_exp, quaternion_log, rotation_of, vector,
};
use crate::group::stumpff::stumpff;
use crate::group::unit_quaternions::{quaternion_operators, unit};
use crate::lie_algebra::lie_algebra::LieAlgebra;
use crate::linear_algebra::matrix::Matrix;

/// The motions of space, SE(3) (covered twice, as the unit quaternions cover SO(3) twice): the coordinates
/// (q_0..q_3, x, y, z) stand for the motion that turns by q and then shifts by r = (x, y, z).
///
/// Velocities are (ω, v): q̇ = ½ q ω, ṙ = R(q) v in body axes (left); q̇ = ½ ω q, ṙ = v + ω × r in axes in
/// space (right). `log` returns |ω| ≤ 2π. Its v has a pole at q = −1 unless r is along the axis of ω; at q =
/// −1 itself ω is taken along r (along x if r = 0).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RigidMotions;

/// The two halves of `x`: ω and v, or the vector part of a quaternion and the position.
fn halves(x: &[f64]) -> (Vector3<f64>, Vector3<f64>) {
    (vector(x), vector(&x[3..]))
}

fn element(q: [f64; 4], place: &Vector3<f64>) -> Vec<f64> {
    q.into_iter().chain(place.iter().copied()).collect()
}

fn rotation(g: &[f64]) -> Matrix3<f64> {
    matrix_of(&quaternion(g))
}

fn place(g: &[f64]) -> Vector3<f64> {
    vector(&g[4..])
}

impl LieGroup for RigidMotions {
    fn algebra(&self) -> LieAlgebra {
        LieAlgebra::se3()
    }

    fn coordinates(&self) -> Vec<String> {
        ["q0", "q1", "q2", "q3", "x", "y", "z"].map(Into::into).to_vec()
    }

    fn identity(&self) -> Vec<f64> {
        vec![1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]
    }

    /// (q q', r + R(q) r')
    fn compose(&self, g: &[f64], h: &[f64]) -> Vec<f64> {
        element(components(&(quaternion(g) * quaternion(h))), &(place(g) + rotation(g) * place(h)))
    }

    fn inverse(&self, g: &[f64]) -> Vec<f64> {
        let back = quaternion(g).conjugate();
        element(components(&back), &-(matrix_of(&back) * place(g)))
    }

    /// (exp ω, V v) with V = 1 + c_2 ω̂ + c_3 ω̂², c_2 = (1 − cos θ)/θ², c_3 = (θ − sin θ)/θ³, θ = |ω|
    fn exp(&self, x: &[f64]) -> Vec<f64> {
        let (omega, v) = halves(x);
        let [_, _, c2, c3, ..] = stumpff(omega.norm());
        let along = omega.cross(&v);
        element(components(&quaternion_exp(&omega)), &(v + along * c2 + omega.cross(&along) * c3))
    }

    /// v = (1 − ½ω̂ + κ ω̂²) r with κ = (1 − ½θ cot ½θ)/θ²
    fn log(&self, g: &[f64]) -> Vec<f64> {
        let r = place(g);
        let axis = r.try_normalize(0.0).unwrap_or_else(Vector3::x);
        let omega = quaternion_log(&quaternion(g), &axis);
        let [_, c1, c2, c3, ..] = stumpff(omega.norm() / 2.0);
        let across = omega.cross(&r);
        let v = r - across * 0.5 + omega.cross(&across) * ((c2 - c3) / (4.0 * c1));
        omega.iter().chain(v.iter()).copied().collect()
    }

    /// (ω, v) ↦ (Rω, Rv + r × Rω)
    fn adjoint(&self, g: &[f64]) -> DMatrix<f64> {
        let r = rotation(g);
        let mut matrix = DMatrix::zeros(6, 6);
        matrix.view_mut((0, 0), (3, 3)).copy_from(&r);
        matrix.view_mut((3, 0), (3, 3)).copy_from(&(hat(&place(g)) * r));
        matrix.view_mut((3, 3), (3, 3)).copy_from(&r);
        matrix
    }

    fn dexp(&self, side: Side, x: &[f64]) -> DMatrix<f64> {
        exponential::dexp(side, &self.ad(x), vector(x).norm())
    }

    fn dexp_inverse(&self, side: Side, x: &[f64]) -> DMatrix<f64> {
        exponential::dexp_inverse(side, &self.ad(x), vector(x).norm())
    }

    fn distance(&self, g: &[f64], h: &[f64]) -> f64 {
        largest_difference(g, h)
    }

    /// (q/|q|, r)
    fn project(&self, g: &[f64]) -> Result<Vec<f64>, AlgebraError> {
        Ok(element(unit(&finite(g)?)?, &place(g)))
    }

    fn operators<'g>(&self, side: Side, x: &[Expr<'g>]) -> Matrix<Expr<'g>> {
        let turning = quaternion_operators(side, x);
        let rotation = rotation_of(x);
        let (zero, one) = (Expr::ZERO, Expr::ONE);
        // e_s × r, column by column
        let [rx, ry, rz] = [x[4], x[5], x[6]];
        let cross = [[zero, rz, -ry], [-rz, zero, rx], [ry, -rx, zero]];
        Matrix::from_fn(7, 6, |i, s| match (i < 4, s < 3, side) {
            (true, true, _) => turning[(i, s)],
            (true, false, _) | (false, true, Side::Left) => zero,
            (false, false, Side::Left) => rotation[i - 4][s - 3],
            (false, true, Side::Right) => cross[i - 4][s],
            (false, false, Side::Right) => {
                if i - 4 == s - 3 {
                    one
                } else {
                    zero
                }
            }
        })
    }
}

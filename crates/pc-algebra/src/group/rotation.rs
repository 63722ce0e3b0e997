//! Rotations of space as matrices, unit quaternions and rotation vectors.

use nalgebra::{DMatrix, Matrix3, Quaternion, Vector3};
use pc_expr::Expr;

use crate::group::stumpff::stumpff;

/// The vector made of the first three numbers.
pub(crate) fn vector(x: &[f64]) -> Vector3<f64> {
    Vector3::new(x[0], x[1], x[2])
}

/// x̂ with x̂ y = x × y.
pub(crate) fn hat(x: &Vector3<f64>) -> Matrix3<f64> {
    x.cross_matrix()
}

/// The 3 × 3 matrix as a matrix of dynamic size.
pub(crate) fn dynamic(matrix: &Matrix3<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(3, 3, |i, j| matrix[(i, j)])
}

/// exp x̂ = 1 + c_1 x̂ + c_2 x̂² (Rodrigues).
pub(crate) fn matrix_exp(x: &Vector3<f64>) -> Matrix3<f64> {
    let [_, c1, c2, ..] = stumpff(x.norm());
    Matrix3::identity() + hat(x) * c1 + hat(x) * hat(x) * c2
}

/// The exponential of ½x as a quaternion: (cos ½θ, ½ c_1(½θ) x).
pub(crate) fn quaternion_exp(x: &Vector3<f64>) -> Quaternion<f64> {
    let half = x.norm() / 2.0;
    Quaternion::from_parts(half.cos(), x * (stumpff(half)[1] / 2.0))
}

/// The x with |x| ≤ 2π whose quaternion is q: v·2 atan2(|v|, q_0)/|v|. For q = −1 the vector x has the
/// direction of `otherwise`.
pub(crate) fn quaternion_log(q: &Quaternion<f64>, otherwise: &Vector3<f64>) -> Vector3<f64> {
    let v = q.vector().into_owned();
    let size = v.norm();
    if size == 0.0 {
        // Below 1e-154 the square of a component is lost, and the quotient is 2 to all digits.
        let turn = otherwise * (2.0 * std::f64::consts::PI);
        return if q.scalar() < 0.0 { turn } else { v * 2.0 };
    }
    v * (2.0 * size.atan2(q.scalar()) / size)
}

/// The rotation vector with |x| ≤ π of a rotation matrix, computed from its quaternion.
pub(crate) fn matrix_log(r: &Matrix3<f64>) -> Vector3<f64> {
    quaternion_log(&quaternion_of(r), &Vector3::x())
}

/// The quaternion with q_0 ≥ 0 of a rotation matrix; if q_0 = 0, the one whose first nonzero component is
/// positive.
///
/// 4 q qᵀ is linear in R; the row with the largest diagonal entry is normalised, so that nothing cancels
/// (S. W. Shepperd, *Quaternion from rotation matrix*, 1978).
pub(crate) fn quaternion_of(r: &Matrix3<f64>) -> Quaternion<f64> {
    let trace = r.trace();
    let squares =
        [trace, 2.0 * r[(0, 0)] - trace, 2.0 * r[(1, 1)] - trace, 2.0 * r[(2, 2)] - trace].map(|x| 1.0 + x);
    let largest = (1..4).fold(0, |best, i| if squares[i] > squares[best] { i } else { best });
    let product = |a: usize, b: usize| match (a.min(b), a.max(b)) {
        (a, b) if a == b => squares[a],
        (0, b) => r[((b + 1) % 3, b % 3)] - r[(b % 3, (b + 1) % 3)],
        (a, b) => r[(a - 1, b - 1)] + r[(b - 1, a - 1)],
    };
    let row = [0, 1, 2, 3].map(|b| product(largest, b));
    let norm = row.iter().map(|x| x * x).sum::<f64>().sqrt();
    let first = row.iter().find(|x| **x != 0.0).copied().unwrap_or(1.0);
    let scale = if first < 0.0 { -1.0 / norm } else { 1.0 / norm };
    Quaternion::new(row[0], row[1], row[2], row[3]) * scale
}

/// The rotation matrix of a unit quaternion, x ↦ q x q*.
pub(crate) fn matrix_of(q: &Quaternion<f64>) -> Matrix3<f64> {
    let (s, v) = (q.scalar(), q.vector().into_owned());
    Matrix3::identity() * (s * s - v.norm_squared()) + v * v.transpose() * 2.0 + hat(&v) * (2.0 * s)
}

/// The quaternion made of the first four numbers, scalar first.
pub(crate) fn quaternion(g: &[f64]) -> Quaternion<f64> {
    Quaternion::new(g[0], g[1], g[2], g[3])
}

/// The components of a quaternion, scalar first.
pub(crate) fn components(q: &Quaternion<f64>) -> [f64; 4] {
    [q.w, q.i, q.j, q.k]
}

/// The matrix of x ↦ q x q* as expressions, homogeneous of degree 2 in q. (With squares replaced by 1 − …,
/// its derivatives would be right only on unit quaternions.)
pub(crate) fn rotation_of<'g>(q: &[Expr<'g>]) -> [[Expr<'g>; 3]; 3] {
    let square = |i: usize| q[i] * q[i];
    let norm = [0, 1, 2].map(|i| {
        let others = square((i + 1) % 3 + 1) + square((i + 2) % 3 + 1);
        square(0) + square(i + 1) - others
    });
    let mut matrix = [[Expr::ZERO; 3]; 3];
    for i in 0..3 {
        let (j, l) = ((i + 1) % 3, (i + 2) % 3);
        matrix[i][i] = norm[i];
        matrix[i][j] = 2.0 * (q[i + 1] * q[j + 1] - q[0] * q[l + 1]);
        matrix[j][i] = 2.0 * (q[i + 1] * q[j + 1] + q[0] * q[l + 1]);
    }
    matrix
}

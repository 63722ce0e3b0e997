//! SO(3) in terms of Euler angles, in any of the twelve sequences.

use nalgebra::{DMatrix, Matrix3, Vector3};
use pc_expr::Expr;

use crate::error::AlgebraError;
use crate::group::exponential;
use crate::group::group::{LieGroup, Side, finite};
use crate::group::rotation::{dynamic, hat, matrix_exp, matrix_log, vector};
use crate::lie_algebra::lie_algebra::LieAlgebra;
use crate::linear_algebra::matrix::Matrix;

/// The rotations of space, described by three angles (α, β, γ), R = R_i(α) R_j(β) R_k(γ) from body axes to
/// axes in space: the body is turned about its own axis i, then about its own axis j, then about its own axis
/// k.
///
/// Proper Euler angles have k = i (`zxz`: ψ, θ, φ of the heavy top) and frames singular where sin β = 0,
/// Tait–Bryan angles have three different axes (`zyx`: yaw, pitch, roll) and frames singular where cos β = 0.
/// `exp`, `compose` and `inverse` give β in \[0, π\] or \[−½π, ½π\] and the other angles in \[−π, π\], with
/// an arbitrary α at the singularity; the branch of `log` is that of
/// [`RotationMatrices`](crate::RotationMatrices).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EulerAngles {
    axes: [usize; 3],
}

impl EulerAngles {
    /// The twelve sequences, proper ones first.
    pub const SEQUENCES: [&str; 12] =
        ["zxz", "xyx", "yzy", "zyz", "xzx", "yxy", "xyz", "yzx", "zxy", "xzy", "zyx", "yxz"];

    /// The angles about these axes, such as `zxz`.
    ///
    /// # Errors
    /// [`AlgebraError::EulerSequence`] unless there are three letters among x, y, z, and neighbouring letters
    /// differ.
    ///
    /// ```
    /// # use pc_algebra::{EulerAngles, LieGroup, Side};
    /// # use pc_expr::Graph;
    /// let graph = Graph::new();
    /// let [psi, theta, phi] = graph.symbols(["psi", "theta", "phi"]);
    /// let b = EulerAngles::about("zxz")?.operators(Side::Left, &[psi, theta, phi]);
    /// assert_eq!(b[(0, 0)], phi.sin() / theta.sin()); // ψ̇ = (ω_1 sin φ + ω_2 cos φ)/sin θ
    /// # Ok::<(), pc_algebra::AlgebraError>(())
    /// ```
    pub fn about(axes: &str) -> Result<EulerAngles, AlgebraError> {
        let refusal = || AlgebraError::EulerSequence { axes: axes.to_owned() };
        let letters: Option<Vec<usize>> = axes.chars().map(|letter| "xyz".find(letter)).collect();
        let axes: [usize; 3] = letters.ok_or_else(refusal)?.try_into().map_err(|_| refusal())?;
        if axes[0] == axes[1] || axes[1] == axes[2] { Err(refusal()) } else { Ok(EulerAngles { axes }) }
    }

    /// The 3 × 3 matrix R_i(α) R_j(β) R_k(γ) from body axes to axes in space, for the angles `x`.
    ///
    /// # Panics
    /// If there are fewer than three angles.
    pub fn rotation_matrix<'g>(&self, x: &[Expr<'g>]) -> Matrix<Expr<'g>> {
        let [first, second, third] = [0, 1, 2].map(|i| turn(self.axes[i], x[i]));
        let product = |a: &Matrix<Expr<'g>>, b: &Matrix<Expr<'g>>| {
            Matrix::from_fn(3, 3, |i, j| (0..3).map(|l| a[(i, l)] * b[(l, j)]).sum())
        };
        product(&product(&first, &second), &third)
    }

    /// Whether the first and the last axis are the same.
    fn is_proper(&self) -> bool {
        self.axes[0] == self.axes[2]
    }

    /// The axis l that is neither i nor j, and the sign of the permutation (i, j, l).
    fn third(&self) -> (usize, i32) {
        let [i, j, _] = self.axes;
        (3 - i - j, if (i + 1) % 3 == j { 1 } else { -1 })
    }

    /// R_i(α) R_j(β) R_k(γ)
    fn rotation(&self, g: &[f64]) -> Matrix3<f64> {
        about_axis(self.axes[0], g[0]) * about_axis(self.axes[1], g[1]) * about_axis(self.axes[2], g[2])
    }

    /// Computes α and β from R, then γ from row j of R_i(−α) R = R_j(β) R_k(γ), which is independent of β: so
    /// the product of the three rotations is correct for any α if R does not determine α.
    fn angles(&self, r: &Matrix3<f64>) -> Vec<f64> {
        let ([i, j, _], (l, sign)) = (self.axes, self.third());
        let sign = f64::from(sign);
        let (alpha, beta) = if self.is_proper() {
            let (s, c) = (r[(j, i)], -sign * r[(l, i)]);
            (angle(s, c), s.hypot(c).atan2(r[(i, i)]))
        } else {
            let (s, c) = (-sign * r[(j, l)], r[(l, l)]);
            (angle(s, c), (sign * r[(i, l)]).atan2(s.hypot(c)))
        };
        let row = about_axis(i, -alpha).row(j) * r;
        let gamma =
            if self.is_proper() { angle(-sign * row[l], row[j]) } else { angle(sign * row[i], row[j]) };
        vec![alpha, beta, gamma]
    }

    /// The matrix b of (α̇, β̇, γ̇) = b ω, with ω along body axes.
    fn body_rates<'g>(&self, beta: Expr<'g>, gamma: Expr<'g>) -> [[Expr<'g>; 3]; 3] {
        let ([i, j, k], (l, sign)) = (self.axes, self.third());
        let sign = f64::from(sign);
        let mut b = [[Expr::ZERO; 3]; 3];
        let (across, ratio) = if self.is_proper() {
            b[0][j] = gamma.sin() / beta.sin();
            b[0][l] = sign * gamma.cos() / beta.sin();
            b[1][l] = -sign * gamma.sin();
            ([j, l], beta.cos())
        } else {
            b[0][i] = gamma.cos() / beta.cos();
            b[0][j] = -sign * gamma.sin() / beta.cos();
            b[1][i] = sign * gamma.sin();
            ([i, j], sign * beta.sin())
        };
        b[1][j] = gamma.cos();
        b[2][k] = Expr::ONE;
        for axis in across {
            b[2][axis] = -ratio * b[0][axis]; // γ̇ = ω_k − (e_i·e_k) α̇
        }
        b
    }
}

/// The polar angle of (c, s); 0 if both are 0.
fn angle(s: f64, c: f64) -> f64 {
    if s == 0.0 && c == 0.0 { 0.0 } else { s.atan2(c) }
}

fn about_axis(axis: usize, angle: f64) -> Matrix3<f64> {
    matrix_exp(&(Vector3::ith(axis, 1.0) * angle))
}

/// The matrix of the rotation by `angle` about `axis`.
fn turn<'g>(axis: usize, angle: Expr<'g>) -> Matrix<Expr<'g>> {
    let next = (axis + 1) % 3;
    Matrix::from_fn(3, 3, |i, j| match (i == axis, j == axis) {
        (true, true) => Expr::ONE,
        (false, false) if i == j => angle.cos(),
        (false, false) if i == next => -angle.sin(),
        (false, false) => angle.sin(),
        _ => Expr::ZERO,
    })
}

impl LieGroup for EulerAngles {
    fn algebra(&self) -> LieAlgebra {
        LieAlgebra::so3()
    }

    /// The names ψ, θ, φ for proper angles; otherwise yaw, pitch and roll for angles about z, y and x.
    fn coordinates(&self) -> Vec<String> {
        if self.is_proper() {
            return ["psi", "theta", "phi"].map(Into::into).to_vec();
        }
        self.axes.map(|axis| ["roll", "pitch", "yaw"][axis].into()).to_vec()
    }

    fn identity(&self) -> Vec<f64> {
        vec![0.0; 3]
    }

    fn compose(&self, g: &[f64], h: &[f64]) -> Vec<f64> {
        self.angles(&(self.rotation(g) * self.rotation(h)))
    }

    fn inverse(&self, g: &[f64]) -> Vec<f64> {
        self.angles(&self.rotation(g).transpose())
    }

    fn exp(&self, x: &[f64]) -> Vec<f64> {
        self.angles(&matrix_exp(&vector(x)))
    }

    fn log(&self, g: &[f64]) -> Vec<f64> {
        matrix_log(&self.rotation(g)).as_slice().to_vec()
    }

    /// The rotation matrix.
    fn adjoint(&self, g: &[f64]) -> DMatrix<f64> {
        dynamic(&self.rotation(g))
    }

    fn dexp(&self, side: Side, x: &[f64]) -> DMatrix<f64> {
        exponential::dexp(side, &dynamic(&hat(&vector(x))), vector(x).norm())
    }

    fn dexp_inverse(&self, side: Side, x: &[f64]) -> DMatrix<f64> {
        exponential::dexp_inverse(side, &dynamic(&hat(&vector(x))), vector(x).norm())
    }

    /// The largest difference between the entries of the rotation matrices.
    fn distance(&self, g: &[f64], h: &[f64]) -> f64 {
        (self.rotation(g) - self.rotation(h)).amax()
    }

    fn project(&self, g: &[f64]) -> Result<Vec<f64>, AlgebraError> {
        finite(g)
    }

    /// For spatial velocities (right) the matrix is found from the inverse rotation R_k(−γ) R_j(−β) R_i(−α),
    /// whose body velocity is −ω for the spatial velocity ω of R.
    fn operators<'g>(&self, side: Side, x: &[Expr<'g>]) -> Matrix<Expr<'g>> {
        let [i, j, k] = self.axes;
        let b = match side {
            Side::Left => self.body_rates(x[1], x[2]),
            Side::Right => {
                let [gamma, beta, alpha] = EulerAngles { axes: [k, j, i] }.body_rates(-x[1], -x[0]);
                [alpha, beta, gamma]
            }
        };
        Matrix::from_fn(3, 3, |row, s| b[row][s])
    }
}

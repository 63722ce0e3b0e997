//! Numerical solution of linear equations of any shape and rank.

use pc_algebra::Matrix;

use crate::error::MechError;
use crate::numeric::singular_values::SingularValues;

/// The equations A x = b for an m × n matrix A = U Σ Vᵀ, solved by means of the singular values of A.
///
/// ```
/// use pc_mech::{LeastSquares, Matrix};
///
/// // x + y = 2, twice: of the solutions (1, 1) is the shortest.
/// let twice = LeastSquares::of(&Matrix::from_fn(2, 2, |_, _| 1.0))?;
/// assert_eq!(twice.rank(1e-12), 1);
/// let x = twice.shortest(&[2.0, 2.0], 1e-12);
/// assert!((x[0] - 1.0).abs() < 1e-15 && (x[1] - 1.0).abs() < 1e-15);
/// # Ok::<(), pc_mech::MechError>(())
/// ```
#[derive(Clone, Debug)]
pub struct LeastSquares(SingularValues);

impl LeastSquares {
    /// The equations with this `matrix`.
    ///
    /// # Errors
    /// [`MatrixError::NoEigenvalues`](crate::MatrixError::NoEigenvalues) for a matrix with an entry that is not finite.
    pub fn of(matrix: &Matrix<f64>) -> Result<LeastSquares, MechError> {
        SingularValues::of(matrix).map(LeastSquares)
    }

    /// The rank of A: the number of singular values above `tolerance` times the largest.
    pub fn rank(&self, tolerance: f64) -> usize {
        self.0.rank(tolerance * self.0.values.first().copied().unwrap_or(0.0))
    }

    /// The smallest of the singular values divided by the largest; 0 if A is zero and 1 if A is empty.
    pub fn reciprocal_condition(&self) -> f64 {
        match (self.0.values.first(), self.0.values.last()) {
            (Some(&largest), Some(&smallest)) if largest > 0.0 => smallest / largest,
            (Some(_), _) => 0.0,
            (None, _) => 1.0,
        }
    }

    /// The shortest of the vectors x with the smallest |A x − b|, where singular values up to `tolerance`
    /// times the largest count as zero; b has length m.
    pub fn shortest(&self, b: &[f64], tolerance: f64) -> Vec<f64> {
        let rank = self.rank(tolerance);
        self.combined(b, |i, value| if i < rank { value.recip() } else { 0.0 })
    }

    /// The x with the smallest |A x − b|² + μ |x|² (Levenberg); b has length m.
    pub fn damped(&self, b: &[f64], mu: f64) -> Vec<f64> {
        self.combined(b, |_, value| if value > 0.0 { value / (value * value + mu) } else { 0.0 })
    }

    /// The vector V Σ' Uᵀ b, where Σ' is diagonal with the `inverse` of each entry of Σ.
    fn combined(&self, b: &[f64], inverse: impl Fn(usize, f64) -> f64) -> Vec<f64> {
        let SingularValues { left, values, right } = &self.0;
        let along = |i: usize| left.column(i).zip(b).map(|(u, b)| u * b).sum::<f64>();
        let parts: Vec<f64> =
            values.iter().enumerate().map(|(i, &value)| inverse(i, value) * along(i)).collect();
        (0..right.rows())
            .map(|j| parts.iter().enumerate().map(|(i, part)| part * right[(j, i)]).sum())
            .collect()
    }
}

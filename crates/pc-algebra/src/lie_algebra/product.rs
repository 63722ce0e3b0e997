//! Direct products and changes of basis.

use num_rational::BigRational;
use num_traits::Zero;
use pc_expr::Number;

use crate::error::AlgebraError;
use crate::frame::frame::shape;
use crate::lie_algebra::lie_algebra::LieAlgebra;
use crate::lie_algebra::structure_constants::exact_matrix;
use crate::linear_algebra::echelon::inverse;
use crate::linear_algebra::matrix::Matrix;

impl LieAlgebra {
    /// The direct product g × h. Its basis is that of g, then that of h, and every \[x, y\] with x in g and y
    /// in h is 0.
    ///
    /// ```
    /// # use pc_algebra::LieAlgebra;
    /// let square = LieAlgebra::so3().direct_product(&LieAlgebra::so3());
    /// assert_eq!((square.dim(), square.rank()?, square.is_semisimple()?), (6, 2, true));
    /// # Ok::<(), pc_algebra::AlgebraError>(())
    /// ```
    #[must_use]
    pub fn direct_product(&self, other: &LieAlgebra) -> LieAlgebra {
        let k = self.dim();
        LieAlgebra::from_constants(k + other.dim(), |r, s, m| match (r < k, s < k, m < k) {
            (true, true, true) => self.constant(r, s, m),
            (false, false, false) => other.constant(r - k, s - k, m - k),
            _ => Number::ZERO,
        })
    }

    /// The algebra in the basis Y_s = p_rs X_r, where `p` is k × k: c'_rs^m = (p⁻¹)_mu p_ir p_js c_ij^u.
    ///
    /// # Errors
    /// [`AlgebraError::SingularBasis`]; [`AlgebraError::Shape`]; [`AlgebraError::NotRational`],
    /// [`AlgebraError::IrrationalEntry`], [`AlgebraError::TooLarge`].
    pub fn change_of_basis(&self, p: &Matrix<Number>) -> Result<LieAlgebra, AlgebraError> {
        let k = self.dim();
        shape("a column of the change of basis", p.rows(), k)?;
        shape("a row of the change of basis", p.columns(), k)?;
        let c = self.exact()?;
        let columns = exact_matrix("the change of basis", &p.transpose())?;
        let back = inverse(&exact_matrix("the change of basis", p)?).ok_or(AlgebraError::SingularBasis)?;
        let mut constants = Vec::with_capacity(k * k);
        for r in 0..k {
            for s in 0..k {
                let bracket = c.bracket(&columns[r], &columns[s]);
                constants.push(product(&back, &bracket));
            }
        }
        LieAlgebra::from_exact(k, |r, s, m| constants[r * k + s][m].clone())
    }
}

fn product(matrix: &[Vec<BigRational>], vector: &[BigRational]) -> Vec<BigRational> {
    let dot = |row: &Vec<BigRational>| {
        row.iter().zip(vector).filter(|(_, x)| !x.is_zero()).map(|(a, x)| a * x).sum()
    };
    matrix.iter().map(dot).collect()
}

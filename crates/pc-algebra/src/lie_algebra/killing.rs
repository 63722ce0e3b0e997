//! The Killing form and Cartan's criterion.

use num_rational::BigRational;
use num_traits::Zero;
use pc_expr::Number;

use crate::error::AlgebraError;
use crate::lie_algebra::lie_algebra::LieAlgebra;
use crate::lie_algebra::structure_constants::rounded;
use crate::linear_algebra::echelon::Echelon;
use crate::linear_algebra::matrix::Matrix;

impl LieAlgebra {
    /// The Killing form K_rs = tr(ad X_r ad X_s) = c_rp^q c_sq^p, k × k and symmetric.
    ///
    /// # Errors
    /// [`AlgebraError::NotRational`].
    ///
    /// ```
    /// # use pc_algebra::{LieAlgebra, Matrix};
    /// let minus_two = |r: usize, s: usize| if r == s { (-2).into() } else { 0.into() };
    /// assert_eq!(LieAlgebra::so3().killing_form()?, Matrix::from_fn(3, 3, minus_two));
    /// # Ok::<(), pc_algebra::AlgebraError>(())
    /// ```
    pub fn killing_form(&self) -> Result<Matrix<Number>, AlgebraError> {
        let k = self.dim();
        let form = self.exact_killing_form()?;
        Ok(Matrix::from_fn(k, k, |r, s| rounded(&form[r][s])))
    }

    /// Whether the Killing form is regular, which by Cartan's criterion means that the algebra is a
    /// direct product of simple algebras (of none in dimension 0).
    ///
    /// # Errors
    /// [`AlgebraError::NotRational`].
    pub fn is_semisimple(&self) -> Result<bool, AlgebraError> {
        Ok(Echelon::of(self.dim(), self.exact_killing_form()?).rank() == self.dim())
    }

    fn exact_killing_form(&self) -> Result<Vec<Vec<BigRational>>, AlgebraError> {
        let k = self.dim();
        let c = self.exact()?;
        let mut form = vec![vec![BigRational::zero(); k]; k];
        for (r, p, q, value) in c.nonzero() {
            for (s, entry) in form[r].iter_mut().enumerate() {
                *entry += value * &c.pair(s, q)[p];
            }
        }
        Ok(form)
    }
}

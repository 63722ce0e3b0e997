//! Forms that are invariant under the adjoint action.

use num_rational::BigRational;
use num_traits::Zero;
use pc_expr::Number;

use crate::error::AlgebraError;
use crate::lie_algebra::lie_algebra::LieAlgebra;
use crate::lie_algebra::structure_constants::{primitive, rounded};
use crate::linear_algebra::echelon::Echelon;
use crate::linear_algebra::matrix::Matrix;

impl LieAlgebra {
    /// A basis of the linear forms ξ with ξ([x, y]) = 0: the solutions of c_rs^m ξ_m = 0, the annihilator of
    /// \[g, g\].
    ///
    /// These forms are the characters of the algebra, not Casimir functions of the momenta. Entries are
    /// coprime integers.
    ///
    /// # Errors
    /// [`AlgebraError::NotRational`].
    pub fn invariant_linear_forms(&self) -> Result<Vec<Vec<Number>>, AlgebraError> {
        let k = self.dim();
        let mut equations = vec![vec![BigRational::zero(); k]; k * k];
        for (r, s, m, c) in self.exact()?.nonzero() {
            equations[r * k + s][m].clone_from(c);
        }
        let solutions = Echelon::of(k, equations).null_space();
        Ok(solutions.iter().map(|xi| primitive(xi).iter().map(rounded).collect()).collect())
    }

    /// A basis of the symmetric bilinear forms B with B([x, y], z) + B(y, [x, z]) = 0: the solutions of
    /// c_rs^p B_pm + c_rm^p B_sp = 0, as k × k matrices with coprime integer entries.
    ///
    /// The Killing form is one of these forms; if any of the forms is regular, coadjoint motion is equivalent
    /// to adjoint motion.
    ///
    /// # Errors
    /// [`AlgebraError::NotRational`].
    ///
    /// ```
    /// # use pc_algebra::LieAlgebra;
    /// let forms = LieAlgebra::se3().invariant_quadratic_forms()?; // ω·ω and ω·v
    /// assert_eq!(forms.len(), 2);
    /// # Ok::<(), pc_algebra::AlgebraError>(())
    /// ```
    pub fn invariant_quadratic_forms(&self) -> Result<Vec<Matrix<Number>>, AlgebraError> {
        let k = self.dim();
        let c = self.exact()?;
        let unknowns = k * (k + 1) / 2;
        let mut forms = Echelon::new(unknowns);
        for r in 0..k {
            // c_rs^p B_pm of the ordered pair (s, m); (m, s) adds the other term (the same one again where s
            // = m).
            let mut equations = vec![vec![BigRational::zero(); unknowns]; unknowns];
            for (_, s, p, value) in c.nonzero().filter(|entry| entry.0 == r) {
                for m in 0..k {
                    equations[unknown(s, m)][unknown(p, m)] += value;
                }
            }
            for equation in equations {
                forms.insert(equation);
            }
        }
        let matrix = |b: &Vec<BigRational>| {
            let b = primitive(b);
            Matrix::from_fn(k, k, |s, m| rounded(&b[unknown(s, m)]))
        };
        Ok(forms.null_space().iter().map(matrix).collect())
    }
}

/// The index of the entry (s, m) of a symmetric matrix among those on and below the diagonal.
fn unknown(s: usize, m: usize) -> usize {
    let (low, high) = (s.min(m), s.max(m));
    high * (high + 1) / 2 + low
}

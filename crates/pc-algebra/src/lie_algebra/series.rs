//! Centre, derived series and lower central series.

use num_rational::BigRational;
use num_traits::Zero;

use crate::error::AlgebraError;
use crate::frame::frame::shape;
use crate::lie_algebra::lie_algebra::LieAlgebra;
use crate::lie_algebra::structure_constants::ExactConstants;
use crate::lie_algebra::subspace::Subspace;
use crate::linear_algebra::echelon::Echelon;

impl LieAlgebra {
    /// Whether all brackets are 0.
    pub fn is_abelian(&self) -> bool {
        self.nonzero().next().is_none()
    }

    /// The centre {x : [x, y] = 0 for all y}, the solutions of c_rs^m x_r = 0.
    ///
    /// # Errors
    /// [`AlgebraError::NotRational`].
    ///
    /// ```
    /// # use pc_algebra::LieAlgebra;
    /// let centre = LieAlgebra::heisenberg(1).centre()?;
    /// assert_eq!(centre.basis(), [[0.into(), 0.into(), 1.into()]]);
    /// # Ok::<(), pc_algebra::AlgebraError>(())
    /// ```
    pub fn centre(&self) -> Result<Subspace, AlgebraError> {
        let k = self.dim();
        let mut equations = vec![vec![BigRational::zero(); k]; k * k];
        for (r, s, m, c) in self.exact()?.nonzero() {
            equations[s * k + m][r].clone_from(c);
        }
        Ok(Subspace::of_exact(k, Echelon::of(k, equations).null_space()))
    }

    /// The derived series g ⊃ [g, g] ⊃ [[g, g], [g, g]] ⊃ …, as long as it decreases; g is the first
    /// entry.
    ///
    /// # Errors
    /// [`AlgebraError::NotRational`].
    ///
    /// ```
    /// # use pc_algebra::LieAlgebra;
    /// let dims: Vec<usize> = LieAlgebra::se2().derived_series()?.iter().map(|h| h.dim()).collect();
    /// assert_eq!(dims, [3, 2, 0]);
    /// # Ok::<(), pc_algebra::AlgebraError>(())
    /// ```
    pub fn derived_series(&self) -> Result<Vec<Subspace>, AlgebraError> {
        let c = self.exact()?;
        Ok(decreasing(self.dim(), |h| product(&c, h, h)))
    }

    /// The lower central series g ⊃ [g, g] ⊃ [g, [g, g]] ⊃ …, as long as it decreases; g is the first
    /// entry.
    ///
    /// # Errors
    /// [`AlgebraError::NotRational`].
    pub fn lower_central_series(&self) -> Result<Vec<Subspace>, AlgebraError> {
        let c = self.exact()?;
        let whole = Subspace::whole(self.dim());
        Ok(decreasing(self.dim(), |h| product(&c, &whole, h)))
    }

    /// Whether the derived series ends at 0.
    ///
    /// # Errors
    /// [`AlgebraError::NotRational`].
    pub fn is_solvable(&self) -> Result<bool, AlgebraError> {
        Ok(self.derived_series()?.last().is_none_or(|h| h.dim() == 0))
    }

    /// Whether the lower central series ends at 0.
    ///
    /// # Errors
    /// [`AlgebraError::NotRational`].
    pub fn is_nilpotent(&self) -> Result<bool, AlgebraError> {
        Ok(self.lower_central_series()?.last().is_none_or(|h| h.dim() == 0))
    }

    /// Whether [h, h] ⊂ h.
    ///
    /// # Errors
    /// [`AlgebraError::NotRational`]; [`AlgebraError::Shape`] if h lies in a space of another
    /// dimension.
    pub fn is_subalgebra(&self, h: &Subspace) -> Result<bool, AlgebraError> {
        shape("a vector of the subspace", h.ambient(), self.dim())?;
        Ok(product(&self.exact()?, h, h).is_within(h))
    }

    /// Whether [g, h] ⊂ h.
    ///
    /// # Errors
    /// [`AlgebraError::NotRational`]; [`AlgebraError::Shape`] if h lies in a space of another
    /// dimension.
    ///
    /// ```
    /// # use pc_algebra::{LieAlgebra, Subspace};
    /// let [v1, v2] = [[0, 1, 0], [0, 0, 1]].map(|v| v.map(Into::into).to_vec());
    /// let translations = Subspace::span(3, &[v1, v2])?;
    /// assert!(LieAlgebra::se2().is_ideal(&translations)?);
    /// # Ok::<(), pc_algebra::AlgebraError>(())
    /// ```
    pub fn is_ideal(&self, h: &Subspace) -> Result<bool, AlgebraError> {
        shape("a vector of the subspace", h.ambient(), self.dim())?;
        Ok(product(&self.exact()?, &Subspace::whole(self.dim()), h).is_within(h))
    }
}

/// The span of all [u, v] with u in U and v in V.
fn product(c: &ExactConstants, u: &Subspace, v: &Subspace) -> Subspace {
    let pairs = u.rows().iter().flat_map(|x| v.rows().iter().map(move |y| (x, y)));
    Subspace::of_exact(c.dim(), pairs.map(|(x, y)| c.bracket(x, y)))
}

/// The subspaces g, f(g), f(f(g)), …, as long as the dimension decreases.
fn decreasing(dim: usize, f: impl Fn(&Subspace) -> Subspace) -> Vec<Subspace> {
    let whole = Subspace::whole(dim);
    std::iter::successors(Some(whole), |h| Some(f(h)).filter(|next| next.dim() < h.dim())).collect()
}
